"""When failures in a row mean that the evaluator is broken, and when their parameters explain them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from hypermap_lite.evaluation.outcome import Evaluation, State
from hypermap_lite.scenario.model import MOST_FAILURES, USUAL_FAILURES
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.surrogates.feasibility import ProbitProcess

CHANCE: Final = 0.002
"""Of so many failures in a row by their parameters alone, below which the evaluator counts as broken.

Where 40 % of the space fail, in two to four dimensions, the fifth failure in a row had a chance of 0.02 to 0.3; where a
sound evaluator broke after 20 evaluations, of 0.0003 at most.
"""


def is_failure(evaluation: Evaluation) -> bool:
    """Tell whether an evaluation failed or ran out of time: being infeasible is a result."""
    return evaluation.state in (State.FAILED, State.TIMEOUT)


def is_too_long(
    rows: Sequence[Evaluation],
    n: int,
    space: SearchSpace,
    limit: int | None = None,
    known: dict[int, float] | None = None,
) -> bool:
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
        So many are; None: `USUAL_FAILURES`, if it is unlikely that where they were explains them, and
        `MOST_FAILURES` in any case.
    known
        Probabilities of failures by their positions, to which those worked out here are added.
    """
    if limit is not None:
        return n >= limit
    if n < USUAL_FAILURES or n >= MOST_FAILURES or all(map(is_failure, rows[: len(rows) - n])):
        return n >= USUAL_FAILURES
    return chance_by_parameters(rows, n, space, known) < CHANCE


def chance_by_parameters(
    rows: Sequence[Evaluation], n: int, space: SearchSpace, known: dict[int, float] | None = None
) -> float:
    """Return the probability that the last n rows all fail, each foretold by where those before it failed.

    But not by those failures in a row just before them that were too many already: what broke an evaluator says nothing
    of the parameters, and is no excuse when the run is called again without a mend.
    """
    known = {} if known is None else known
    X = space.encode([row.configuration for row in rows])
    is_usable = ~np.array([is_failure(row) for row in rows])
    start = len(rows) - n
    first = int(np.flatnonzero(is_usable[:start]).max(initial=-1)) + 1
    for i in range(start, len(rows)):
        if i not in known:
            told = np.r_[:first, start:i]
            posterior = ProbitProcess().fit(
                X[told], is_usable[told], is_ordered=space.is_ordered, permutations=space.permutations
            )
            known[i] = -float(np.expm1(posterior.log_probability(X[[i]])[0]))
    return math.prod(known[i] for i in range(start, len(rows)))


def failures_at_end(rows: Sequence[Evaluation], space: SearchSpace, limit: int | None = None) -> int:
    """Return how many of the last rows are failures in a row, since the run was last stopped for them."""
    n, known = 0, dict[int, float]()
    first = max((i + 1 for i, row in enumerate(rows) if not is_failure(row)), default=0)
    for end in range(first + 1, len(rows) + 1):
        n += 1
        if is_too_long(rows[:end], n, space, limit, known):
            n = 0
    return n
