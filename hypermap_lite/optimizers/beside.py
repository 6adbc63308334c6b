"""What infeasible evaluations tell about the objectives.

An objective is often known where a constraint is violated, and what it is like there tells what to expect beyond the
next feasible point. Without it the model extrapolates from the feasible ones alone and promises most where it may not
go. But a black box may also answer with a placeholder, -1 or 1e9; such values would ruin the model of the rest.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Sequence
from typing import Final

import numpy as np

from hypermap_lite.evaluation.outcome import Evaluation, State
from hypermap_lite.history.history import objectives_of
from hypermap_lite.history.pooling import key_of
from hypermap_lite.objectives import Objective
from hypermap_lite.surrogates.tails import Tails, compress
from hypermap_lite.typing import BoolArray, FloatArray

FAR: Final = 3.0
"""Values farther beyond the feasible ones than so many of their ranges are taken for placeholders."""

MOST: Final = 100
"""The last so many are learned from; each more makes a process slower, and late ones are where the search is."""


def telling(evaluations: Sequence[Evaluation], objectives: Sequence[Objective], tails: Tails = ()) -> list[Evaluation]:
    """Return the infeasible evaluations whose objective values are likely to mean something.

    Those with a value of every objective, none of which is farther from the feasible ones than `FAR` of their ranges,
    with their tails compressed, or is, to the last digit, that of another infeasible configuration; of these the last
    `MOST`.
    """
    completed = [e for e in evaluations if e.is_completed]
    infeasible = [e for e in evaluations if e.state is State.INFEASIBLE and all(o.name in e.values for o in objectives)]
    if not completed or not infeasible:
        return []
    tells = _tells(infeasible, completed, objectives, tails).all(axis=1)
    return [infeasible[i] for i in np.flatnonzero(tells)[-MOST:]]


def values_of_failures(
    failed: Sequence[Evaluation],
    completed: Sequence[Evaluation],
    objectives: Sequence[Objective],
    failing: int,
    tails: Tails = (),
) -> FloatArray:
    """Return what k failures report beside n successes, shape (k, m), NaN where it means nothing.

    That is so of the objective, number `failing`, by which they are failures, and of values that would not be believed
    of an infeasible evaluation; see `telling`. Tails are not compressed.
    """
    tells = _tells(failed, completed, objectives, tails)
    tells[:, failing] = False
    return np.where(tells, objectives_of(failed, objectives), np.nan)


def _tells(
    beside: Sequence[Evaluation], completed: Sequence[Evaluation], objectives: Sequence[Objective], tails: Tails
) -> BoolArray:
    """Tell which objectives of k evaluations beside completed ones are likely to mean something, shape (k, m)."""
    Y = objectives_of(beside, objectives)
    feasible, known = compress(objectives_of(completed, objectives), tails), compress(Y, tails)
    low, high = feasible.min(axis=0), feasible.max(axis=0)
    reach = FAR * (high - low)
    is_near = (low - reach <= known) & (high + reach >= known)
    seen: dict[tuple[int, float], set[Hashable]] = defaultdict(set)
    for evaluation, row in zip(beside, Y.tolist(), strict=True):
        for k, value in enumerate(row):
            seen[k, value].add(key_of(evaluation.configuration))
    is_own = [[len(seen[k, value]) == 1 for k, value in enumerate(row)] for row in Y.tolist()]
    return is_near & np.array(is_own, dtype=bool).reshape(is_near.shape)
