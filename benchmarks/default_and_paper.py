"""Compare the default method with the paper's on the robot tasks, prior by prior.

    python benchmarks/default_and_paper.py

Reads the stored results of the studies in `outputs/reference/` (`reference.py` makes them), those with the seeds that
both methods have, and writes a page with a table, and a picture for the page of the experiments.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
from reporting import machine, markdown_table

from hypermap_lite.plotting import style
from hypermap_lite.study.statistics import evaluations_to_reach, ratio_of_means

ROOT = Path(__file__).parent.parent
REFERENCE = ROOT / "outputs" / "reference"
PICTURE = ROOT / "docs" / "images" / "default_and_paper.png"
TASKS = ("peg_insertion", "object_pushing", "obstacle_avoidance")
VARIANTS = {"no_prior": "no prior", "operator_prior": "operator's prior", "misleading_prior": "misleading prior"}
METHODS = {"_default": ("default", "-"), "": ("paper", style.DASHES)}
"""End of the study's name, name and dashes of each method."""

UNIT = 1e6

FloatArray = npt.NDArray[np.float64]


def traces_of(task: str, suffix: str) -> dict[str, FloatArray]:
    """Return the hypervolume after each evaluation, shape (runs, evaluations), of each variant."""
    runs, others = (runs_of(f"{task}{end}") for end in (suffix, *(end for end in METHODS if end != suffix)))
    return {
        variant: np.array([trace for seed, trace in sorted(traces.items()) if seed in others[variant]])
        for variant, traces in runs.items()
    }


def runs_of(study: str) -> dict[str, dict[str, list[float]]]:
    """Return the hypervolume after each evaluation by variant and seed."""
    runs: dict[str, dict[str, list[float]]] = {variant: {} for variant in VARIANTS}
    with (REFERENCE / study / "summary.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["variant"] in runs:
                runs[row["variant"]].setdefault(row["seed"], []).append(float(row["hypervolume"]) / UNIT)
    return runs


def design_of(task: str) -> int:
    """Return the number of evaluations of the initial design."""
    [first] = (REFERENCE / task / "runs" / "no_prior").iterdir()
    scenario = json.loads((first / "scenario.json").read_text(encoding="utf-8"))
    return int(scenario["design_of_experiment"]["number_of_samples"])


def rows(task: str) -> Iterator[list[str]]:
    """Yield a row per prior."""
    ours, papers = (traces_of(task, suffix) for suffix in METHODS)
    for variant, label in VARIANTS.items():
        a, b = ours[variant], papers[variant]
        ratio = ratio_of_means(a[:, -1], b[:, -1], is_paired=True)
        reached = evaluations_to_reach(a, b[:, -1], is_paired=True).value
        relative = ratio_of_means(a[:, -1], ours["no_prior"][:, -1], is_paired=False)
        half = [f"{traces[:, traces.shape[1] // 2 - 1].mean():.2f}" for traces in (a, b)]
        yield [
            task.replace("_", " "),
            label,
            str(len(a)),
            *(f"{x[:, -1].mean():.2f} ± {x[:, -1].std(ddof=1) / math.sqrt(len(x)):.2f}" for x in (a, b)),
            *half,
            f"{ratio.value:.2f} ({ratio.low:.2f} to {ratio.high:.2f})",
            "never" if math.isinf(reached) else f"{reached:.0f} of {a.shape[1]}",
            "" if variant == "no_prior" else f"{relative.value:.2f} ({relative.low:.2f} to {relative.high:.2f})",
        ]


def draw() -> None:
    """Draw a panel per task: mean hypervolume against evaluations, with one standard error."""
    with style.house_style():
        figure = style.new_figure(12.0, 4.4)
        for axes, task in zip(figure.subplots(1, len(TASKS)), TASKS, strict=True):
            for suffix, (_, dashes) in METHODS.items():
                for index, traces in enumerate(traces_of(task, suffix).values()):
                    mean, error = traces.mean(axis=0), traces.std(axis=0, ddof=1) / math.sqrt(len(traces))
                    evaluations = np.arange(1, len(mean) + 1)
                    colour = style.colour(index)
                    axes.plot(evaluations, mean, color=colour, linestyle=dashes, linewidth=1.8)
                    axes.fill_between(evaluations, mean - error, mean + error, color=colour, alpha=0.10, linewidth=0)
            style.mark_design_end(axes, design_of(task))
            axes.set_title(task.replace("_", " "))
            axes.set_xlabel("evaluations")
            axes.set_ylim(bottom=0)
        figure.axes[0].set_ylabel("hypervolume / 10⁶")
        entries = [
            style.legend_entry(f"{label}, {method}", style.colour(index), line=dashes)
            for method, dashes in METHODS.values()
            for index, label in enumerate(VARIANTS.values())
        ]
        style.add_legend(figure, entries)
        style.save(figure, PICTURE)
    PICTURE.with_suffix(".pdf").unlink(missing_ok=True)


def main() -> None:
    """Write the page and the picture."""
    header = ["task", "prior", "runs", "default", "paper", "default, half", "paper, half", "default / paper"]
    header += ["paper's end reached after", "default / default without prior"]
    page = [
        "# The default method and the paper's on the robot tasks",
        "",
        "    python benchmarks/default_and_paper.py",
        "",
        machine(),
        "Mean final hypervolume / 10⁶ with its standard error, and after half of the evaluations; ratios of means",
        "with 95 % bootstrap intervals over the runs, seeds in pairs; evaluations after which the default's mean has",
        "the final value of the paper's; and what a prior is worth to the default.",
        "",
        *markdown_table(header, [row for task in TASKS for row in rows(task)]),
    ]
    (Path(__file__).parent / "results" / "default_and_paper.md").write_text("\n".join(page) + "\n", encoding="utf-8")
    draw()


if __name__ == "__main__":
    main()
