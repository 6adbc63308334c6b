"""Any acquisition function, weighted by how likely a point is feasible."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from hypermap_lite.acquisition.base import Acquisition, AcquisitionContext, Rough, Scorer, rough_of
from hypermap_lite.acquisition.improvement import SMOOTHING, log_softplus
from hypermap_lite.errors import ScenarioError
from hypermap_lite.surrogates.base import Permutations, Predictor
from hypermap_lite.surrogates.feasibility import (
    Approximation,
    FeasibilityModel,
    FeasibilityPosterior,
    ProbitProcess,
)
from hypermap_lite.typing import BoolArray, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibilityWeighting:
    """The utility of a point counts with the probability that the point is feasible [1]_, to a power.

    It says nothing as long as all evaluations have been feasible. The power 1 is the expected utility. It is too bold
    where much is to be gained beyond the boundary, for of all points those are chosen whose probability is
    overestimated most: on Chankong and Haimes' problem an eighth of what expected hypervolume improvement chose was
    feasible. A larger power trusts less: 3 is for several objectives, one asks for more, see `scenario.defaults`.

    References
    ----------
    .. [1] Gardner et al. Bayesian Optimization with Inequality Constraints. ICML 2014, eq. 5.
    """

    exponent: float = 3.0
    """Power of the probability, > 0."""

    approximation: Approximation = "both"
    """Of the classifier: the more cautious of two, or ``laplace`` alone; see `ProbitProcess.approximation`."""

    learn_failed: bool = True
    """Whether evaluations that failed or ran out of time tell of the feasibility what infeasible ones do."""

    first_feasible: Literal["sobol", "classifier"] = "sobol"
    """Among what points the first feasible one is looked for: those of a Sobol sequence, each of which has its turn, or
    all, where the classifier leads; see `optimizers.first_feasible`."""

    next_feasible: Literal["near", "classifier"] = "near"
    """Where the next ones are looked for while there are one or two: next to them, or where the classifier leads; see
    `optimizers.next_feasible`."""

    def __post_init__(self) -> None:
        if not self.exponent > 0:
            raise ScenarioError("$.exponent", f"the power is {self.exponent}", allowed="a number > 0")

    def weigh(self, inner: Scorer, feasibility: FeasibilityPosterior) -> FeasibilityWeighted:
        """Return a scorer in log form with the probability in it."""
        return FeasibilityWeighted(inner=inner, feasibility=feasibility, exponent=self.exponent)

    def fit(
        self, X: FloatArray, is_feasible: BoolArray, is_ordered: BoolArray, permutations: Permutations
    ) -> FeasibilityPosterior:
        """Learn from n evaluations, shapes (n, d) and (n,), where points are feasible."""
        model: FeasibilityModel = ProbitProcess(approximation=self.approximation)
        return model.fit(X, is_feasible, is_ordered=is_ordered, permutations=permutations)


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibilityWeighted:
    """A scorer in log form plus a multiple of the log probability that a point is feasible."""

    inner: Scorer
    feasibility: FeasibilityPosterior
    exponent: float = 1.0

    @property
    def is_differentiable(self) -> bool:
        """Whether both parts are."""
        return self.inner.is_differentiable and self.feasibility.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return self.inner(X) + self.exponent * self.feasibility.log_probability(X)

    @property
    def rough(self) -> Rough | None:
        """The cheaper approximation, if the inner scorer has one."""
        inner = rough_of(self.inner)
        return None if inner is None else lambda X: inner(X) + self.exponent * self.feasibility.log_probability(X)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        score, gradient = self.inner.with_gradient(X)
        log_probability, slope = self.feasibility.log_probability_with_gradient(X)
        return score + self.exponent * log_probability, gradient + self.exponent * slope


@dataclass(frozen=True, slots=True, kw_only=True)
class LogImprovement:
    """Log of how far a score exceeds that of the best known point, smoothed to stay positive below.

    A product with a probability makes sense for a positive utility only: times P, the negative score of a bound that
    is worse than the incumbent would grow with the risk of being infeasible. So the bound, or the drawn function,
    counts by its improvement over its own value at the best feasible point, softplus(t) instead of max(0, t).
    """

    inner: Scorer
    incumbent: float
    """The inner score to exceed, in normalized objectives."""

    @classmethod
    def over(cls, inner: Scorer, X: FloatArray) -> LogImprovement:
        """Make it for a scorer and the points known to be feasible, shape (n, d)."""
        return cls(inner=inner, incumbent=float(inner(X).max()))

    @property
    def is_differentiable(self) -> bool:
        """Whether the inner scorer is."""
        return self.inner.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return log_softplus((self.inner(X) - self.incumbent) / SMOOTHING) + math.log(SMOOTHING)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        score, gradient = self.inner.with_gradient(X)
        t = (score - self.incumbent) / SMOOTHING
        log_value = log_softplus(t)
        slope = np.exp(-np.logaddexp(0.0, -t) - log_value) / SMOOTHING  # sigmoid / softplus
        return log_value + math.log(SMOOTHING), slope[:, None] * gradient


@dataclass(frozen=True, slots=True)
class Improving:
    """An acquisition function that counts by its `LogImprovement` over the best point known to be feasible."""

    inner: Acquisition
    is_logarithmic: ClassVar[bool] = True
    is_scalarizing: ClassVar[bool] = True

    def scorer(self, context: AcquisitionContext) -> LogImprovement:
        """Become the scorer of one suggestion."""
        return LogImprovement.over(self.inner.scorer(context), context.X)


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibilitySearch:
    """Where to look for the first feasible points: probably feasible, and telling.

    The log of the probability times the novelty. While every point so far is infeasible, both lead away from all of
    them, into the middle of the largest unknown regions; a single feasible one draws the search to its surroundings,
    not onto itself. On Chankong and Haimes' problem (a sixth is feasible), after a design without a feasible
    point, its maximum takes 2.0 evaluations to the first one, and Sobol points 5.0. The probability or the uncertainty
    alone prefer corners; together they leave out what is close to a bound, so `optimizers.first_feasible` has them
    choose among the points of a sequence.
    """

    feasibility: FeasibilityPosterior

    @property
    def is_differentiable(self) -> bool:
        """Whether the model is."""
        return self.feasibility.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return self.feasibility.log_probability(X) + self.feasibility.log_novelty(X)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        log_probability, slope = self.feasibility.log_probability_with_gradient(X)
        log_novelty, novelty_slope = self.feasibility.log_novelty_with_gradient(X)
        return log_probability + log_novelty, slope + novelty_slope


def optimistic_ideal(posterior: Predictor, feasibility: FeasibilityPosterior, X: FloatArray) -> FloatArray:
    """Return the least mean minus std of each objective among the points that are probably feasible, shape (m,).

    Infinite if none of the n points, shape (n, d), is.
    """
    probable = X[feasibility.log_probability(X) > math.log(0.5)]
    if not len(probable):
        return np.array(np.inf)
    prediction = posterior.predict(probable)
    return np.asarray((prediction.mean - prediction.std).min(axis=0))
