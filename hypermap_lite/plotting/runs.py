"""What a finished or running experiment left in its folder, read for pictures and fronts.

Light on purpose: ``history.csv`` and ``scenario.json`` are enough, no part of the optimizer is imported.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from hypermap_lite.errors import RunFolderError, UsageError
from hypermap_lite.history.csv_format import read_records
from hypermap_lite.objectives import Goal, Objective, to_minimization
from hypermap_lite.pareto import non_dominated
from hypermap_lite.typing import BoolArray, FloatArray

DESIGN_PHASES: Final = ("default", "design")
"""Phases of ``history.csv`` that come before there is a model."""

LARGEST_DRAWN: Final = 1e300
"""Size of the largest values in a picture; its axes are longer than the range of the values."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Run:
    """One run folder: its scenario and a row per configuration, in the order of the evaluations."""

    folder: Path
    label: str
    """Name in legends; runs that share one are repetitions of the same experiment."""

    scenario: Mapping[str, Any]
    """The canonical scenario, as in ``scenario.json``."""

    objectives: tuple[Objective, ...]
    columns: tuple[str, ...]
    """Header of ``history.csv``."""

    rows: tuple[Mapping[str, str], ...]
    """The lines of ``history.csv``, as text by column."""

    values: FloatArray
    """Objectives as the user directed them, shape (n, m); NaN unless completed, measured or not."""

    standard_errors: FloatArray
    """Standard errors of the values, shape (n, m); NaN with fewer than two replicates and unless completed."""

    @property
    def name(self) -> str:
        """Name of the application."""
        return str(self.scenario.get("application_name", self.folder.name))

    @property
    def Y(self) -> FloatArray:  # noqa: N802 - the field's name
        """Objectives to be minimized, shape (n, m); NaN unless completed."""
        return to_minimization(self.objectives, self.values)

    @property
    def states(self) -> list[str]:
        """How each evaluation ended."""
        return [row["state"] for row in self.rows]

    @property
    def is_completed(self) -> BoolArray:
        """Whether each evaluation has objective values, shape (n,)."""
        return np.array(np.isfinite(self.values).all(axis=1), dtype=bool)

    @property
    def is_design(self) -> BoolArray:
        """Whether each evaluation belongs to the initial design, shape (n,)."""
        return np.array([row.get("phase") in DESIGN_PHASES for row in self.rows], dtype=bool)

    @property
    def n_design(self) -> int:
        """Number of evaluations of the initial design."""
        return int(self.is_design.sum())

    @property
    def is_front(self) -> BoolArray:
        """Whether each evaluation is on the Pareto front, shape (n,)."""
        return non_dominated(self.Y)


def load_run(source: str | Path, *, label: str = "") -> Run:
    """Read a run folder.

    Parameters
    ----------
    source
        The run folder, or the ``history.csv`` in it.
    label
        Name in legends; the folder's name if empty.

    Returns
    -------
    Run
        Its scenario and evaluations. A last line that is still being written is left out.

    Raises
    ------
    RunFolderError
        If a file is missing, cannot be read, or does not fit the scenario.
    """
    path = Path(source)
    history_file = path if path.suffix == ".csv" and not path.is_dir() else path / "history.csv"
    folder = history_file.parent
    scenario = _read_scenario(folder / "scenario.json")
    objectives = _objectives_of(scenario, folder / "scenario.json")
    columns, rows = _read_rows(history_file, required=["state", *(o.name for o in objectives)])
    names = [o.name for o in objectives]
    values = _numbers(rows, names, history_file)
    errors = _numbers(rows, [f"{name}_sem" for name in names], history_file)
    for numbers in (values, errors):
        numbers[[row["state"] != "completed" for row in rows]] = np.nan
    return Run(
        folder=folder,
        label=label or folder.resolve().name,
        scenario=scenario,
        objectives=objectives,
        columns=columns,
        rows=rows,
        values=values,
        standard_errors=errors,
    )


def load_runs(sources: Sequence[str | Path], labels: Sequence[str] | None = None) -> list[Run]:
    """Read the runs of one picture and check that they can share it.

    Parameters
    ----------
    sources
        Run folders, or the ``history.csv`` in them; at least one.
    labels
        One name per run; equal names mark repetitions. By default the shortest endings of the folders' paths
        that tell them apart.

    Returns
    -------
    list of Run
        In the order given.

    Raises
    ------
    UsageError
        If no run is given, the number of labels is another, or the runs have different objectives.
    RunFolderError
        If a folder cannot be read or has no completed evaluation.
    """
    if not sources:
        raise UsageError("no run folder given")
    if labels is not None and len(labels) != len(sources):
        raise UsageError(f"{len(labels)} labels for {len(sources)} runs: give one label per run, in the same order")
    runs = [load_run(source) for source in sources]
    names = labels if labels is not None else _distinct_names([run.folder for run in runs])
    for run in runs:
        _require_completed(run)
        _require_same_objectives(runs[0], run)
    return [replace(run, label=name) for run, name in zip(runs, names, strict=True)]


