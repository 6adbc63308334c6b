"""BOPrO: the prior and the model as two opinions on whether a point is good."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.special import erfcx, log_expit, log_ndtr

from hypermap_lite.acquisition.base import Acquisition, AcquisitionContext, Scorer
from hypermap_lite.acquisition.improvement import SMOOTHING, log_sum_exp
from hypermap_lite.acquisition.prior_weighted import PriorWeighted, check_prior_free
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.quasi_random import quasi_normal
from hypermap_lite.scalarization.base import Normalization, Scalarization
from hypermap_lite.surrogates.base import Conditional, Field
from hypermap_lite.typing import FloatArray

SAMPLES = 64
"""Joint samples of several objectives."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Bopro:
    r"""Bayesian optimization with a prior for the optimum [1]_; takes the place of the acquisition function.

    At the t-th model-based suggestion the score is

    .. math:: \ln P_g(x) - \ln P_b(x) + \frac{t}{B} (\ln M_g(x) - \ln M_b(x)).

    The prior's opinion that x is good is its density relative to the peak, d(x) in [0, 1], with a floor f:
    P_g = f + (1 - f) d and P_b = f + (1 - f) (1 - d). Both are free of units, and exact where HyperMapper estimates
    the range of the density from draws. The model's opinion M_g is the posterior probability that the (scalarized)
    objective lies below the q-quantile of those observed, at a resolution of a hundredth of their range: without it,
    what is next to the best, and so known to be good, would be better than all else. M_b = 1 - M_g.

    References
    ----------
    .. [1] Souza, Nardi, Oliveira, Olukotun, Lindauer, Hutter. Bayesian Optimization with a Prior for the Optimum,
       sec. 3. ECML-PKDD 2021.
    """

    model_weight: float = 10.0
    """B, in suggestions: when the model's opinion counts as much as the prior's."""

    good_quantile: float = 0.05
    """q: the share of the observed values that is good, in (0, 1)."""

    floor: float = 0.01
    """f: least probability in the prior's opinion, in (0, 1/2)."""

    prior_free: float = 0.25
    """Share of the suggestions that leave the prior out, in [0, 1]."""

    safeguard: bool = True
    """Whether the prior is checked against the evaluations, and loses its weight where it misleads."""

    make_up: bool = True
    """Whether uniform draws make up for those that the design took from a prior that is dropped."""

    @property
    def is_factor(self) -> bool:
        """False."""
        return False

    def __post_init__(self) -> None:
        check_prior_free(self.prior_free)
        if not self.model_weight > 0:
            raise ScenarioError("$.model_weight", f"the weight is {self.model_weight}", allowed="a number > 0")
        if not 0 < self.good_quantile < 1:
            problem = f"the quantile is {self.good_quantile}"
            raise ScenarioError("$.good_quantile", problem, allowed="a number > 0 and < 1")
        if not 0 < self.floor < 0.5:
            raise ScenarioError("$.floor", f"the floor is {self.floor}", allowed="a number > 0 and < 0.5")

    def weight(self, n: int, model_budget: int) -> float:
        """Return the prior's exponent relative to the model's, B / t, at the n-th model-based suggestion."""
        return self.model_weight / n

    def scorer(
        self, acquisition: Acquisition, context: AcquisitionContext, prior: ProductPrior, weight: float
    ) -> BoproScorer:
        """Become the scorer of one suggestion; pending points count as evaluated at their predicted means."""
        posterior = context.posterior.believe(context.X_pending)
        known = context.Y
        if len(context.X_pending):
            known = np.vstack([known, context.posterior.predict(context.X_pending).mean])
        good: Scorer
        if known.shape[1] == 1:
            good = LogOddsBelow(
                field=posterior.field,
                threshold=self._threshold(known[:, 0]),
                resolution=SMOOTHING * float(context.normalization.scale[0]),
                is_differentiable=posterior.is_differentiable,
            )
        else:
            good = SampledLogOddsBelow(
                field=posterior.field,
                threshold=self._threshold(context.scalarization(context.normalization(known), context.weights)),
                normal=quasi_normal(SAMPLES, known.shape[1], context.rng),
                scalarization=context.scalarization,
                weights=context.weights,
                normalization=context.normalization,
                is_differentiable=posterior.is_differentiable,
            )
        return BoproScorer(good=good, prior=prior, model_share=1.0 / weight, floor=self.floor)

    def weigh(self, scorer: Scorer, prior: ProductPrior, weight: float) -> PriorWeighted:
        """Return a scorer in log form times the prior's density: without a model the prior decides alone."""
        return PriorWeighted(inner=scorer, prior=prior, weight=1.0, floor=self.floor)

    def _threshold(self, values: FloatArray) -> float:
        """Return below what an objective is good: an observed value, so that no known place is far below it."""
        return float(np.quantile(values, self.good_quantile, method="inverted_cdf"))


