"""What outputs may be off by, other than by the noise that all of them have."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.typing import BoolArray, FloatArray, Rng

SAYS_NOTHING: Final = 1e6
"""Variance of its own, in units of the standardized outputs squared, with which an output says nothing."""


@dataclass(frozen=True, slots=True)
class Offsets:
    """An unknown constant for all outputs beside, and something of its own for each output, all normal around zero."""

    is_beside: BoolArray
    """Which of the outputs are off by the constant, shape (n,)."""

    shared: float
    """Variance of the constant, in units of the standardized outputs squared, >= 0."""

    own: FloatArray
    """Variance of the rest of each output, shape (n,), >= 0."""

    @classmethod
    def of_outliers(cls, is_outlier: BoolArray) -> Offsets:
        """Return offsets with which the outliers among n outputs, shape (n,), say nothing."""
        return cls(np.zeros(len(is_outlier), dtype=bool), 0.0, np.where(is_outlier, SAYS_NOTHING, 0.0))

    @property
    def covariance(self) -> FloatArray:
        """Covariance of the outputs' offsets, shape (n, n)."""
        beside = self.is_beside.astype(float)
        return self.shared * np.outer(beside, beside) + np.diag(self.own)

    @property
    def says_something(self) -> BoolArray:
        """Which of the outputs say something, shape (n,)."""
        return self.own < SAYS_NOTHING

    def draw(self, rng: Rng) -> FloatArray:
        """Draw the outputs' offsets, shape (n,)."""
        own: FloatArray = np.sqrt(self.own) * rng.standard_normal(len(self.own))
        return own + np.where(self.is_beside, math.sqrt(self.shared) * rng.standard_normal(), 0.0)

    def padded(self, n: int) -> Offsets:
        """Return these with n more outputs that are off by nothing."""
        return Offsets(
            np.append(self.is_beside, np.zeros(n, dtype=bool)), self.shared, np.append(self.own, np.zeros(n))
        )
