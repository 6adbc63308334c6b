"""Bell-shaped rewards for the pose of the task's object."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import Episode, FloatArray
from robot_tasks.geometry import Quaternion, Vector


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectPosition:
    """Pay exp(-(d + m) / (2 w^2)) for an object at distance d from its goal: d enters unsquared."""

    goal: Vector
    """Goal of the object's origin in world axes in [m]."""
    width: float
    """w in [m^0.5]."""
    offset: float = 0.0
    """m in [m]."""
    follows: str | None = None
    """Body that the goal moves with, where the circumstances of a rollout shift it; None: it stays."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, in (0, 1], shape (n_steps,)."""
        goal = np.asarray(self.goal) + episode.shift_of(self.follows)
        distance = np.linalg.norm(episode.object_track[1:, :3] - goal, axis=1)  # (n_steps,)
        return np.exp(-(distance + self.offset) / (2.0 * self.width**2))


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectOrientation:
    """Pay exp(-(phi + m) / (2 w^2)) for an object turned by an angle phi from its goal: phi enters unsquared."""

    goal: Quaternion
    """Goal orientation w, x, y, z."""
    width: float
    """w in [rad^0.5]."""
    offset: float = 0.0
    """m in [rad]."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, in (0, 1], shape (n_steps,)."""
        cosine = np.abs(episode.object_track[1:, 3:] @ np.asarray(self.goal))  # of half the angle, (n_steps,)
        angle = 2.0 * np.arccos(np.minimum(cosine, 1.0))
        return np.exp(-(angle + self.offset) / (2.0 * self.width**2))
