"""A bonus for having reached the goal at any time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import Episode, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedSuccess:
    """Pay a fixed value on every step of an episode in which the skill ever succeeded.

    Steps before the success count too, so the bonus does not depend on how fast the skill was.
    """

    value: float
    """Reward per step."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the bonus, or zeros, shape (n_steps,)."""
        return np.full(episode.n_steps, self.value if episode.is_success else 0.0)
