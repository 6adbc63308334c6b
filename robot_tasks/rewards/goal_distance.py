"""A bell-shaped reward for being near a point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import Episode, FloatArray
from robot_tasks.geometry import Vector


@dataclass(frozen=True, slots=True, kw_only=True)
class GoalDistance:
    """Pay exp(-(d^2 + m) / (2 w^2)) for a tip at distance d from the goal.

    The offset m is added to the *squared* distance; it scales the whole curve by exp(-m / (2 w^2)).
    """

    goal: Vector
    """Goal in world axes in [m]."""
    width: float
    """w in [m]."""
    offset: float = 0.0
    """m in [m^2]."""
    follows: str | None = None
    """Body that the goal moves with, where the circumstances of a rollout shift it; None: it stays."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, in (0, 1], shape (n_steps,)."""
        difference = episode.tips_seen_from(self.follows) - np.asarray(self.goal)  # (n_steps, 3)
        squared_distance = np.square(difference).sum(axis=1)
        return np.exp(-(squared_distance + self.offset) / (2.0 * self.width**2))
