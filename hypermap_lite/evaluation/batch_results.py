"""Reading what a function returned for a whole batch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hypermap_lite.evaluation.evaluator import as_mapping, failure, has_an_order, outcome_of, shorten
from hypermap_lite.evaluation.outcome import Outcome
from hypermap_lite.objectives import FeasibleOutput


def outcomes_of(
    result: Any, objectives: Sequence[str], n: int, feasible_output: FeasibleOutput | None = None
) -> tuple[Outcome, ...]:
    """Turn what a black box returned for n configurations into n outcomes.

    Parameters
    ----------
    result
        A mapping of columns, or a pandas data frame; or a sequence, an array or a pandas series with an item per
        configuration, each as `outcome_of` takes it.
    objectives
        Their names.
    n
        Number of configurations.
    feasible_output
        What says whether a configuration is allowed; None for an entry ``feasible`` that may be left out.

    Returns
    -------
    tuple of Outcome
        One per configuration; if the result as a whole has another form or length, all failed for that reason.
    """
    per_row = [*objectives, *([] if feasible_output is None else [feasible_output.name])]
    items = _rows(result, per_row, n)
    if isinstance(items, str):
        return (failure(items),) * n
    return tuple(outcome_of(item, objectives, feasible_output) for item in items)


def _rows(result: Any, per_row: Sequence[str], n: int) -> Sequence[object] | str:
    """Return an item per configuration, or what is wrong with the result."""
    columns = None if getattr(result, "ndim", None) == 1 else as_mapping(result)
    if columns is not None:
        return _rows_of_columns(columns, per_row, n)
    if not has_an_order(result):
        wanted = "a list with an item per configuration, or a mapping of such lists"
        return f"the result for {n} configurations is {shorten(result)}; expected {wanted}"
    rows = list(result)
    return rows if len(rows) == n else f"the function returned {len(rows)} results for {n} configurations"


def _rows_of_columns(columns: Mapping[str, object], per_row: Sequence[str], n: int) -> Sequence[object] | str:
    """Turn columns by name into rows by name; a single value of anything else goes into every row."""
    rows: list[dict[str, object]] = [{} for _ in range(n)]
    for name, column in columns.items():
        items = list(column) if has_an_order(column) else None
        if items is None and name in per_row:
            return f"'{name}' is {shorten(column)}; expected a list of {n} values"
        if items is not None and len(items) != n:
            return f"'{name}' holds {len(items)} values for {n} configurations"
        for row, item in zip(rows, [column] * n if items is None else items, strict=True):
            row[name] = item
    return rows
