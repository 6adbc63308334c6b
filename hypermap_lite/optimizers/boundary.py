"""How much of what the model promises on the bounds of the space the evaluations have shown to be true.

The variance of a stationary process grows towards the bounds of the space, the more so the more dimensions there are,
because observations lie on one side only [1]_ [2]_. With a few dozen evaluations of a rough function the acquisition
is largest there for that reason alone: three in four of the suggestions on emulated peg insertion and on a plateau
problem were on bounds, and gave a sixth of what those inside gave. Where the front is on bounds, suggestions there give
what they promise. So it is for the evaluations to say.

A promise is an expectation, and few bold steps give theirs; they count as broken, on purpose.

References
----------
.. [1] Siivola et al. Correcting Boundary Over-Exploration Deficiencies in Bayesian Optimization with Virtual Derivative
   Sign Observations. MLSP 2018.
.. [2] Bånkestad, Jarl, Sjölund. Boundary Variance Inflation Causes Acquisition Bias in Gaussian Processes.
   arXiv 2606.07561, 2026.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from hypermap_lite.acquisition.boundary_weighted import nearness
from hypermap_lite.evaluation.outcome import MODEL
from hypermap_lite.history.history import History
from hypermap_lite.objectives import reference_point_of, stated_or
from hypermap_lite.optimizers.models import MIN_COMPLETED
from hypermap_lite.pareto.hypervolume import hypervolume, infer_reference_point
from hypermap_lite.scalarization.base import Normalization
from hypermap_lite.typing import FloatArray

NEAR: Final = 0.5
"""Nearness to a bound from which on a point counts as being on it: within 0.06 of it. In three dimensions that is the
case for 31 % of all points, in six for 53 %, in ten for 71 %."""

KEPT: Final = 0.3
"""A promise of which less than this share comes true is broken."""

FEW: Final = 1 / 3
"""Where a smaller share of the promises is kept, the factor is the least one."""

ENOUGH: Final = 1 / 2
"""Where a larger share is kept, it is one. So it is before the first promise, and no longer after one broken."""


def boundary_factor(history: History, mean: FloatArray, least: float) -> float:
    """Return the factor of what a point on a bound promises, between `least` and one.

    Parameters
    ----------
    history
        The evaluations. Suggestions that a prior had a part in are no evidence, for their promise is not known, and
        neither are those before there was a model of the objectives, which promised feasibility.
    mean
        The objectives of those that completed, by the model of now, so that luck is not taken for a kept promise, shape
        (n, m).
    least
        Factor where next to no promise is kept, in (0, 1].
    """
    if least >= 1 or len(mean) < MIN_COMPLETED:
        return 1.0
    kept = list(_kept(history, mean))
    share = (sum(kept) + 0.5) / (len(kept) + 1)
    doubt = min(max((ENOUGH - share) / (ENOUGH - FEW), 0.0), 1.0)
    return float(least**doubt)


def _kept(history: History, mean: FloatArray) -> Iterator[bool]:
    """Yield whether each suggestion on a bound kept its promise; one that did not complete gave nothing."""
    space, observed = history.space, history.Y()
    stated = reference_point_of(history.objectives)
    reference_point = stated_or(history.objectives, infer_reference_point(mean)) if mean.shape[1] > 1 else None
    is_near = nearness(history.X_all(), space.is_continuous).max(axis=1) >= NEAR
    n = 0
    for evaluation, near in zip(history, is_near, strict=True):
        k, n = n, n + evaluation.is_completed
        suggestion = evaluation.suggestion
        value = suggestion.acquisition_value
        if not near or suggestion.phase != MODEL or suggestion.prior_weight or value is None or k < MIN_COMPLETED:
            continue
        if not evaluation.is_completed or (mean[:k] <= mean[k]).all(axis=1).any():
            yield False
            continue
        scale = Normalization.of_front(observed[:k], stated).scale
        corner = None if reference_point is None else reference_point / scale
        yield _growth(mean[:k] / scale, mean[k] / scale, corner) > KEPT * math.exp(value)


def _growth(before: FloatArray, y: FloatArray, reference_point: FloatArray | None) -> float:
    """Return the hypervolume, or with one objective the improvement, that y, shape (m,), adds to n points."""
    if reference_point is None:
        return float(before[:, 0].min() - y[0])
    return hypervolume(np.vstack([before, y]), reference_point) - hypervolume(before, reference_point)
