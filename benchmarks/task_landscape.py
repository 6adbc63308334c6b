"""Look at the robot tasks as an optimizer will: what random, believed and misleading parameters are worth.

    python benchmarks/task_landscape.py [--jobs 2]

For each task draws configurations uniformly, from the operator's prior and from the misleading prior, each with
seven rollouts, and runs the means of both priors a hundred times. Writes a row per configuration as CSV (one that is
there is not run again: delete the file after a change of the tasks), the scatter plot of the objectives into
`docs/images/`, and a page with success rates, fronts and reference points.
"""

from __future__ import annotations

import argparse
import csv
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from reporting import machine, markdown_table

from hypermap_lite import Optimizer
from hypermap_lite.pareto import non_dominated
from robot_tasks.errors import SimulationError
from robot_tasks.evaluation import evaluate
from robot_tasks.tasks import TASKS

ROOT = Path(__file__).parent.parent
SCENARIOS = ROOT / "example_scenarios" / "robot"
PRIORS = {"operator": "operator_prior", "misleading": "misleading_prior"}
SIZES = {"uniform": 300, "operator": 120, "misleading": 120}
MEANS = {"operator means": "operator", "misleading means": "misleading"}
MEANS_SEEDS = 100
REPLICATES = 7
BUDGETS = {"peg_insertion": 50, "object_pushing": 50, "obstacle_avoidance": 60}
N_SUBSETS = 500
COLUMNS = ("task", "source", "index", "first_objective", "second_objective", "success", "touches", "failures")
COLOURS = {"uniform": "0.6", "operator": "tab:green", "misleading": "tab:red"}

FloatArray = npt.NDArray[np.float64]
Job = tuple[str, str, int, Mapping[str, float], Sequence[int]]


def draws(task: str, source: str) -> list[dict[str, float]]:
    """Draw the configurations of a source, the same ones every time."""
    scenario = SCENARIOS / task / f"{PRIORS.get(source, 'no_prior')}.json"
    kind = "random_search" if source == "uniform" else "prior_sampling"
    optimizer = Optimizer(scenario, overrides=[f"optimizer.type={kind}", f"budget.evaluations={SIZES[source]}"])
    return [dict(suggestion.configuration) for suggestion in optimizer.ask(SIZES[source])]


def means(task: str, source: str) -> dict[str, float]:
    """Return the means of a prior, moved into the bounds."""
    priors = json.loads((SCENARIOS / task / f"{PRIORS[source]}.json").read_text())["input_parameters"]
    return {p.name: min(p.high, max(p.low, priors[p.name]["prior"]["mean"])) for p in TASKS[task].parameters}


def jobs(task: str) -> Iterator[Job]:
    """Yield what is to be run: rollouts that make up a row."""
    for source, mean_of in MEANS.items():
        yield from ((task, source, seed, means(task, mean_of), (seed,)) for seed in range(MEANS_SEEDS))
    for source in SIZES:
        yield from ((task, source, i, draw, range(7 * i, 7 * i + 7)) for i, draw in enumerate(draws(task, source)))


def measure(job: Job) -> list[object]:
    """Run the rollouts of a row and average them."""
    task, source, index, configuration, seeds = job
    results = []
    for seed in seeds:
        try:
            results.append(evaluate(task, configuration, seed))
        except SimulationError:
            continue
    failures = len(seeds) - len(results)
    if failures:
        return [task, source, index, "", "", "", "", failures]
    first, second = TASKS[task].objectives
    numbers = [np.mean([result[name] for result in results]) for name in (first, second, "success", "touches")]
    return [task, source, index, *(f"{number:.8g}" for number in numbers), failures]


