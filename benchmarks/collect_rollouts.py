"""Keep the evaluations of the robot tasks between which `problems/emulated.py` interpolates.

    python benchmarks/collect_rollouts.py [--rows 6000]

Reads the histories of the finished studies in `outputs/studies/`, those on stand-ins for the real robot left out, and
writes to `benchmarks/problems/rollouts/` a table per task, and what goes with them to `tasks.json`: bounds, reference
point, noise, largest hypervolume. Also says how well the tables predict an evaluation that is left out.
"""

from __future__ import annotations

import argparse
import csv
import gzip
import io
import json
import random
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from problems.base import FloatArray
from problems.emulated import ROLLOUTS, TASKS, Landscape

from hypermap_lite import hypervolume, load_scenario
from hypermap_lite.scenario import Scenario

ROOT = Path(__file__).parent.parent
STUDIES = ROOT / "outputs" / "studies"
SCENARIOS = ROOT / "example_scenarios" / "robot"
ON_STAND_INS = "_transfer"
"""What the names of the studies end with that have the stand-ins for the real robot."""


def evaluations_of(task: str) -> Iterator[Mapping[str, str]]:
    """Yield the completed rows of all histories of a task, of studies in simulation."""
    for study in sorted((SCENARIOS / "studies").glob(f"{task}*.json")):
        if study.stem.endswith(ON_STAND_INS):
            continue
        for file in sorted((STUDIES / study.stem).glob("runs/*/*/history.csv")):
            with file.open(newline="", encoding="utf-8") as text:
                yield from (row for row in csv.DictReader(text) if row["state"] == "completed")


def described(scenario: Scenario, noise_sd: FloatArray) -> dict[str, Any]:
    """Return parameters and objectives of a task, all objectives to be small."""
    objectives = [
        {
            "name": o.name,
            "goal": o.goal.value,
            "reference_point": o.sign * o.reference_point,
            "noise_sd": round_to(3, sd),
        }
        for o, sd in zip(scenario.objectives, noise_sd, strict=True)
        if o.reference_point is not None
    ]
    return {
        "parameters": {p.name: {"parameter_type": "real", "values": list(p.values)} for p in scenario.parameters},
        "objectives": objectives,
    }


def table_of(scenario: Scenario, rows: Sequence[Mapping[str, str]], n: int) -> list[list[float]]:
    """Return up to n different configurations with their objectives, to be small, in random order."""
    names = [parameter.name for parameter in scenario.parameters]
    known = {tuple(row[name] for name in names): row for row in rows}
    chosen = list(known)
    random.Random(0).shuffle(chosen)
    return [
        [
            *(round_to(4, float(value)) for value in key),
            *(round_to(4, o.sign * float(known[key][o.name])) for o in scenario.objectives),
        ]
        for key in chosen[:n]
    ]


def round_to(digits: int, value: float) -> float:
    """Round to so many significant digits."""
    return float(f"{value:.{digits}g}")


def written(header: Sequence[str], table: Sequence[Sequence[float]]) -> bytes:
    """Return a table as a compressed CSV file, the same bytes at any time."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([header, *table])
    return gzip.compress(text.getvalue().encode(), mtime=0)


def collect(task: str, n: int) -> dict[str, Any]:
    """Write the table of a task, and return what goes with it."""
    scenario = load_scenario(SCENARIOS / task / "no_prior.json")
    rows = list(evaluations_of(task))
    errors = [[float(row[f"{objective.name}_sem"] or "nan") for objective in scenario.objectives] for row in rows]
    about = described(scenario, np.nanmedian(errors, axis=0))
    header = [*about["parameters"], *(objective["name"] for objective in about["objectives"])]
    (ROLLOUTS / f"{task}.csv.gz").write_bytes(written(header, table_of(scenario, rows, n)))
    landscape = Landscape.of(task, about["parameters"])
    reference_point = np.array([objective["reference_point"] for objective in about["objectives"]])
    about["best"] = round_to(6, hypervolume(landscape.values_at_rows(), reference_point))
    print(f"{task}: {len(landscape.Y)} of {len(rows)} evaluations, R^2 of those left out", landscape.r2().round(2))
    return about


def main() -> None:
    """Collect all tasks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=6000, help="evaluations kept of a task")
    n = parser.parse_args().rows
    ROLLOUTS.mkdir(exist_ok=True)
    about = {task: collect(task, n) for task in TASKS}
    (ROLLOUTS / "tasks.json").write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
