"""The rows of a run's history that confirm earlier ones, in a table: all rows of a configuration as one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from hypermap_lite.scenario.table import Table

if TYPE_CHECKING:
    from hypermap_lite.typing import FloatArray

NEEDED: Final = ("phase", "state", "replicates")
"""Columns that a history has, and a table from elsewhere that is taken as it is has not."""


def with_confirmed_pooled(table: Table) -> Table:
    """Return a table with the rows of each confirmed configuration as one, if it is the history of a run.

    That is the first row with the mean over all replicates; or, if one of the rows is not completed, that one. See
    `hypermap_lite.history.pooling`. Rows with anything but numbers for objectives stay as they are.
    """
    if not all(name in table.header for name in NEEDED):
        return table
    from hypermap_lite.history.pooling import CONFIRM, confirmed_groups  # slow to import, and most tables do without

    objectives = [name for name in table.header if f"{name}_sem" in table.header]
    phases = table.column("phase")
    if not objectives or CONFIRM not in phases:
        return table
    n_parameters = table.header.index(objectives[0])
    groups = confirmed_groups([tuple(record[:n_parameters]) for record in table.records], phases)
    kept = [pair for group in groups for pair in _as_one(table, group, objectives)]
    return replace(
        table,
        records=tuple(record for record, _ in kept),
        numbers=tuple(table.numbers[i] for _, i in kept),
    )


def _as_one(table: Table, group: Sequence[int], objectives: Sequence[str]) -> list[tuple[Sequence[str], int]]:
    """Return what some rows of one configuration are together, and the position of the row that tells it."""
    records = [table.records[i] for i in group]
    states = table.column("state")
    failed = next((i for i in group if states[i] != "completed"), None)
    if len(group) == 1:
        return [(records[0], group[0])]
    if failed is not None:
        return [(table.records[failed], failed)]
    from hypermap_lite.history.pooling import pool

    try:
        means = _numbers(table, group, objectives)
        errors = _numbers(table, group, [f"{name}_sem" for name in objectives])
        sizes = [int(table.column("replicates")[i]) for i in group]
    except ValueError:
        return list(zip(records, group, strict=True))
    mean, error, n = pool(means, errors, sizes)
    texts = {name: repr(float(value)) for name, value in zip(objectives, mean, strict=True)}
    texts |= {f"{name}_sem": repr(float(value)) for name, value in zip(objectives, error, strict=True)}
    texts["replicates"] = str(n)
    return [([texts.get(name, text) for name, text in zip(table.header, records[0], strict=True)], group[0])]


def _numbers(table: Table, group: Sequence[int], names: Sequence[str]) -> FloatArray:
    """Return the numbers in some rows and columns, shape (rows, columns); NaN for an empty cell."""
    columns = [table.column(name) for name in names]
    return np.array([[float(column[i] or math.nan) for column in columns] for i in group])
