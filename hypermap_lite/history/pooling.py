"""Configurations that were evaluated several times: all their replicates as one sample.

A front that took the best of several rows of one configuration would take its luckiest draw. So wherever configurations
are compared, a row that confirms an earlier one (phase ``confirm``) counts together with it: the mean over all their
replicates, with the standard error of that mean. Rows that repeat one another for any other reason, such as those of an
earlier experiment, stay apart.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from hypermap_lite.evaluation.outcome import CONFIRM as CONFIRM
from hypermap_lite.evaluation.outcome import WORST_FIRST, Evaluation, State
from hypermap_lite.typing import Configuration, FloatArray


def key_of(configuration: Configuration) -> Hashable:
    """Return a name that is equal for equal configurations."""
    return tuple(configuration[name] for name in sorted(configuration))


def groups_of(keys: Iterable[Hashable]) -> list[list[int]]:
    """Return the positions of equal keys together, in the order in which each key comes first.

    Examples
    --------
    >>> groups_of("abac")
    [[0, 2], [1], [3]]
    """
    groups: dict[Hashable, list[int]] = {}
    for i, key in enumerate(keys):
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def pool(
    means: FloatArray, standard_errors: FloatArray, replicates: Sequence[int]
) -> tuple[FloatArray, FloatArray, int]:
    """Return what the samples of k rows are as one sample.

    Parameters
    ----------
    means
        Of each row, shape (k, m).
    standard_errors
        Of these means (divisor r - 1), shape (k, m); NaN where a row has one replicate, or its spread is not known.
    replicates
        Sizes of the samples, k numbers >= 1.

    Returns
    -------
    mean
        Over all replicates, shape (m,).
    standard_error
        Of that mean, shape (m,): exactly that of the joint sample if the spreads of all rows are known; else their
        variance is estimated from what is known, within rows and between them. NaN where nothing is.
    n
        Size of the joint sample.

    Examples
    --------
    >>> mean, error, n = pool(np.array([[1.0], [4.0]]), np.array([[1.0], [np.nan]]), [2, 1])
    >>> mean.tolist(), error.tolist(), n  # of 0, 2 and 4
    ([2.0], [1.1547005383792515], 3)
    """
    n = sum(replicates)
    sizes = np.array(replicates, dtype=float)[:, None]
    mean = (sizes / n * means).sum(axis=0)
    is_known = np.isfinite(standard_errors) & (sizes > 1)
    within = np.where(is_known, sizes * (sizes - 1) * np.where(is_known, standard_errors, 0.0) ** 2, 0.0)
    squares = within.sum(axis=0) + (sizes * (means - mean) ** 2).sum(axis=0)
    freedom = (is_known * (sizes - 1)).sum(axis=0) + len(means) - 1
    with np.errstate(invalid="ignore", divide="ignore"):
        error = np.where(freedom > 0, np.sqrt(squares / freedom / n), np.nan)
    return mean, error, n


def confirmed_groups(keys: Sequence[Hashable], phases: Sequence[str]) -> list[list[int]]:
    """Return which rows count together, by their positions, in the order of the first of each group.

    Parameters
    ----------
    keys
        Of the rows' configurations.
    phases
        Of the rows; those of one configuration are a group if any of them is ``confirm``.

    Examples
    --------
    >>> confirmed_groups(["a", "b", "b", "a"], ["design", "earlier", "earlier", "confirm"])
    [[0, 3], [1], [2]]
    """
    confirmed = {key for key, phase in zip(keys, phases, strict=True) if phase == CONFIRM}
    return groups_of((key, -1) if key in confirmed else (key, i) for i, key in enumerate(keys))


def pooled(evaluations: Iterable[Evaluation]) -> list[Evaluation]:
    """Return the evaluations with those that were confirmed pooled, in the order in which each was first evaluated.

    That of a configuration with several rows is its first one with the pooled values, standard errors and number of
    replicates. If one of its rows is not completed, neither is the configuration: a mean over the others would favour
    what fails often.
    """
    rows = list(evaluations)
    if not any(row.suggestion.phase == CONFIRM for row in rows):
        return rows
    groups = confirmed_groups([key_of(row.configuration) for row in rows], [row.suggestion.phase for row in rows])
    return [as_one([rows[i] for i in group]) for group in groups]


def as_one(rows: Sequence[Evaluation]) -> Evaluation:
    """Return the rows of one configuration, at least one, as one evaluation; see `pooled`."""
    if len(rows) == 1:
        return rows[0]
    states = [row.state for row in rows]
    state = next((worst for worst in WORST_FIRST if worst in states), State.COMPLETED)
    if state is not State.COMPLETED:
        return next(row for row in rows if row.state is state)
    names = list(rows[0].values)
    means = np.array([[row.values[name] for name in names] for row in rows])
    errors = np.array([[row.standard_errors.get(name, math.nan) for name in names] for row in rows])
    mean, error, n = pool(means, errors, [row.replicates for row in rows])
    return replace(
        rows[0],
        values=dict(zip(names, mean.tolist(), strict=True)),
        standard_errors=dict(zip(names, error.tolist(), strict=True)),
        replicates=n,
        seconds=math.fsum(row.seconds for row in rows),
    )
