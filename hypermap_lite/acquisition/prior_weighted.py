"""piBO: any acquisition function, weighted by what the user believes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.acquisition.base import Scorer
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.typing import FloatArray

STEP = 1e-6
"""Step of the central differences of the log prior, in units of the cube."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorWeighting:
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

    def __post_init__(self) -> None:
        if self.beta is not None and not self.beta >= 0:
            raise ScenarioError("$.beta", f"the strength is {self.beta}", allowed="a number >= 0, or null")
        if not 0 <= self.floor < 1:
            raise ScenarioError("$.floor", f"the floor is {self.floor}", allowed="in [0, 1)")

    def weight(self, n: int, model_budget: int) -> float:
        """Return the exponent at the n-th model-based suggestion, n >= 1, of a budget of so many."""
        beta = 0.1 * model_budget if self.beta is None else self.beta
        return beta / n


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorWeighted:
    """A scorer plus `weight` times the log of the prior density relative to its peak, floored.

    For acquisition functions in log form this is piBO's product; for the others, which are in normalized objectives,
    the prior is a bonus in those units.
    """

    inner: Scorer
    prior: ProductPrior
    weight: float
    floor: float

    @property
    def is_differentiable(self) -> bool:
        """Whether the inner scorer is."""
        return self.inner.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return self.inner(X) + self.weight * self.log_relative_density(X)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        score, gradient = self.inner.with_gradient(X)
        score = score + self.weight * self.log_relative_density(X)
        return score, gradient + self.weight * self._gradient(X)

    def log_relative_density(self, X: FloatArray) -> FloatArray:
        """Return log((1 - floor) density / peak + floor), shape (n,)."""
        log_ratio = self.prior.log_density(X) - self.prior.log_peak()
        if self.floor == 0:
            return log_ratio
        return np.logaddexp(np.log1p(-self.floor) + log_ratio, np.log(self.floor))

    def _gradient(self, X: FloatArray) -> FloatArray:
        gradient = np.empty_like(X)
        for j in range(X.shape[1]):
            low, high = X.copy(), X.copy()
            low[:, j] = np.maximum(X[:, j] - STEP, 0.0)
            high[:, j] = np.minimum(X[:, j] + STEP, 1.0)
            rise = self.log_relative_density(high) - self.log_relative_density(low)
            gradient[:, j] = rise / (high[:, j] - low[:, j])
        return gradient
