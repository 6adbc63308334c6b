"""Which promises of the model the evaluations have shown to be true.

An acquisition value that expects an improvement, of an objective or of the hypervolume, is a promise. A promise is an
expectation, and few bold steps give theirs; they count as broken, on purpose.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from hypermap_lite.evaluation.outcome import MODEL
from hypermap_lite.history.history import History
from hypermap_lite.objectives import Objective, reference_point_of, stated_or
from hypermap_lite.optimizers.models import MIN_COMPLETED
from hypermap_lite.pareto.hypervolume import hypervolume, infer_reference_point
from hypermap_lite.scalarization.base import Normalization
from hypermap_lite.typing import FloatArray

KEPT: Final = 0.3
"""A promise of which less than this share comes true is broken."""


class Promise(NamedTuple):
    """What a suggestion of the model promised."""

    row: int
    """Of the history."""

    n_before: int
    """Evaluations that completed before it in the history; some of them may have been under way when it was made."""

    is_completed: bool
    value: float
    """Its log, in normalized objectives."""


def promises_of(history: History) -> list[Promise]:
    """Return the promises so far, in the order of the evaluations.

    Those of suggestions that a prior had a part in are not known, and those before there was a model of the objectives
    promised feasibility.
    """
    found, n = [], 0
    for row, evaluation in enumerate(history):
        k, n = n, n + evaluation.is_completed
        suggestion = evaluation.suggestion
        value = suggestion.acquisition_value
        if suggestion.phase == MODEL and not suggestion.prior_weight and value is not None and k >= MIN_COMPLETED:
            found.append(Promise(row, k, evaluation.is_completed, value))
    return found


def are_kept(
    promises: Iterable[Promise], objectives: Sequence[Objective], observed: FloatArray, mean: FloatArray
) -> list[bool]:
    """Tell of each promise whether it came true; of an evaluation that did not complete nothing did.

    Parameters
    ----------
    promises
        Some of the `promises_of` the history.
    objectives
        What they are, m of them.
    observed
        Their values at the evaluations that completed, as the model of now is told them, shape (n, m).
    mean
        The same by that model, so that luck is not taken for a kept promise, shape (n, m).
    """
    stated = reference_point_of(objectives)
    reference_point = stated_or(objectives, infer_reference_point(mean)) if mean.shape[1] > 1 else None

    def is_kept(promise: Promise) -> bool:
        k = promise.n_before
        if not promise.is_completed or (mean[:k] <= mean[k]).all(axis=1).any():
            return False
        scale = Normalization.of_front(observed[:k], stated).scale
        corner = None if reference_point is None else reference_point / scale
        return _growth(mean[:k] / scale, mean[k] / scale, corner) > KEPT * math.exp(promise.value)

    return [is_kept(promise) for promise in promises]


def _growth(before: FloatArray, y: FloatArray, reference_point: FloatArray | None) -> float:
    """Return the hypervolume, or with one objective the improvement, that y, shape (m,), adds to n points."""
    if reference_point is None:
        return float(before[:, 0].min() - y[0])
    return hypervolume(np.vstack([before, y]), reference_point) - hypervolume(before, reference_point)
