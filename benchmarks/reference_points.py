"""See what the comparison of priors owes to the reference point of the hypervolume.

    python benchmarks/reference_points.py

Reads the finished runs of the studies in `outputs/studies/` and measures each at four reference points: that of the
scenarios, the median and the 90 % quantile of all values of all runs (objective by objective), and the worst of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
from reporting import machine, markdown_table

from hypermap_lite.objectives import reference_point_of, to_minimization
from hypermap_lite.pareto import hypervolume
from hypermap_lite.plotting.runs import Run, by_label, load_run
from hypermap_lite.study.folder import labelled_runs

ROOT = Path(__file__).parent.parent
STUDIES = ("peg_insertion", "object_pushing", "obstacle_avoidance")
BASELINE = "no prior"

FloatArray = npt.NDArray[np.float64]


def corners(runs: list[Run]) -> Iterator[tuple[str, FloatArray]]:
    """Yield each reference point, to be minimized against, and what it is."""
    stated = reference_point_of(runs[0].objectives)
    assert stated is not None
    Y = np.vstack([run.Y[run.is_completed] for run in runs])
    yield "the scenarios'", stated
    yield "median of all values", np.quantile(Y, 0.5, axis=0)
    yield "90 % of all values", np.quantile(Y, 0.9, axis=0)
    yield "worst of all values", Y.max(axis=0)


def rows(study: str) -> Iterator[list[str]]:
    """Yield a row per reference point: mean final hypervolumes over that of the baseline."""
    runs = [load_run(folder, label=label) for label, folder in labelled_runs(ROOT / "outputs" / "studies" / study)]
    for name, corner in corners(runs):
        means = {
            label: float(np.mean([hypervolume(run.Y, corner) for run in group]))
            for label, group in by_label(runs).items()
        }
        point = ", ".join(f"{value:.0f}" for value in to_minimization(runs[0].objectives, corner))
        ratios = [f"{mean / means[BASELINE]:.2f}" for label, mean in means.items() if label != BASELINE]
        yield [study.replace("_", " "), f"{name} ({point})", *ratios]


def main() -> None:
    """Write the page."""
    runs = labelled_runs(ROOT / "outputs" / "studies" / STUDIES[0])
    labels = [label for label in dict.fromkeys(label for label, _ in runs) if label != BASELINE]
    table = markdown_table(["task", "reference point", *labels], [row for study in STUDIES for row in rows(study)])
    page = [
        "# What comparisons owe to the reference point",
        "",
        "    python benchmarks/reference_points.py",
        "",
        machine(),
        "Mean final hypervolume over that of the variant without prior, from the runs of the studies in",
        "`example_scenarios/robot/studies/`.",
        "",
        *table,
    ]
    (Path(__file__).parent / "results" / "reference_points.md").write_text("\n".join(page) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