def run_missing(path: Path, n_jobs: int) -> list[dict[str, str]]:
    """Append the rows that are missing, as they come, and return all."""
    if not path.exists():
        path.write_text(",".join(COLUMNS) + "\n")
    with path.open(newline="") as file:
        done = {(row["task"], row["source"], int(row["index"])) for row in csv.DictReader(file)}
    missing = [job for task in TASKS for job in jobs(task) if job[:3] not in done]
    with ProcessPoolExecutor(n_jobs) as pool, path.open("a", newline="") as file:
        for row in pool.map(measure, missing, chunksize=4):
            csv.writer(file, lineterminator="\n").writerow(row)
            file.flush()
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def select(rows: Iterable[Mapping[str, str]], task: str, source: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return objectives (n, 2), success and touches of the rows of a source that did not fail."""
    chosen = [row for row in rows if row["task"] == task and row["source"] == source and row["failures"] == "0"]
    names = ("first_objective", "second_objective", "success", "touches")
    table = np.array([[float(row[name]) for name in names] for row in chosen])
    return table[:, :2], table[:, 2], table[:, 3]


def front(points: FloatArray) -> FloatArray:
    """Return the non-dominated points of maximized objectives, best first objective first."""
    best = points[non_dominated(-points)]
    return best[np.argsort(-best[:, 0])]


def worst_on_fronts(points: FloatArray, budget: int) -> FloatArray:
    """Return quantiles 5, 50, 95 % of the worst values on the fronts of random subsets, shape (3, 2)."""
    rng = np.random.default_rng(0)
    worst = [front(points[rng.choice(len(points), budget, replace=False)]).min(axis=0) for _ in range(N_SUBSETS)]
    return np.quantile(worst, [0.05, 0.5, 0.95], axis=0)


def source_rows(rows: list[dict[str, str]], task: str) -> Iterator[tuple[str, ...]]:
    """Yield a line of the page per source."""
    base = json.loads((SCENARIOS / task / "no_prior.json").read_text())
    reference = [objective["reference_point"] for objective in base["objectives"]]
    for source in (*MEANS, *SIZES):
        points, success, touches = select(rows, task, source)
        median, best = np.median(points, axis=0), points.max(axis=0)
        yield (
            source,
            str(len(points)),
            f"{100 * success.mean():.1f} %",
            "" if source in MEANS else f"{100 * np.mean(success >= 0.5):.1f} %",
            "" if source in MEANS else f"{100 * np.mean((points > reference).all(axis=1)):.0f} %",
            f"{100 * np.mean(touches > 0):.0f} %",
            f"{median[0]:.5g} ({best[0]:.5g})",
            f"{median[1]:.5g} ({best[1]:.5g})",
        )


def front_row(rows: list[dict[str, str]], task: str) -> tuple[str, ...]:
    """Return the line of the page on a task's front over the uniform configurations."""
    points, _, _ = select(rows, task, "uniform")
    best = front(points)
    spread = np.ptp(best, axis=0) / np.ptp(points, axis=0)
    worst = []
    for source in ("uniform", "operator"):
        low, median, high = worst_on_fronts(select(rows, task, source)[0], BUDGETS[task])
        worst.append(", ".join(f"{m:.5g} ({a:.5g} to {b:.5g})" for a, m, b in zip(low, median, high, strict=True)))
    return (task, str(len(best)), " and ".join(f"{100 * s:.0f} %" for s in spread), *worst)


def draw_scatter(rows: list[dict[str, str]], task: str, path: Path) -> None:
    """Draw the objectives of all configurations, and the front of the uniform ones."""
    figure = Figure(figsize=(5.4, 4.0), layout="constrained")
    axes = figure.subplots()
    for source, colour in COLOURS.items():
        points, _, _ = select(rows, task, source)
        axes.plot(*points.T, ".", color=colour, markersize=4, alpha=0.7, label=f"{source} ({len(points)})")
    best = front(select(rows, task, "uniform")[0])
    axes.step(*best.T, where="post", color="black", linewidth=1.0, label=f"front of uniform ({len(best)} points)")
    first, second = TASKS[task].objectives
    axes.set_xlabel(f"{first} (more is better)")
    axes.set_ylabel(f"{second} (more is better)")
    axes.set_title(task.replace("_", " "))
    axes.legend(fontsize=8)
    figure.savefig(path, dpi=100)


def page(rows: list[dict[str, str]]) -> str:
    """Return the page."""
    header = (
        "source",
        "n",
        "rollouts that succeed",
        "succeed in most",
        "beyond the reference point",
        "touch something",
    )
    lines = ["# Robot tasks", "", "    python benchmarks/task_landscape.py", "", machine(), ""]
    lines += [
        f"Means of priors: {MEANS_SEEDS} rollouts. Other rows: configurations, {REPLICATES} rollouts each.",
        "Objectives are maximized: median (best).",
    ]
    for task in TASKS:
        lines += ["", f"## {task}", ""]
        lines += markdown_table((*header, *TASKS[task].objectives), list(source_rows(rows, task)))
    failures = sum(int(row["failures"]) for row in rows)
    lines += [
        "",
        "## Fronts of 300 uniform configurations",
        "",
        "Spread: how far the ends of the front are apart, as a share of the range over all configurations.",
        f"Worst values: of the fronts of {N_SUBSETS} random subsets of one run's budget, median (5 % to 95 %).",
        "The reference points of the scenarios are the worse of the two medians, rounded.",
        "",
        *markdown_table(
            ("task", "points", "spread", "worst values on a front, uniform", "operator's prior"),
            [front_row(rows, task) for task in TASKS],
        ),
        "",
        f"Rollouts that ended in an error of the simulation: {failures}.",
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run what is missing and write CSV, pictures and page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    parser.add_argument("--images", type=Path, default=ROOT / "docs" / "images")
    arguments = parser.parse_args()
    mpl.use("agg")
    rows = run_missing(arguments.output / "task_landscape.csv", arguments.jobs)
    for task in TASKS:
        draw_scatter(rows, task, arguments.images / f"{task}_objectives.png")
    text = page(rows)
    (arguments.output / "task_landscape.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
