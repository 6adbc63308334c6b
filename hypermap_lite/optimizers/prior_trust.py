"""The safeguard against misleading priors: whether a prior's region can still improve on what is known.

At checks, which come after the design and then at growing intervals, two questions are asked of a prior. What has its
region given per evaluation, compared with the rest of the space? And what does it promise by the model, compared with
the whole space? A prior that fails both loses half of its weight; one that has failed three times is dropped. A check
is a function of the evaluations before it, so a resumed run comes to the same decisions.

DynaBO [1]_ compares optimistic predictions in the prior's region with those around the incumbent. Here a region that
holds a fair share of what has been found is never blamed for being well explored, which is where a good prior ends up.

References
----------
.. [1] Dynamic Priors in Bayesian Optimization for Hyperparameter Optimization. arXiv 2511.02570, 2025.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.priors.beliefs import Belief
from hypermap_lite.quasi_random import sobol_points
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.surrogates.base import Prediction, Predictor
from hypermap_lite.typing import FloatArray, Rng

LEVELS: Final = (1.0, 0.5, 0.25, 0.0)
"""Trust after 0, 1, 2 and 3 failed checks."""

MIN_INTERVAL: Final = 2
INTERVAL_GROWTH: Final = 1.25
"""Checks come 0, 2, 4, 6, 8, 10, 13, 17, 22, 28, ... evaluations after the design: the prior fades, and so do they."""

POINTS: Final = 256
"""Points that stand for the prior's region, and as many for the whole space."""

MASS: Final = 0.95
"""Share of the prior's mass in its region, which is where its density is highest."""

OPTIMISM: Final = 2.0
"""Standard deviations better than its mean that a point may turn out."""

LESS: Final = 0.5
"""A smaller share than this of what the rest gives or promises is less."""

NOTHING: Final = 0.01
"""A smaller share is nothing."""

DIRECTIONS: Final = 64
"""Trade-offs over which gains are averaged."""

SMALLEST_DIRECTION: Final = 1e-3
"""Least component of a direction: none looks at one objective alone."""

MARGIN: Final = 0.1
"""How far beyond the front an inferred reference point lies, as a share of the front's range."""


