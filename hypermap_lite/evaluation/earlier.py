"""Evaluations of an earlier experiment, read from a CSV file to become the first rows of a run.

The file may be HyperMapper's samples file or a ``history.csv``; columns go by name, in any order, and others are
ignored. It is read once, when the run begins: from then on its rows stand in the run's own history.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.evaluation.outcome import EARLIER, Evaluation, State, Suggestion
from hypermap_lite.history.foreign_values import parse_foreign_value
from hypermap_lite.objectives import Objective
from hypermap_lite.scenario.feasibility_column import FeasibilityColumn, usual_feasibility
from hypermap_lite.scenario.messages import enumerate_names
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.scenario.table import Table, find_file, read_table
from hypermap_lite.space import Parameter, SearchSpace
from hypermap_lite.typing import Value

PATH: Final = "$.earlier_evaluations"

SHORTEST_EPOCH: Final = 1e11
"""Timestamps from here on [ms] are dates: more than three years."""

SKIPPED: Final = ("failed", "timeout")
"""States of rows that bring nothing."""


def earlier_evaluations(scenario: Scenario, space: SearchSpace) -> list[Evaluation]:
    """Return the evaluations that a scenario takes over; none if it names no file.

    Raises
    ------
    ScenarioError
        If the file is missing or no table, lacks a column, has no usable row, or a value that is not allowed.
    """
    if scenario.earlier_evaluations is None:
        return []
    folders = (*scenario.folders_of(PATH), Path.cwd())
    try:
        table = _open(scenario.earlier_evaluations, folders)
        return rows_of(table, space, scenario.objectives, FeasibilityColumn.of(scenario.canonical))
    except ScenarioError as error:
        place = error if error.path == PATH else error.below(PATH)
        raise scenario.located(place) from None


def rows_of(
    table: Table,
    space: SearchSpace,
    objectives: Sequence[Objective],
    feasibility: FeasibilityColumn | None = None,
) -> list[Evaluation]:
    """Return the rows of a table as evaluations, trial 0 first, without those that failed.

    Repeated configurations are kept: each was paid for, and they tell of noise.

    Parameters
    ----------
    table
        With a column per parameter and objective.
    space, objectives
        What the columns mean.
    feasibility
        The scenario's feasibility column, which the table must have too unless it has the states of a
        ``history.csv``; if None, a column ``Valid`` or ``feasible`` counts if there is one.
    """
    names = [*space.names, *(o.name for o in objectives)]
    columns = usual_feasibility(table.header, names) if feasibility is None else [feasibility]
    if feasibility is not None and "state" in table.header and feasibility.name not in table.header:
        columns = []
    _require_columns(table, [*names, *(column.name for column in columns)])
    states = _states(table, names, columns)
    rows = [k for k, state in enumerate(states) if state is not None]
    if not rows:
        failed = f": {len(states)} failed" if states else ""
        problem = f"{table.name} has no usable row{failed}"
        raise ScenarioError("$", problem, allowed="at least one row that is completed or infeasible")
    configurations = _configurations(table, rows, space)
    timestamps = _timestamps(table, rows)
    return [
        Evaluation(
            suggestion=Suggestion(trial=trial, configuration=configurations[trial], phase=EARLIER),
            state=State(states[k]),
            values=_values(table, k, objectives, is_required=states[k] is State.COMPLETED),
            timestamp=timestamps[trial],
        )
        for trial, k in enumerate(rows)
    ]


def _open(file: str, folders: Sequence[Path]) -> Table:
    """Read a CSV file, or the history of a run folder, from the first folder that has it."""
    path = find_file(file, folders)
    if path.is_dir():
        return read_table(path / "history.csv", str(Path(file) / "history.csv"))
    return read_table(path, file)


def _require_columns(table: Table, names: Sequence[str]) -> None:
    missing = [name for name in names if name not in table.header]
    if missing:
        problem = f"{table.name} has no column {enumerate_names([repr(name) for name in missing], 12)}"
        allowed = f"a column per parameter and objective; its columns are {enumerate_names(table.header, 12)}"
        raise ScenarioError("$", problem, allowed=allowed, hint=nearest(missing[0], table.header))


def _states(table: Table, names: Sequence[str], columns: Sequence[FeasibilityColumn]) -> list[State | None]:
    """Return whether each record is completed or infeasible; None for those that failed."""
    states: list[State | None] = [State.COMPLETED] * len(table.records)
    if "state" in table.header and "state" not in names:
        known = {state.value: state for state in State}
        for k, text in enumerate(table.column("state")):
            if text not in known:
                problem = f"{table.name}, record {table.numbers[k]}: the state is '{text}'"
                raise ScenarioError("$", problem, allowed=", ".join(known))
            states[k] = None if text in SKIPPED else known[text]
    for column in columns:
        for k, text in enumerate(table.column(column.name)):
            is_feasible = column.is_feasible(text)
            if states[k] is State.COMPLETED and is_feasible is None:
                problem = f"{table.name}, record {table.numbers[k]}: '{column.name}' is '{text}'"
                raise ScenarioError("$", problem, allowed=f"'{column.yes[0]}' or '{column.no[0]}'")
            if is_feasible is False and states[k] is not None:
                states[k] = State.INFEASIBLE
    return states


def _configurations(table: Table, rows: Sequence[int], space: SearchSpace) -> list[dict[str, Value]]:
    """Return the configurations of some records; one error for all values that are not allowed."""
    texts = {p.name: table.column(p.name) for p in space.parameters}
    values = {p.name: [_value(p, texts[p.name][k]) for k in rows] for p in space.parameters}
    bad = {name: [i for i, value in enumerate(column) if value is None] for name, column in values.items()}
    counts = {name: len(places) for name, places in bad.items() if places}
    if counts:
        name = next(iter(counts))
        k = rows[bad[name][0]]
        n_bad = len(set().union(*bad.values()))
        listed = enumerate_names([f"'{name}' {n}" for name, n in counts.items()], 8)
        raise ScenarioError(
            "$",
            f"{n_bad} of {len(rows)} rows of {table.name} hold values that are not allowed ({listed}); "
            f"the first: '{name}' is '{texts[name][k][:40]}' in record {table.numbers[k]}",
            allowed=f"for '{name}': {space.parameters[space.names.index(name)].allowed()}",
            hint="Leave these rows out, or widen the parameter.",
        )
    configurations = [dict(zip(space.names, row, strict=True)) for row in zip(*values.values(), strict=True)]
    outside = [k for k, c in zip(rows, configurations, strict=True) if not space.contains(c)]
    if outside:
        problem = f"{len(outside)} of {len(rows)} rows of {table.name} are not in the search space, the first record "
        hint = "Leave these rows out, or drop the constraint."
        raise ScenarioError("$", f"{problem}{table.numbers[outside[0]]}", allowed="rows that obey it", hint=hint)
    return configurations


def _value(parameter: Parameter, text: str) -> Value | None:
    try:
        return parse_foreign_value(parameter, text)
    except ValueError:
        return None


def _values(table: Table, k: int, objectives: Sequence[Objective], *, is_required: bool) -> dict[str, float]:
    """Return the objective values of a record; of an infeasible one none, unless it has them all."""
    values = {o.name: _number(table.records[k][table.header.index(o.name)]) for o in objectives}
    bad = next((name for name, value in values.items() if not math.isfinite(value)), None)
    if bad is None:
        return values
    if is_required:
        text = table.records[k][table.header.index(bad)].strip()
        problem = f"{table.name}, record {table.numbers[k]}: '{bad}' is '{text[:40]}'"
        raise ScenarioError("$", problem, allowed="a finite number", hint="Leave this row out.")
    return {}


def _timestamps(table: Table, rows: Sequence[int]) -> list[int]:
    """Return whole milliseconds, as far as there are any; dates count from the first of them."""
    if "Timestamp" not in table.header:
        return [0] * len(rows)
    column = table.column("Timestamp")
    numbers = [max(number, 0.0) if math.isfinite(number := _number(column[k])) else 0.0 for k in rows]
    dates = [number for number in numbers if number >= SHORTEST_EPOCH]
    start = min(dates, default=0.0)
    return [round(number - start) if number >= SHORTEST_EPOCH else round(number) for number in numbers]


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
