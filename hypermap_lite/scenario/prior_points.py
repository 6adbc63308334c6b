"""The points behind a kernel density prior: which rows of a CSV file count, and what they say of the parameters.

They are read once, when a scenario is loaded, and are part of it from then on. So a run does not depend on the file.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.objectives import Goal
from hypermap_lite.scenario.confirmed_rows import NEEDED, with_confirmed_pooled
from hypermap_lite.scenario.consistency import names_in
from hypermap_lite.scenario.defaults import has_belief
from hypermap_lite.scenario.messages import enumerate_names
from hypermap_lite.scenario.sources import Layer, folders_of
from hypermap_lite.scenario.table import Table, find_file, read_table
from hypermap_lite.typing import BoolArray, FloatArray, Value

ROUNDING: Final = 1e-9
"""How far beyond a bound, as a share of the range, a value may lie from rounding alone."""

FEASIBILITY_COLUMNS: Final = ("feasible", "Valid")
"""Columns that say whether a row counts, unless the scenario calls something of its own so."""

NO: Final = ("false", "0", "0.0", "no")
"""What stands in such a column if it does not."""


def with_points(document: Mapping[str, Any], layers: Sequence[Layer], directory: Path) -> dict[str, Any]:
    """Return a complete document with the points of its kernel density priors filled in from their files.

    Parameters
    ----------
    document
        As `check_consistency` has passed it.
    layers
        What it was put together from; says beside which file the CSV file is looked for.
    directory
        Folder of the scenario.

    Raises
    ------
    ScenarioError
        If a file cannot be read, lacks a column, or has no usable row.
    """
    parameters, priors = document["input_parameters"], document["priors"]
    taken = {name for name, parameter in parameters.items() if has_belief(parameter)}
    taken |= {name for prior in priors for _, name in names_in("$", prior)}
    filled = []
    for i, prior in enumerate(priors):
        path = f"$.priors[{i}]"
        if prior["type"] == "kde" and prior["points"] is None:
            names = prior["parameters"] or [name for name in parameters if name not in taken]
            taken.update(names)
            folders = (*folders_of(f"{path}.file", layers, directory), Path.cwd())
            try:
                prior = _read(prior, names, document, folders)
            except ScenarioError as error:
                raise error.below(path) from None
        filled.append(prior)
    return {**document, "priors": filled}


def _read(
    prior: Mapping[str, Any], names: Sequence[str], document: Mapping[str, Any], folders: Sequence[Path]
) -> dict[str, Any]:
    if not names:
        problem = "every parameter has a prior already"
        raise ScenarioError("$.parameters", problem, allowed="one prior per parameter", hint="Drop the others.")
    try:
        table = _open(prior["file"], prior["rows"], folders)
        if not _own_names(document).intersection(NEEDED):
            table = with_confirmed_pooled(table)
        _require_columns(table, names)
        rows = _chosen(table, prior, document)
        values = _values(table, rows, {name: document["input_parameters"][name] for name in names})
    except ScenarioError as error:
        raise (error if error.path != "$" else error.below("$.file")) from None
    weights = None if prior["weights"] is None else _weights(table, rows, prior["weights"])
    kept = [k for k in range(len(rows)) if weights is None or weights[k] > 0]
    return {
        **prior,
        "points": {name: [column[k] for k in kept] for name, column in values.items()},
        "point_weights": None if weights is None else [weights[k] for k in kept],
    }


def _open(file: str, rows: str, folders: Sequence[Path]) -> Table:
    """Read a CSV file, or that of a run folder, from the first folder that has it."""
    path = find_file(file, folders)
    if not path.is_dir():
        return read_table(path, file)
    wanted = ["pareto.csv", "history.csv"] if rows == "non_dominated" else ["history.csv"]
    name = next((name for name in wanted if (path / name).is_file()), None)
    if name is None:
        raise ScenarioError("$", f"the folder '{file}' has no {' and no '.join(wanted)}", allowed="a run folder")
    return read_table(path / name, str(Path(file) / name))


def _require_columns(table: Table, names: Sequence[str]) -> None:
    missing = [name for name in names if name not in table.header]
    if missing:
        problem = f"{table.name} has no column {enumerate_names([repr(name) for name in missing], 6)}"
        hint = nearest(missing[0], table.header) or 'List those it has in "parameters".'
        raise ScenarioError("$", problem, allowed=f"its columns: {enumerate_names(table.header, 12)}", hint=hint)


def _chosen(table: Table, prior: Mapping[str, Any], document: Mapping[str, Any]) -> list[int]:
    """Return which records count, by their position in the table."""
    if not table.records:
        raise ScenarioError("$", f"{table.name} has no rows below its header", allowed="at least one usable row")
    objectives = document["objectives"]
    verdicts = _verdicts(table, _own_names(document), document["feasible_output"] or {})
    if prior["rows"] == "all":
        return _require_some(table, verdicts)
    missing = [objective["name"] for objective in objectives if objective["name"] not in table.header]
    if missing:
        problem = f"{table.name} has no column for the objective '{missing[0]}'"
        hint = f'{nearest(missing[0], table.header)} Or write "rows": "all".'.strip()
        raise ScenarioError("$", problem, allowed=f"its columns: {enumerate_names(table.header, 12)}", hint=hint)
    Y = np.column_stack([_objective(table, objective, verdicts) for objective in objectives])
    without = np.flatnonzero(~np.isfinite(Y).all(axis=1))
    for k in without:
        verdicts[k] = verdicts[k] or "without objective values"
    rows = _require_some(table, verdicts)
    is_chosen = _best(Y[rows], prior["quantile"])
    return [k for k, keep in zip(rows, is_chosen, strict=True) if keep]


def _own_names(document: Mapping[str, Any]) -> set[str]:
    """Return the names of parameters and objectives: a column of one of them has no other meaning."""
    return {*document["input_parameters"], *(objective["name"] for objective in document["objectives"])}


def _verdicts(table: Table, own_names: set[str], feasible_output: Mapping[str, str]) -> list[str]:
    """Say of each record why it does not count; nothing if it does."""
    verdicts = [""] * len(table.records)
    words: dict[str, tuple[str, ...]] = dict.fromkeys(FEASIBILITY_COLUMNS, NO)
    if feasible_output:
        words[feasible_output["name"]] = (feasible_output["false_value"].strip().lower(),)
    for name, no in words.items():
        if name in table.header and name not in own_names:
            texts = table.column(name)
            verdicts = ["infeasible" if text.lower() in no else old for text, old in zip(texts, verdicts, strict=True)]
    if "state" in table.header and "state" not in own_names:
        states = table.column("state")
        verdicts = [
            old if state == "completed" else "not completed" for old, state in zip(verdicts, states, strict=True)
        ]
    return verdicts


def _require_some(table: Table, verdicts: Sequence[str]) -> list[int]:
    """Return the positions of the records that count, of which there must be one."""
    usable = [k for k, verdict in enumerate(verdicts) if not verdict]
    if not usable:
        reasons = ", ".join(f"{n} {verdict}" for verdict, n in Counter(verdicts).items())
        problem = f"none of the {len(verdicts)} rows of {table.name} is usable: {reasons}"
        raise ScenarioError("$", problem, allowed="at least one completed, feasible row")
    return usable


def _objective(table: Table, objective: Mapping[str, Any], verdicts: Sequence[str]) -> list[float]:
    """Return an objective to be minimized; NaN where the cell is empty or the record does not count anyway."""
    sign = 1.0 if Goal(objective["goal"]) is Goal.MINIMIZE else -1.0
    texts = table.column(objective["name"])
    is_read = [bool(text) and not verdict for text, verdict in zip(texts, verdicts, strict=True)]
    return [
        sign * _number(table, k, objective["name"], may_be_nan=True) if read else math.nan
        for k, read in enumerate(is_read)
    ]


def _best(Y: FloatArray, share: float | None) -> BoolArray:
    """Mark the best share of n points, shape (n,), by non-dominated sorting; None for the first front only.

    Whole fronts are taken until the share is reached.
    """
    from hypermap_lite.pareto.dominance import non_dominated  # slow to import, and most scenarios do without

    if share is None:
        return non_dominated(Y)
    n = max(math.ceil(share * len(Y) - ROUNDING), 1)
    if Y.shape[1] == 1:
        return Y[:, 0] <= np.sort(Y[:, 0])[n - 1]
    chosen = np.zeros(len(Y), dtype=bool)
    while chosen.sum() < n:
        rest = np.flatnonzero(~chosen)
        chosen[rest[non_dominated(Y[rest])]] = True
    return chosen


def _values(table: Table, rows: Sequence[int], parameters: Mapping[str, Mapping[str, Any]]) -> dict[str, list[Value]]:
    """Return the values of each parameter in some records, in native units."""
    columns = {name: list(_legal(table, rows, name, entry)) for name, entry in parameters.items()}
    n_bad = sum(None in values for values in zip(*columns.values(), strict=True))
    if n_bad:
        counts = {name: column.count(None) for name, column in columns.items() if None in column}
        are_bounded = all(parameters[name]["parameter_type"] == "real" for name in counts)
        what = "lie outside the bounds" if are_bounded else "hold values that are not allowed"
        listed = ", ".join(f"'{name}' {n}" for name, n in counts.items())
        problem = f"{n_bad} of {len(rows)} rows of {table.name} {what}: {listed}"
        first = next(iter(counts))
        values = enumerate_names([str(value) for value in parameters[first]["values"]], 8)
        whole = "whole numbers, " * (parameters[first]["parameter_type"] == "integer")
        if parameters[first]["parameter_type"] == "permutation":
            values = f"the numbers below {values} in any order"
        allowed = f"for '{first}': {whole}{values if _is_listed(parameters[first]) else values.replace(', ', ' to ')}"
        raise ScenarioError("$", problem, allowed=allowed, hint="Leave these rows out, or widen the parameter.")
    return {name: [value for value in column if value is not None] for name, column in columns.items()}


def _legal(table: Table, rows: Sequence[int], name: str, entry: Mapping[str, Any]) -> Iterator[Value | None]:
    """Yield a parameter's value in each of some records; None where it is none the parameter can take."""
    texts, kind, values = table.column(name), entry["parameter_type"], entry["values"]
    for k in rows:
        if kind == "categorical":
            yield texts[k] if texts[k] in values else None
            continue
        if kind == "permutation":
            yield _order(texts[k], values[0])
            continue
        number = _number(table, k, name)
        low, high = min(values), max(values)
        slack = ROUNDING * (high - low)
        if kind == "ordinal":
            yield next((level for level in values if abs(number - level) <= slack), None)
        elif not low - slack <= number <= high + slack:
            yield None
        elif kind == "real":
            yield float(min(max(number, low), high))
        else:
            yield round(number) if abs(number - round(number)) <= max(slack, ROUNDING) else None


