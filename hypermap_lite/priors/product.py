"""The user's whole belief: the product of the priors on single parameters and on groups of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.priors.base import Density, JointDensity
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True)
class AsJoint:
    """A density on one axis seen as one on a cube of one axis."""

    density: Density

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n, 1)."""
        return self.density.sample(n, rng)[:, None]

    def log_density(self, U: FloatArray) -> FloatArray:
        """Return the log density at n points, shape (n, 1), as shape (n,)."""
        return self.density.log_density(U[:, 0])

    def log_gradient(self, U: FloatArray) -> FloatArray:
        """Return the gradient of the log density at n points, shape (n, 1)."""
        return self.density.log_gradient(U[:, 0])[:, None]

    def mode(self) -> FloatArray:
        """Return the point of highest density, shape (1,)."""
        return np.array([self.density.mode()])

    def marginal(self, axes: Sequence[int]) -> AsJoint:
        """Return itself: there is no other axis."""
        if list(axes) != [0]:
            raise ValueError(f"Expected `axes` to be [0]. Got {list(axes)}")
        return self


@dataclass(frozen=True, slots=True)
class ProductPrior:
    """A density on the whole unit cube [0, 1]^d; uniform along the axes no factor speaks of."""

    dimension: int
    factors: tuple[tuple[tuple[int, ...], JointDensity], ...] = ()
    """Pairs of axes and the density on them; no axis stands in two of them."""

    @property
    def is_uniform(self) -> bool:
        """Whether it says nothing at all."""
        return not self.factors

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n, d)."""
        X = rng.random((n, self.dimension))
        for axes, density in self.factors:
            X[:, list(axes)] = density.sample(n, rng)
        return X

    def log_density(self, X: FloatArray) -> FloatArray:
        """Return the log density at n points, shape (n, d), as shape (n,); -inf where it forbids a level."""
        total = np.zeros(len(X))
        for axes, density in self.factors:
            total += density.log_density(X[:, list(axes)])
        return total

    def log_gradient(self, X: FloatArray) -> FloatArray:
        """Return the gradient of the log density at n points, shape (n, d)."""
        gradient = np.zeros_like(X)
        for axes, density in self.factors:
            gradient[:, list(axes)] = density.log_gradient(X[:, list(axes)])
        return gradient

    def mode(self) -> FloatArray:
        """Return a point of (nearly) highest density, shape (d,)."""
        x = np.full(self.dimension, 0.5)
        for axes, density in self.factors:
            x[list(axes)] = density.mode()
        return x

    def marginal(self, axes: Sequence[int]) -> ProductPrior:
        """Return the density on some axes: the product of the factors' own marginals."""
        place = {axis: i for i, axis in enumerate(axes)}
        factors = []
        for own, density in self.factors:
            kept = [k for k, axis in enumerate(own) if axis in place]
            if kept:
                factors.append((tuple(place[own[k]] for k in kept), density.marginal(kept)))
        return ProductPrior(len(axes), tuple(factors))

    def log_peak(self) -> float:
        """Return the log density at the mode: what relative densities are measured against."""
        return float(self.log_density(self.mode()[None])[0])

    def log_supremum(self) -> float:
        """Return the log density where it is highest, bounds at which a density on one axis is unbounded included."""
        best = self.mode()
        for axes, density in self.factors:
            if len(axes) == 1:
                places = np.array([[best[axes[0]]], [0.0], [1.0]])
                best[axes[0]] = places[np.argmax(density.log_density(places)), 0]  # the first of equals: the mode
        return float(self.log_density(best[None])[0])
