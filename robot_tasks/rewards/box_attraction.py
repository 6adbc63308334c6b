"""A reward for being near a box."""

from __future__ import annotations

from dataclasses import dataclass

from robot_tasks.episode import Episode, FloatArray
from robot_tasks.rewards.box import Box


@dataclass(frozen=True, slots=True, kw_only=True)
class BoxAttraction:
    """Pay 1 / (w (d + m)) for a tip at distance d from a box, finite inside, where d = 0."""

    box: Box
    width: float
    """w in [1/m]; a larger width pays less."""
    margin: float
    """m in [m]."""
    follows: str | None = None
    """Body that the box moves with, where the circumstances of a rollout shift it; None: it stays."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, positive, shape (n_steps,)."""
        distance = self.box.distance(episode.tips_seen_from(self.follows))
        return 1.0 / (self.width * (distance + self.margin))
