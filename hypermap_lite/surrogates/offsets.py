"""What outputs reported beside the evaluations that count may be off by."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hypermap_lite.typing import BoolArray, FloatArray, Rng


@dataclass(frozen=True, slots=True)
class Offsets:
    """An unknown constant for all outputs beside, and something of its own for each, both normal around zero."""

    is_beside: BoolArray
    """Which of the outputs it is about, shape (n,)."""

    shared: float
    """Variance of the constant, in units of the standardized outputs squared, >= 0."""

    own: float
    """Variance of the rest, >= 0."""

    @property
    def covariance(self) -> FloatArray:
        """Covariance of the outputs' offsets, shape (n, n)."""
        beside = self.is_beside.astype(float)
        return self.shared * np.outer(beside, beside) + self.own * np.diag(beside)

    def draw(self, rng: Rng) -> FloatArray:
        """Draw the outputs' offsets, shape (n,)."""
        own = math.sqrt(self.own) * rng.standard_normal(len(self.is_beside))
        return np.where(self.is_beside, math.sqrt(self.shared) * rng.standard_normal() + own, 0.0)

    def padded(self, n: int) -> Offsets:
        """Return these with n more outputs that are off by nothing."""
        return Offsets(np.append(self.is_beside, np.zeros(n, dtype=bool)), self.shared, self.own)
