"""What a reward is, and how rewards add up to an objective."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from robot_tasks.episode import Episode, FloatArray


class Reward(Protocol):
    """A function of a finished episode; larger is better."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return one number per step, shape (n_steps,), for the state at the end of each step."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class RewardTerm:
    """A named, weighted reward of an objective."""

    name: str
    """Name of the column that reports the term."""
    reward: Reward
    weight: float = 1.0
    """Factor on the sum over all steps."""

    def total(self, episode: Episode) -> float:
        """Sum the weighted reward over the whole episode."""
        return self.weight * float(self.reward(episode).sum())
