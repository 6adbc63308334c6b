"""A penalty for being near a box."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import Episode, FloatArray
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


@dataclass(frozen=True, slots=True, kw_only=True)
class BoxAvoidance:
    """Charge 1 / (w (d + m)^2) for a tip at distance d from a box; finite inside, where d = 0."""

    box: Box
    width: float
    """w, without unit; a larger width charges less."""
    margin: float
    """m in [m]."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, negative, shape (n_steps,)."""
        distance = self.box.distance(episode.tip_positions[1:])
        return -1.0 / (self.width * np.square(distance + self.margin))
