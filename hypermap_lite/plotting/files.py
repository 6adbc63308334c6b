"""Reading the files of runs, and samples files without a run folder, as texts and numbers."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hypermap_lite.errors import RunFolderError, ScenarioError
from hypermap_lite.history.csv_format import read_records
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.scenario.feasibility_column import FeasibilityColumn, usual_feasibility
from hypermap_lite.scenario.table import read_table
from hypermap_lite.typing import FloatArray

Rows = tuple[Mapping[str, str], ...]
"""The lines of a CSV file, as text by column."""


def read_scenario(file: Path) -> Mapping[str, Any]:
    """Return the canonical scenario of a run."""
    try:
        scenario = json.loads(file.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        where = "no such folder" if not file.parent.exists() else f"no {file.name} in it"
        raise RunFolderError(
            f"{file.parent}: not a run folder ({where}). Give the folder a run wrote, "
            "or a samples file with --scenario or --objectives"
        ) from None
    except ValueError as error:
        raise RunFolderError(f"{file}: not valid JSON ({error})") from error
    if not isinstance(scenario, dict):
        raise RunFolderError(f"{file}: expected a JSON object, got {type(scenario).__name__}")
    return scenario


def objectives_of(scenario: Mapping[str, Any], file: Path) -> tuple[Objective, ...]:
    """Return the objectives a canonical scenario names."""
    try:
        return tuple(
            Objective(name=o["name"], goal=Goal(o.get("goal", "minimize")), reference_point=o.get("reference_point"))
            for o in scenario["objectives"]
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise RunFolderError(f"{file}: its objectives cannot be read ({error!r})") from error


def read_rows(file: Path, required: Sequence[str]) -> tuple[tuple[str, ...], Rows]:
    """Return the header and the whole rows of a history."""
    if not file.is_file():
        raise RunFolderError(f"{file}: not found; the run has not finished its first evaluation")
    records = read_records(file)
    columns = tuple(records[0]) if records else ()
    missing = [name for name in required if name not in columns]
    if missing:
        raise RunFolderError(f"{file}: no column {', '.join(map(repr, missing))}; found {', '.join(columns) or 'none'}")
    for i, record in enumerate(records):
        if len(record) != len(columns):
            raise RunFolderError(f"{file}: record {i + 1} has {len(record)} fields, the header {len(columns)}")
    return columns, tuple(dict(zip(columns, record, strict=True)) for record in records[1:])


def numbers_of(rows: Sequence[Mapping[str, str]], names: Sequence[str], file: Path) -> FloatArray:
    """Return columns as numbers, shape (n, len(names)); NaN where a cell is empty or the column is missing."""
    numbers = np.full((len(rows), len(names)), np.nan)
    for i, row in enumerate(rows):
        for j, name in enumerate(names):
            try:
                numbers[i, j] = float(row.get(name) or "nan")
            except ValueError:
                raise RunFolderError(f"{file}: record {i + 2}: {name} is not a number: {row[name]!r}") from None
    return numbers


def read_samples(
    file: Path, scenario: Mapping[str, Any], objectives: Sequence[Objective]
) -> tuple[tuple[str, ...], Rows]:
    """Return the header and the rows of a samples file, with the ``state`` and ``phase`` that a history would have.

    A row is infeasible if the scenario's feasibility column, or else one called ``Valid`` or ``feasible``, says so, and
    failed if an objective is no finite number. The first ones are the design, if the scenario says how many.

    Raises
    ------
    RunFolderError
        If the file cannot be read, or lacks an objective.
    """
    try:
        table = read_table(file, str(file))
    except ScenarioError as error:
        raise RunFolderError(error.problem) from None
    names = [o.name for o in objectives]
    missing = [name for name in names if name not in table.header]
    if missing:
        found = ", ".join(table.header)
        raise RunFolderError(f"{file}: no column {', '.join(map(repr, missing))}; found {found}")
    own = FeasibilityColumn.of(scenario)
    columns = usual_feasibility(table.header, names) if own is None else [own]
    design = (scenario.get("design_of_experiment") or {}).get("number_of_samples") or 0
    rows = []
    for i, record in enumerate(table.records):
        row = dict(zip(table.header, map(str.strip, record), strict=True))
        state = "completed" if all(map(_has_value, (row[name] for name in names))) else "failed"
        if any(column.is_feasible(row.get(column.name, "")) is False for column in columns):
            state = "infeasible"
        rows.append({"state": state, "phase": "design" if i < design else "model"} | row)
    return table.header, tuple(rows)


def _has_value(text: str) -> bool:
    """Tell whether a cell holds something else than nothing, NaN or infinity; no number is an error of its reader."""
    try:
        return math.isfinite(float(text))
    except ValueError:
        return bool(text)
