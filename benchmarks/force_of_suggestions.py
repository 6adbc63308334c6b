"""See how softly the peg is asked to press, by the paper's scalarization and by the default method, which has none.

    python benchmarks/force_of_suggestions.py

Reads the runs without prior of the studies `peg_insertion` (the paper's method: linear scalarization of the acquisition
values) and `peg_insertion_default` (expected hypervolume improvement) in `outputs/studies/`, and counts the
configurations the model suggested that press with less than 2 N, which hardly find the hole.
"""

from __future__ import annotations

import csv
from pathlib import Path

from reporting import machine, markdown_table

ROOT = Path(__file__).parent.parent
STUDIES = {"peg_insertion": "linear", "peg_insertion_default": "none: expected hypervolume improvement"}
GENTLE = 2.0
"""Commanded force below which the peg hardly finds the hole [N]."""


def forces(study: str) -> list[list[float]]:
    """Return the size of the commanded force [N] of every configuration a model suggested, run by run."""
    runs = []
    for history in sorted((ROOT / "outputs" / "studies" / study / "runs" / "no_prior").glob("*/history.csv")):
        with history.open(newline="", encoding="utf-8") as file:
            runs.append([abs(float(row["Force"])) for row in csv.DictReader(file) if row["phase"] == "model"])
    return runs


def main() -> None:
    """Write the page."""
    lines = []
    for study, scalarization in STUDIES.items():
        runs = forces(study)
        every = [force for run in runs for force in run]
        share = sum(force < GENTLE for force in every) / len(every)
        lines.append([scalarization, f"`{study}`", str(len(runs)), str(len(every)), f"{100 * share:.0f} %"])
    header = ["scalarization", "study", "runs", "suggestions by the model", f"of them below {GENTLE:g} N"]
    page = [
        "# How softly the peg is asked to press",
        "",
        "    python benchmarks/force_of_suggestions.py",
        "",
        machine(),
    ]
    page += ["A uniform draw presses with less than 2 N in 5 % of the cases.", "", *markdown_table(header, lines)]
    (Path(__file__).parent / "results" / "force_of_suggestions.md").write_text("\n".join(page) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
