"""piBO: any acquisition function, weighted by what the user believes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from hypermap_lite.acquisition.base import Acquisition, AcquisitionContext, Rough, Scorer, rough_of
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Pibo:
    """How strongly, and for how long, the prior counts [1]_.

    The acquisition value is multiplied by the prior density to the power beta / n at the n-th model-based
    suggestion.

    References
    ----------
    .. [1] Hvarfner et al. piBO: Augmenting Acquisition Functions with User Beliefs for Bayesian Optimization.
       ICLR 2022, eq. 6.
    """

    beta: float | None = None
    """Strength; None for HyperMapper's default, a tenth of the number of model-based evaluations."""

    floor: float = 0.05
    """Share of the highest density that every point keeps, in [0, 1)."""

    unbounded: bool = False
    """Whether a density that is unbounded at a bound counts in full next to it, instead of no more than its peak."""

    prior_free: float = 0.25
    """Share of the suggestions that leave the prior out, in [0, 1]."""

    safeguard: bool = True
    """Whether the prior is checked against the evaluations, and loses its weight where it misleads."""

    make_up: bool = True
    """Whether uniform draws make up for those that the design took from a prior that is dropped."""

    @property
    def is_factor(self) -> bool:
        """True."""
        return True

    def __post_init__(self) -> None:
        check_prior_free(self.prior_free)
        if self.beta is not None and not self.beta >= 0:
            raise ScenarioError("$.beta", f"the strength is {self.beta}", allowed="a number >= 0, or null")
        if not 0 <= self.floor < 1:
            raise ScenarioError("$.floor", f"the floor is {self.floor}", allowed="in [0, 1)")

    def weight(self, n: int, model_budget: int) -> float:
        """Return the exponent at the n-th model-based suggestion, n >= 1, of a budget of so many."""
        beta = 0.1 * model_budget if self.beta is None else self.beta
        return beta / n

    def scorer(
        self, acquisition: Acquisition, context: AcquisitionContext, prior: ProductPrior, weight: float
    ) -> PriorWeighted:
        """Become the scorer of one suggestion."""
        return self.weigh(acquisition.scorer(context), prior, weight)

    def weigh(self, scorer: Scorer, prior: ProductPrior, weight: float) -> PriorWeighted:
        """Return any scorer with the prior in it."""
        return PriorWeighted(inner=scorer, prior=prior, weight=weight, floor=self.floor, unbounded=self.unbounded)


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorWeighted:
    """A scorer plus `weight` times the log of the prior density relative to its peak, floored.

    A density that is unbounded at a bound, such as a decay, has its peak a little off it. Next to the bound it counts
    no more than there, or, if `unbounded`, in full: then the search is drawn to the bound itself.

    For acquisition functions in log form this is piBO's product; for the others, which are in normalized objectives,
    the prior is a bonus in those units.
    """

    inner: Scorer
    prior: ProductPrior
    weight: float
    floor: float
    unbounded: bool = False
    _log_peak: float = field(init=False, repr=False)
    _log_cap: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_log_peak", self.prior.log_peak())
        cap = self.prior.log_supremum() - self._log_peak if self.unbounded else 0.0
        object.__setattr__(self, "_log_cap", cap)

    @property
    def is_differentiable(self) -> bool:
        """Whether the inner scorer is."""
        return self.inner.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return self.inner(X) + self.weight * self.log_relative_density(X)

    @property
    def rough(self) -> Rough | None:
        """The cheaper approximation, if the inner scorer has one."""
        inner = rough_of(self.inner)
        return None if inner is None else lambda X: inner(X) + self.weight * self.log_relative_density(X)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        score, gradient = self.inner.with_gradient(X)
        relative = self.log_relative_density(X)
        is_below_cap = self.prior.log_density(X) < self._log_peak + self._log_cap
        share = is_below_cap * (np.exp(self._log_share(X) - relative) if self.floor else 1.0)
        return score + self.weight * relative, gradient + self.weight * share[:, None] * self.prior.log_gradient(X)

    def log_relative_density(self, X: FloatArray) -> FloatArray:
        """Return log((1 - floor) density / peak + floor), shape (n,)."""
        log_share = self._log_share(X)
        return log_share if self.floor == 0 else np.logaddexp(log_share, math.log(self.floor))

    def _log_share(self, X: FloatArray) -> FloatArray:
        """Return log((1 - floor) density / peak), shape (n,), no more than the cap."""
        return math.log1p(-self.floor) + np.minimum(self.prior.log_density(X) - self._log_peak, self._log_cap)


def check_prior_free(share: float) -> None:
    """Raise a `ScenarioError` if the share of suggestions without the prior is none."""
    if not 0 <= share <= 1:
        raise ScenarioError("$.prior_free", f"the share is {share}", allowed="in [0, 1]")
