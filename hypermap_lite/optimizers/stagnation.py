"""A search by the model that has come to a standstill."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

import numpy as np

from hypermap_lite.evaluation.outcome import CONFIRM, MODEL, RANDOM, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.promises import are_kept, promises_of
from hypermap_lite.surrogates.base import Knowledge
from hypermap_lite.typing import FloatArray

PATIENCE: Final = 4
"""So many suggestions of the model in a row add nothing to the front where a search stands still."""

PATIENCE_IN_THE_DARK: Final = 6
"""So many promises in a row are broken where a model that knows nothing of an objective leads nowhere."""

PATIENCE_WITH_ONE: Final = 8
"""The same with one objective, for most steps towards a minimum overshoot."""

NOTHING: Final = 1e-6
"""Share of an objective's variance that is as good as none: what rounding leaves of zero."""

NEXT_TO_NOTHING: Final = math.log(1e-4)
"""Log acquisition, in normalized objectives, below which a point promises nothing."""


def stands_still(history: History) -> bool:
    """Tell whether the model's last suggestions have added nothing to the front, `PATIENCE` of them.

    With one objective that says little, for most steps towards a minimum overshoot; then it is so only as long as all
    evaluations have the same value, from which nothing is learnt.
    """
    Y = history.Y()
    if len(history.objectives) == 1:
        return len(Y) > 0 and float(np.ptp(Y)) == 0.0
    chosen: list[tuple[int, bool]] = []
    n = 0
    for evaluation in history:
        if evaluation.suggestion.phase == MODEL:
            chosen.append((n, evaluation.is_completed))
        n += evaluation.is_completed
    added = [is_completed and not (Y[:k] <= Y[k]).all(axis=1).any() for k, is_completed in chosen[-PATIENCE:]]
    return len(added) == PATIENCE and not any(added)


def is_in_the_dark(history: History, observed: FloatArray, posterior: Knowledge) -> bool:
    """Tell whether there is an objective of which the model knows no more than the mean, and its promises are broken.

    So it is on a plateau with noise: what is learnt of it is that the noise is large and that something may be
    anywhere. A model whose last steps gave what they promised is left alone, however little it knows, and so is one
    that knows something of each objective. Steps that a prior guides promise nothing that could be broken, so the rule
    waits until there have been enough without one in a row.

    Parameters
    ----------
    history
        The evaluations.
    observed
        The objectives of those that completed, as the model is told them, shape (n, m).
    posterior
        What it knows.
    """
    patience = PATIENCE_IN_THE_DARK if len(history.objectives) > 1 else PATIENCE_WITH_ONE
    chosen = [row for row, evaluation in enumerate(history) if evaluation.suggestion.phase == MODEL][-patience:]
    promises = promises_of(history)[-patience:]
    if len(promises) < patience or [promise.row for promise in promises] != chosen:
        return False
    explained = posterior.explained()
    if explained is None or (explained > NOTHING).all():
        return False
    return not any(are_kept(promises, history.objectives, observed, posterior.predict(history.X()).mean))


def draws_at_end(suggestions: Iterable[Suggestion]) -> int:
    """Return how many of the suggestions with the last trials were drawn and not from the model."""
    n = 0
    for suggestion in sorted(suggestions, key=lambda s: s.trial):
        if suggestion.phase != CONFIRM:
            n = n + 1 if suggestion.phase == RANDOM else 0
    return n