def require_drawable(runs: Sequence[Run], reference_point: FloatArray | None = None) -> None:
    """Raise UsageError if values, or the reference point's, are so large that no axis can be drawn around them."""
    for run in runs:
        largest = float(np.nanmax(np.abs(run.values)))
        if largest > LARGEST_DRAWN:
            raise UsageError(f"{run.folder}: objective values up to {largest:g} in size cannot be drawn")
    if reference_point is not None and np.abs(reference_point).max() > LARGEST_DRAWN:
        raise UsageError(f"a reference point of {np.abs(reference_point).max():g} in size cannot be drawn")


def by_label(runs: Sequence[Run]) -> dict[str, list[Run]]:
    """Return the runs under their labels, both in the order given."""
    groups: dict[str, list[Run]] = {}
    for run in runs:
        groups.setdefault(run.label, []).append(run)
    return groups


def legend_labels(runs: Sequence[Run]) -> list[str]:
    """Return the labels, each once, with the number of repetitions where there are several."""
    groups = by_label(runs).items()
    return [f"{label} ({len(group)} runs)" if len(group) > 1 else label for label, group in groups]


def _read_scenario(file: Path) -> Mapping[str, Any]:
    """Return the canonical scenario of a run."""
    try:
        scenario = json.loads(file.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        where = "no such folder" if not file.parent.exists() else f"no {file.name} in it"
        raise RunFolderError(f"{file.parent}: not a run folder ({where}). Give the folder a run wrote") from None
    except ValueError as error:
        raise RunFolderError(f"{file}: not valid JSON ({error})") from error
    if not isinstance(scenario, dict):
        raise RunFolderError(f"{file}: expected a JSON object, got {type(scenario).__name__}")
    return scenario


def _objectives_of(scenario: Mapping[str, Any], file: Path) -> tuple[Objective, ...]:
    """Return the objectives a canonical scenario names."""
    try:
        return tuple(
            Objective(name=o["name"], goal=Goal(o.get("goal", "minimize")), reference_point=o.get("reference_point"))
            for o in scenario["objectives"]
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise RunFolderError(f"{file}: its objectives cannot be read ({error!r})") from error


def _read_rows(file: Path, required: Sequence[str]) -> tuple[tuple[str, ...], tuple[Mapping[str, str], ...]]:
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


def _numbers(rows: Sequence[Mapping[str, str]], names: Sequence[str], file: Path) -> FloatArray:
    """Return columns as numbers, shape (n, len(names)); NaN where a cell is empty or the column is missing."""
    numbers = np.full((len(rows), len(names)), np.nan)
    for i, row in enumerate(rows):
        for j, name in enumerate(names):
            try:
                numbers[i, j] = float(row.get(name) or "nan")
            except ValueError:
                raise RunFolderError(f"{file}: record {i + 2}: {name} is not a number: {row[name]!r}") from None
    return numbers


def _require_completed(run: Run) -> None:
    """Raise RunFolderError if there is nothing to draw."""
    if not run.is_completed.any():
        counts = ", ".join(f"{n} {state}" for state, n in Counter(run.states).items()) or "no rows"
        raise RunFolderError(f"{run.folder}: no completed evaluation yet ({counts})")


def _require_same_objectives(first: Run, run: Run) -> None:
    """Raise UsageError if two runs do not measure the same quantities."""
    expected, found = ([f"{o.name} ({o.goal.value})" for o in r.objectives] for r in (first, run))
    if expected != found:
        raise UsageError(
            f"runs with different objectives cannot share a picture: {first.folder} has {', '.join(expected)}; "
            f"{run.folder} has {', '.join(found)}"
        )


def _distinct_names(folders: Sequence[Path]) -> list[str]:
    """Return the shortest endings of the paths that differ from each other."""
    parts = [folder.resolve().parts for folder in folders]
    if len(set(parts)) < len(parts):
        raise UsageError("the same run folder is given twice")
    length = 1
    while len({p[-length:] for p in parts}) < len(parts):
        length += 1
    return ["/".join(p[-length:]) for p in parts]
