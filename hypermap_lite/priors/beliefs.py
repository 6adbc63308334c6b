"""Several priors with names: one per objective, and what they amount to together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.priors.base import JointDensity
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class Belief:
    """A prior over the whole cube and what it is called in the history."""

    prior: ProductPrior
    name: str = ""
    """The objective whose optimum it is about; empty if it is about all of them."""

    objective: int | None = None
    """Number of that objective; None if it is about all of them."""


@dataclass(frozen=True, slots=True)
class InTurn:
    """The equal mixture of several densities; draws take them in turn, the first one first."""

    densities: tuple[JointDensity, ...]

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n, k), the i-th of them from density i modulo their number."""
        count = len(self.densities)
        parts = [density.sample(-(-(n - i) // count), rng) for i, density in enumerate(self.densities[:n])]
        X = np.empty((n, parts[0].shape[1] if parts else self.densities[0].sample(0, rng).shape[1]))
        for i, part in enumerate(parts):
            X[i::count] = part
        return X

    def log_density(self, U: FloatArray) -> FloatArray:
        """Return the log density at n points, shape (n, k), as shape (n,)."""
        return np.logaddexp.reduce(self._logs(U), axis=0) - math.log(len(self.densities))

    def log_gradient(self, U: FloatArray) -> FloatArray:
        """Return the gradient of the log density at n points, shape (n, k)."""
        logs = self._logs(U)
        total = np.logaddexp.reduce(logs, axis=0)
        shares = np.exp(logs - np.where(np.isfinite(total), total, 0.0))  # (count, n)
        gradients = np.array([density.log_gradient(U) for density in self.densities])
        return (shares[..., None] * gradients).sum(axis=0)

    def _logs(self, U: FloatArray) -> FloatArray:
        return np.array([density.log_density(U) for density in self.densities])

    def mode(self) -> FloatArray:
        """Return the densest of the densities' modes, shape (k,)."""
        modes = np.array([density.mode() for density in self.densities])
        return np.asarray(modes[np.argmax(self.log_density(modes))])

    def marginal(self, axes: Sequence[int]) -> InTurn:
        """Return the equal mixture of the densities' marginals."""
        return InTurn(tuple(density.marginal(axes) for density in self.densities))


def together(beliefs: Sequence[Belief]) -> ProductPrior:
    """Return what several priors amount to for whatever knows only one: each is as likely to be right."""
    if len(beliefs) == 1:
        return beliefs[0].prior
    dimension = beliefs[0].prior.dimension
    return ProductPrior(dimension, ((tuple(range(dimension)), InTurn(tuple(b.prior for b in beliefs))),))


def completed(own: ProductPrior, common: ProductPrior) -> ProductPrior:
    """Return a prior with another one on the axes that it does not speak of."""
    spoken = {axis for axes, _ in own.factors for axis in axes}
    factors = list(own.factors)
    for axes, density in common.factors:
        kept = [k for k, axis in enumerate(axes) if axis not in spoken]
        if kept:
            rest = density if len(kept) == len(axes) else density.marginal(kept)
            factors.append((tuple(axes[k] for k in kept), rest))
    return ProductPrior(own.dimension, tuple(factors))