@dataclass(frozen=True, slots=True, kw_only=True)
class BoproScorer:
    """The prior's log odds that a point is good, plus `model_share` times the model's."""

    good: Scorer
    prior: ProductPrior
    model_share: float
    floor: float
    _log_peak: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_log_peak", self.prior.log_peak())

    @property
    def is_differentiable(self) -> bool:
        """Whether the model is: densities always are."""
        return self.good.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return self.log_odds_of_prior(X) + self.model_share * self.good(X)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        score, gradient = self.good.with_gradient(X)
        d = self._relative_density(X)
        keep = 1.0 - self.floor
        slope = (d < 1.0) * keep * d * (1.0 / (self.floor + keep * d) + 1.0 / (1.0 - keep * d))
        by_prior = slope[:, None] * self.prior.log_gradient(X)
        return self.log_odds_of_prior(X) + self.model_share * score, by_prior + self.model_share * gradient

    def log_odds_of_prior(self, X: FloatArray) -> FloatArray:
        """Return ln P_g - ln P_b at n points, shape (n,)."""
        share = (1.0 - self.floor) * self._relative_density(X)
        return np.log(self.floor + share) - np.log1p(-share)

    def _relative_density(self, X: FloatArray) -> FloatArray:
        """Return the density in units of the peak, shape (n,), in [0, 1], unbounded densities included."""
        return np.exp(np.minimum(self.prior.log_density(X) - self._log_peak, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class LogOddsBelow:
    """ln M_g - ln M_b of one objective, M_g = Phi((threshold - mean) / sqrt(std^2 + resolution^2))."""

    field: Field
    """With a single scenario."""

    threshold: float
    resolution: float
    """Differences far below this are none, in the unit of the objective."""

    is_differentiable: bool

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the log odds at n points, shape (n,)."""
        return self._score(self.field(X))[0]

    def _score(self, c: Conditional) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the log odds, z and the standard deviation z is measured in, all shape (n,)."""
        std = np.hypot(c.std[0, :, 0], self.resolution)
        z = (self.threshold - c.mean[0, :, 0]) / std
        return log_ndtr(z) - log_ndtr(-z), z, std

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log odds, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        score, z, std = self._score(c)
        by_z = hazard(z) + hazard(-z)
        by_mean = -by_z / std
        by_std = by_mean * z * c.std[0, :, 0] / std
        assert c.pullback is not None
        return score, c.pullback(by_mean[None, :, None], by_std[None, :, None])


@dataclass(frozen=True, slots=True, kw_only=True)
class SampledLogOddsBelow:
    """ln M_g - ln M_b of a scalarization, M_g the share of joint samples below the threshold, smoothed.

    A sample at t widths below the threshold counts as 1 / (1 + exp(-t)), so that M_g has a slope everywhere.
    """

    field: Field
    """With a single scenario."""

    threshold: float
    normal: FloatArray
    """One standard normal draw per sample and objective, shape (E, m)."""

    scalarization: Scalarization
    weights: FloatArray
    normalization: Normalization
    is_differentiable: bool

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the log odds at n points, shape (n,)."""
        return self._score(self.field(X))[0]

    def _score(self, c: Conditional) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the log odds (n,), the normalized samples (E, n, m), and t (E, n)."""
        samples = self.normalization(c.mean + c.std * self.normal[:, None, :])
        t = (self.threshold - self.scalarization(samples, self.weights)) / SMOOTHING
        return log_mean(log_expit(t)) - log_mean(log_expit(-t)), samples, t

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log odds, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        score, samples, t = self._score(c)
        log_slope = log_expit(t) + log_expit(-t) - math.log(len(t) * SMOOTHING)  # of the mean of expit(t)
        by_scalar = -np.exp(log_slope - log_mean(log_expit(t))) - np.exp(log_slope - log_mean(log_expit(-t)))
        slope = self.scalarization.gradient(samples, self.weights) / self.normalization.scale
        by_sample = by_scalar[..., None] * slope
        by_mean = by_sample.sum(axis=0, keepdims=True)
        assert c.pullback is not None
        return score, c.pullback(by_mean, (by_sample * self.normal[:, None, :]).sum(axis=0, keepdims=True))


def hazard(z: FloatArray) -> FloatArray:
    """Return phi(z) / Phi(z), the slope of the log of Phi, exact in both tails."""
    return math.sqrt(2 / math.pi) / erfcx(-z / math.sqrt(2))


def log_mean(logs: FloatArray) -> FloatArray:
    """Return the log of the mean of exp(logs) over the first axis, shape (E, n) to (n,)."""
    return log_sum_exp(logs) - math.log(len(logs))
