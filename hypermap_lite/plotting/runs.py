"""What a finished or running experiment left in its folder, read for pictures and fronts.

Light on purpose: ``history.csv`` and ``scenario.json`` are enough, no part of the optimizer is imported.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np

from hypermap_lite.errors import RunFolderError, UsageError
from hypermap_lite.objectives import Objective, to_minimization
from hypermap_lite.pareto import non_dominated
from hypermap_lite.plotting.files import numbers_of, objectives_of, read_rows, read_samples, read_scenario
from hypermap_lite.typing import BoolArray, FloatArray

DESIGN_PHASES: Final = ("earlier", "default", "design")
"""Phases of ``history.csv`` that come before there is a model: evaluations of an earlier experiment count as design."""

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

    samples: Path | None = None
    """The samples file it was read from, if it has no run folder."""

    @property
    def place(self) -> Path:
        """What tells it from other runs: its folder or samples file."""
        return self.folder if self.samples is None else self.samples

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


@dataclass(frozen=True, slots=True, kw_only=True)
class SamplesFile:
    """A CSV file without a run folder, such as HyperMapper writes, and what its columns mean."""

    path: Path
    scenario: Mapping[str, Any]
    """A canonical scenario, or no more of one than its ``objectives``."""


Source: TypeAlias = str | Path | SamplesFile
"""A run folder, the ``history.csv`` in it, or a samples file."""


def load_run(source: Source, *, label: str = "") -> Run:
    """Read a run folder, or a samples file.

    Parameters
    ----------
    source
        The run folder, the ``history.csv`` in it, or a samples file.
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
    if isinstance(source, SamplesFile):
        return _load_samples(source, label)
    path = Path(source)
    history_file = path if path.suffix == ".csv" and not path.is_dir() else path / "history.csv"
    folder = history_file.parent
    if history_file.is_file() and history_file == path and not (folder / "scenario.json").exists():
        what = "no scenario.json is beside it, so it is not known what its columns mean"
        raise RunFolderError(f"{path}: {what}. Say it with --scenario or --objectives")
    scenario = read_scenario(folder / "scenario.json")
    objectives = objectives_of(scenario, folder / "scenario.json")
    columns, rows = read_rows(history_file, required=["state", *(o.name for o in objectives)])
    names = [o.name for o in objectives]
    values = numbers_of(rows, names, history_file)
    errors = numbers_of(rows, [f"{name}_sem" for name in names], history_file)
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


def _load_samples(source: SamplesFile, label: str) -> Run:
    """Read a samples file as the history of a run."""
    objectives = objectives_of(source.scenario, source.path)
    columns, rows = read_samples(source.path, source.scenario, objectives)
    names = [o.name for o in objectives]
    values = np.full((len(rows), len(names)), np.nan)
    is_completed = [row["state"] == "completed" for row in rows]
    values[is_completed] = numbers_of([row for row in rows if row["state"] == "completed"], names, source.path)
    return Run(
        folder=source.path.parent,
        samples=source.path,
        label=label or source.path.stem,
        scenario=source.scenario,
        objectives=objectives,
        columns=columns,
        rows=rows,
        values=values,
        standard_errors=np.full(values.shape, np.nan),
    )


def load_runs(sources: Sequence[Source], labels: Sequence[str] | None = None) -> list[Run]:
    """Read the runs of one picture and check that they can share it.

    Parameters
    ----------
    sources
        Run folders, the ``history.csv`` in them, or samples files; at least one.
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
    names = (
        labels
        if labels is not None
        else _distinct_names([run.folder if run.samples is None else run.samples.with_suffix("") for run in runs])
    )
    for run in runs:
        _require_completed(run)
        _require_same_objectives(runs[0], run)
    return [replace(run, label=name) for run, name in zip(runs, names, strict=True)]


def require_drawable(runs: Sequence[Run], reference_point: FloatArray | None = None) -> None:
    """Raise UsageError if values, or the reference point's, are so large that no axis can be drawn around them."""
    for run in runs:
        largest = float(np.nanmax(np.abs(run.values)))
        if largest > LARGEST_DRAWN:
            raise UsageError(f"{run.place}: objective values up to {largest:g} in size cannot be drawn")
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


def _require_completed(run: Run) -> None:
    """Raise RunFolderError if there is nothing to draw."""
    if not run.is_completed.any():
        counts = ", ".join(f"{n} {state}" for state, n in Counter(run.states).items()) or "no rows"
        raise RunFolderError(f"{run.place}: no completed evaluation yet ({counts})")


def _require_same_objectives(first: Run, run: Run) -> None:
    """Raise UsageError if two runs do not measure the same quantities."""
    expected, found = ([f"{o.name} ({o.goal.value})" for o in r.objectives] for r in (first, run))
    if expected != found:
        raise UsageError(
            f"runs with different objectives cannot share a picture: {first.place} has {', '.join(expected)}; "
            f"{run.place} has {', '.join(found)}"
        )


def _distinct_names(places: Sequence[Path]) -> list[str]:
    """Return the shortest endings of the paths that differ from each other."""
    parts = [place.resolve().parts for place in places]
    if len(set(parts)) < len(parts):
        raise UsageError("the same run folder is given twice")
    length = 1
    while len({p[-length:] for p in parts}) < len(parts):
        length += 1
    return ["/".join(p[-length:]) for p in parts]
