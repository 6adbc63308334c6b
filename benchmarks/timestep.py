"""Compare physics steps: mean objectives of randomized rollouts at 0.5, 1 and 2 ms.

    python benchmarks/timestep.py [--rollouts 60] [--jobs 2]

Each task with the means of both its priors and with a good skill; the same seeds at every step. A step is good
enough for a task if the means of all objectives lie within the 95 % intervals of those at 0.5 ms. Single rollouts in
contact part ways at any change of the step, so only means can be compared.
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import numpy.typing as npt
from reporting import machine, markdown_table
from scipy.stats import t
from variants import SKILLS, parameters_of

from robot_tasks.evaluation import load, measure
from robot_tasks.rollout import rollout
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import TASKS

STEPS = (0.0005, 0.001, 0.002)
COLUMNS = ("task", "skill", "step", "seed", "first_objective", "second_objective", "success", "tool_peak_force")

FloatArray = npt.NDArray[np.float64]
Job = tuple[str, str, float, int]

_SIMULATIONS: dict[tuple[str, float], Simulation] = {}


def run(job: Job) -> list[object]:
    """Run one rollout and return its row."""
    name, skill, step, seed = job
    task = TASKS[name]
    if (name, step) not in _SIMULATIONS:
        _SIMULATIONS[name, step] = load(task, timestep=step)
    variation = task.randomization.sample(np.random.default_rng(seed))
    parameters = task.check(parameters_of(name, skill))
    numbers = measure(task, rollout(task, parameters, variation, _SIMULATIONS[name, step]))
    return [*job, *(f"{numbers[key]:.8g}" for key in (*task.objectives, "success", "tool_peak_force"))]


def summary(table: Mapping[tuple[str, str, float], FloatArray]) -> Iterator[tuple[str, ...]]:
    """Yield a line per task, skill and step; columns of a table are objectives, success and peak force."""
    for (task, skill, step), values in table.items():
        finest = table[task, skill, STEPS[0]]
        half_width = t.ppf(0.975, len(finest) - 1) * finest[:, :2].std(axis=0, ddof=1) / np.sqrt(len(finest))
        mean, finest_mean = values[:, :2].mean(axis=0), finest[:, :2].mean(axis=0)
        is_within = bool((np.abs(mean - finest_mean) <= half_width).all())
        interval = t.ppf(0.975, len(values) - 1) * values[:, :2].std(axis=0, ddof=1) / np.sqrt(len(values))
        yield (
            task,
            skill,
            f"{1e3 * step:g} ms",
            *(f"{m:.5g} ± {h:.2g}" for m, h in zip(mean, interval, strict=True)),
            f"{100 * values[:, 2].mean():.0f} %",
            f"{np.median(values[:, 3]):.0f} N",
            "" if step == STEPS[0] else "yes" if is_within else "no",
        )


def main() -> None:
    """Run all rollouts and write CSV and page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rollouts", type=int, default=60)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    cases = [(task, skill, step) for task in TASKS for skill in SKILLS for step in STEPS]
    jobs = [(*case, seed) for case in cases for seed in range(arguments.rollouts)]
    with ProcessPoolExecutor(arguments.jobs) as pool:
        rows = list(pool.map(run, jobs, chunksize=5))
    with (arguments.output / "timestep.csv").open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
    table = {case: np.array([row[4:] for row in rows if tuple(row[:3]) == case], dtype=float) for case in cases}
    header = ("task", "skill", "step", "first objective", "second objective", "success", "peak", "within 0.5 ms")
    text = "\n".join(
        [
            "# Physics steps",
            "",
            f"    python benchmarks/timestep.py --rollouts {arguments.rollouts}",
            "",
            machine(),
            "",
            f"Means of {arguments.rollouts} randomized rollouts and their 95 % intervals; peak: median of the",
            "largest contact force on the tool. Within: both means lie within the intervals at 0.5 ms.",
            "",
            *markdown_table(header, list(summary(table))),
            "",
        ]
    )
    (arguments.output / "timestep.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