@dataclass(frozen=True, slots=True)
class OneObjective:
    """One of the objectives that a posterior predicts."""

    posterior: Predictor
    objective: int

    def predict(self, X: FloatArray) -> Prediction:
        """Predict it at n points, as the only one."""
        both = self.posterior.predict(X)
        column = slice(self.objective, self.objective + 1)
        return Prediction(mean=both.mean[:, column], std=both.std[:, column])


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """What is known at a check."""

    posterior: Predictor
    X: FloatArray
    """Completed evaluations, shape (n, d)."""

    X_all: FloatArray
    """All evaluations, infeasible and failed ones too, shape (>= n, d)."""

    reference_point: FloatArray | None = None
    """Worst objectives of interest, to be minimized, shape (m,); None to infer them from the results."""

    log_probability: Callable[[FloatArray], FloatArray] | None = None
    """Log of the probability of being feasible at n points, shape (n,); None where all are."""

    def on(self, objective: int) -> Evidence:
        """Return what is known of one objective alone."""
        return replace(self, posterior=OneObjective(self.posterior, objective), reference_point=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """The prior's region and the rest of the space. Gains are in an arbitrary unit, the same for all."""

    n_inside: int
    """Evaluations in the region."""

    n_outside: int
    given_inside: float
    """What would be lost of the front without the evaluations in the region, >= 0."""

    given_outside: float
    """What would be lost without the others."""

    promised_inside: float
    """Largest gain, if it turns out well, at points drawn from the prior."""

    promised_anywhere: float
    """The same at points of the whole space."""

    @property
    def has_failed(self) -> bool:
        """Whether the region has given less than the rest and promises less; False without evidence on both.

        Where nothing has been found anywhere, as on a plateau of failures, it fails only if it promises nothing.
        """
        if not self.n_inside or not self.n_outside:
            return False
        gives_less = self.given_inside / self.n_inside < LESS * self.given_outside / self.n_outside
        gives_nothing = self.given_inside == self.given_outside == 0
        share = LESS if gives_less else NOTHING if gives_nothing else 0.0
        return self.promised_inside < share * self.promised_anywhere


def checkpoints(first: int, n: int) -> Iterator[int]:
    """Yield the numbers of evaluations, from `first` to n, after which priors are checked."""
    k = 0
    while first + k <= n:
        yield first + k
        k = max(k + MIN_INTERVAL, math.ceil(k * INTERVAL_GROWTH))


def compare(evidence: Evidence, belief: Belief, space: SearchSpace, rng: Rng) -> Comparison:
    """Compare a prior's region with the rest of the space, by the objective it is about, or by all of them.

    What is given is measured by the posterior means of the evaluations, so that luck is not; what is promised, by
    means less `OPTIMISM` standard deviations, times the probability of being feasible.
    """
    prior = belief.prior
    evidence = evidence if belief.objective is None else evidence.on(belief.objective)
    drawn = space.draw(POINTS, lambda k: prior.sample(k, rng))
    anywhere = space.draw(POINTS, lambda k: sobol_points(k, space.dimension, rng))
    edge = np.quantile(prior.log_density(drawn), 1 - MASS) if len(drawn) else math.inf
    is_inside = prior.log_density(evidence.X) >= edge
    n_inside = int((prior.log_density(evidence.X_all) >= edge).sum())
    mean = evidence.posterior.predict(evidence.X).mean
    gauge = Gauge.of(mean, evidence.reference_point, rng)
    found = gauge.reach(mean)
    return Comparison(
        n_inside=n_inside,
        n_outside=len(evidence.X_all) - n_inside,
        given_inside=float((found - gauge.reach(mean[~is_inside])).mean()),
        given_outside=float((found - gauge.reach(mean[is_inside])).mean()),
        promised_inside=_promised(evidence, drawn, gauge, found),
        promised_anywhere=_promised(evidence, anywhere, gauge, found),
    )


def _promised(evidence: Evidence, X: FloatArray, gauge: Gauge, found: FloatArray) -> float:
    """Return the largest gain at n points over what was found, shape (k,), if each turns out well."""
    if not len(X):
        return 0.0
    prediction = evidence.posterior.predict(X)
    gains = np.maximum(gauge(prediction.mean - OPTIMISM * prediction.std) - found, 0.0).mean(axis=1)
    return float((gains if evidence.log_probability is None else gains * np.exp(evidence.log_probability(X))).max())


@dataclass(frozen=True, slots=True, kw_only=True)
class Gauge:
    r"""Measures points by the hypervolume that each adds, as a mean over directions [1]_.

    The hypervolume that points y dominate is, up to a constant, the mean over directions w on the positive unit sphere
    of :math:`\max_y \min_j (r_j - y_j)_+^m / w_j^m`. With one objective it is the distance from the worst value.

    References
    ----------
    .. [1] Zhang, Golovin. Random Hypervolume Scalarizations for Provable Multi-Objective Black Box Optimization.
       ICML 2020.
    """

    corner: FloatArray
    """The reference point r, shape (m,)."""

    scale: FloatArray
    """Unit of each objective, shape (m,)."""

    directions: FloatArray
    """Shape (k, m), positive."""

    @classmethod
    def of(cls, Y: FloatArray, reference_point: FloatArray | None, rng: Rng) -> Gauge:
        """Return the gauge for n points, shape (n, m), that is their front's; see `infer_corner`."""
        corner = infer_corner(Y) if reference_point is None else reference_point
        ideal, extent = Y.min(axis=0), np.ptp(Y, axis=0)
        scale = np.where(corner > ideal, corner - ideal, extent)
        directions = np.abs(rng.standard_normal((DIRECTIONS if Y.shape[1] > 1 else 1, Y.shape[1])))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return cls(
            corner=corner,
            scale=np.where(scale > 0, scale, 1.0),
            directions=np.maximum(directions, SMALLEST_DIRECTION),
        )

    def __call__(self, Y: FloatArray) -> FloatArray:
        """Return the reach of n points along each direction, to the power m, shape (n, k)."""
        depth = np.maximum((self.corner - Y) / self.scale, 0.0)
        along = [column[:, None] / self.directions[:, j] for j, column in enumerate(depth.T)]
        return np.asarray(np.minimum.reduce(along) ** Y.shape[1])

    def reach(self, Y: FloatArray) -> FloatArray:
        """Return the farthest reach of n points along each direction, shape (k,); zero without points."""
        return self(Y).max(axis=0, initial=0.0)


def infer_corner(Y: FloatArray) -> FloatArray:
    """Return a reference point for n points, shape (n, m): a little beyond the front, or the worst of one objective."""
    if Y.shape[1] == 1:
        return Y.max(axis=0)
    front = Y[non_dominated(Y)]
    return front.max(axis=0) + MARGIN * np.ptp(front, axis=0)