def _order(text: str, size: int) -> Value | None:
    words = text.split()
    is_order = sorted(words) == sorted(map(str, range(size)))
    return [int(word) for word in words] if is_order else None  # type: ignore[return-value]  # a list, as JSON has it


def _is_listed(entry: Mapping[str, Any]) -> bool:
    return entry["parameter_type"] in ("ordinal", "categorical", "permutation")


def _weights(table: Table, rows: Sequence[int], name: str) -> list[float]:
    if name not in table.header:
        allowed = f"its columns: {enumerate_names(table.header, 12)}"
        problem = f"{table.name} has no column '{name}'"
        raise ScenarioError("$.weights", problem, allowed=allowed, hint=nearest(name, table.header))
    try:
        weights = [_number(table, k, name) for k in rows]
    except ScenarioError as error:
        raise ScenarioError("$.weights", error.problem, allowed="a number >= 0") from None
    for k, weight in zip(rows, weights, strict=True):
        if weight < 0:
            problem = f"{table.name}, record {table.numbers[k]}: '{name}' is {weight:g}"
            raise ScenarioError("$.weights", problem, allowed="a number >= 0")
    if not any(weights):
        problem = f"the weights of all {len(rows)} rows of {table.name} are zero"
        raise ScenarioError("$.weights", problem, allowed="at least one weight > 0")
    return weights


def _number(table: Table, k: int, name: str, *, may_be_nan: bool = False) -> float:
    """Return the number in a record's cell."""
    text = table.records[k][table.header.index(name)].strip()
    try:
        number = float(text)
    except ValueError:
        number = math.nan
        may_be_nan = may_be_nan and text.lower() == "nan"
    if not math.isfinite(number) and not may_be_nan:
        problem = f"{table.name}, record {table.numbers[k]}: '{name}' is {text[:40]!r}"
        raise ScenarioError("$", problem, allowed="a finite number")
    return number
