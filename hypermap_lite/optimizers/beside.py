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
    Y = objectives_of(infeasible, objectives)
    feasible, known = compress(objectives_of(completed, objectives), tails), compress(Y, tails)
    low, high = feasible.min(axis=0), feasible.max(axis=0)
    reach = FAR * (high - low)
    is_near = ((low - reach <= known) & (high + reach >= known)).all(axis=1)
    seen: dict[tuple[int, float], set[Hashable]] = defaultdict(set)
    for evaluation, row in zip(infeasible, Y, strict=True):
        for k, value in enumerate(row.tolist()):
            seen[k, value].add(key_of(evaluation.configuration))
    is_own = np.array([all(len(seen[k, value]) == 1 for k, value in enumerate(row)) for row in Y.tolist()])
    return [infeasible[i] for i in np.flatnonzero(is_near & is_own)[-MOST:]]
