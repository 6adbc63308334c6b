"""When failures in a row mean that the evaluator is broken, and when their parameters explain them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from hypermap_lite.evaluation.outcome import Evaluation, State
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.surrogates.feasibility import ProbitProcess

USUAL: Final = 5
"""Failures in a row that end a run, unless their parameters explain them."""

MOST: Final = 20
"""Failures in a row that end a run in any case."""

CHANCE: Final = 0.002
"""Of so many failures in a row by their parameters alone, below which the evaluator counts as broken.

Where 40 % of the space fail, in two to four dimensions, the fifth failure in a row had a chance of 0.02 to 0.3; where a
sound evaluator broke after 20 evaluations, of 0.0003 at most.
"""


def is_failure(evaluation: Evaluation) -> bool:
    """Tell whether an evaluation failed or ran out of time: being infeasible is a result."""
    return evaluation.state in (State.FAILED, State.TIMEOUT)


def is_too_long(rows: Sequence[Evaluation], n: int, space: SearchSpace, limit: int | None = None) -> bool:
    """Tell whether the last n rows, all of them failures, are too many in a row.

    Parameters
    ----------
    rows
        All evaluations so far.
    n
        How many of the last ones count.
    space
        Of their parameters.
    limit
        So many are; None: `USUAL`, if it is unlikely that where they were explains them, and `MOST` in any case.
    """
    if limit is not None:
        return n >= limit
    if n < USUAL or n >= MOST or all(map(is_failure, rows[: len(rows) - n])):
        return n >= USUAL
    return chance_by_parameters(rows, n, space) < CHANCE


def chance_by_parameters(rows: Sequence[Evaluation], n: int, space: SearchSpace) -> float:
    """Return the probability that the last n rows all fail, each foretold by where those before it failed."""
    X = space.encode([row.configuration for row in rows])
    is_usable = ~np.array([is_failure(row) for row in rows])
    chance = 1.0
    for i in range(len(rows) - n, len(rows)):
        posterior = ProbitProcess().fit(
            X[:i], is_usable[:i], is_ordered=space.is_ordered, permutations=space.permutations
        )
        chance *= -float(np.expm1(posterior.log_probability(X[[i]])[0]))
    return chance


def failures_at_end(rows: Sequence[Evaluation], space: SearchSpace, limit: int | None = None) -> int:
    """Return how many of the last rows are failures in a row, since the run was last stopped for them."""
    n = 0
    for i, row in enumerate(rows):
        n = n + 1 if is_failure(row) else 0
        if n and is_too_long(rows[: i + 1], n, space, limit):
            n = 0
    return n
