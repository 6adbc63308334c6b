"""How much of what the model promises on the bounds of the space the evaluations have shown to be true.

The variance of a stationary process grows towards the bounds of the space, the more so the more dimensions there are,
because observations lie on one side only [1]_ [2]_. With a few dozen evaluations of a rough function the acquisition
is largest there for that reason alone: three in four of the suggestions on emulated peg insertion and on a plateau
problem were on bounds, and gave a sixth of what those inside gave. Where the front is on bounds, suggestions there give
what they promise. So it is for the evaluations to say.

References
----------
.. [1] Siivola et al. Correcting Boundary Over-Exploration Deficiencies in Bayesian Optimization with Virtual Derivative
   Sign Observations. MLSP 2018.
.. [2] Bånkestad, Jarl, Sjölund. Boundary Variance Inflation Causes Acquisition Bias in Gaussian Processes.
   arXiv 2606.07561, 2026.
"""

from __future__ import annotations

from typing import Final

from hypermap_lite.acquisition.boundary_weighted import nearness
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.models import MIN_COMPLETED
from hypermap_lite.optimizers.promises import are_kept, promises_of
from hypermap_lite.typing import FloatArray

NEAR: Final = 0.5
"""Nearness to a bound from which on a point counts as being on it: within 0.06 of it. In three dimensions that is the
case for 31 % of all points, in six for 53 %, in ten for 71 %."""

FEW: Final = 1 / 3
"""Where a smaller share of the promises is kept, the factor is the least one."""

ENOUGH: Final = 1 / 2
"""Where a larger share is kept, it is one. So it is before the first promise, and no longer after one broken."""


def boundary_factor(history: History, observed: FloatArray, mean: FloatArray, least: float, n_before: int = 0) -> float:
    """Return the factor of what a point on a bound promises, between `least` and one.

    Parameters
    ----------
    history
        The evaluations.
    observed, mean
        The objectives of those that completed, as the model of now is told them and by that model, shape (n, m).
    least
        Factor where next to no promise is kept, in (0, 1].
    n_before
        Evaluations that completed before the promises that count: earlier ones are of models of another kind.
    """
    if least >= 1 or len(mean) < MIN_COMPLETED:
        return 1.0
    is_near = nearness(history.X_all(), history.space.is_continuous).max(axis=1) >= NEAR
    made = [promise for promise in promises_of(history) if is_near[promise.row] and promise.n_before >= n_before]
    kept = are_kept(made, history.objectives, observed, mean)
    share = (sum(kept) + 0.5) / (len(kept) + 1)
    doubt = min(max((ENOUGH - share) / (ENOUGH - FEW), 0.0), 1.0)
    return float(least**doubt)
