"""Boxes that the tip is to be near to or far from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import FloatArray
from robot_tasks.geometry import Vector


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """A box with sides along the world axes."""

    low: Vector
    """Smallest x, y, z in [m]."""
    high: Vector
    """Largest x, y, z in [m]."""

    def __post_init__(self) -> None:
        if any(low >= high for low, high in zip(self.low, self.high, strict=True)):
            raise ValueError(f"Box: every low must be below its high, got {self.low} and {self.high}")

    def distance(self, points: FloatArray) -> FloatArray:
        """Measure the distance of points (n, 3) in [m] to the box, 0 inside; shape (n,)."""
        outside = np.maximum(np.maximum(np.asarray(self.low) - points, points - np.asarray(self.high)), 0.0)
        return np.sqrt(np.square(outside).sum(axis=1))
