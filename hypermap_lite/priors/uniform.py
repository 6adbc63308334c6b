"""No preference: every part of the axis is as likely as any other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.priors.base import Axis, Density
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class UniformPrior(Density):
    """The flat density, both as the user writes it and on the axis."""

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis: it is the same everywhere."""
        return self

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n,)."""
        return rng.random(n)

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return zeros, shape (n,)."""
        return np.zeros(len(u))

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return zeros, shape (n,)."""
        return np.zeros(len(u))

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return u itself."""
        return u

    def mode(self) -> float:
        """Return the middle of the axis."""
        return 0.5
