"""A charge on the force that the skill asks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import Episode, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandedForce:
    """Charge |Fx| + |Fy| + |Fz| of the commanded feed-forward force in [N], whatever the tool then touches."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, not positive, shape (n_steps,)."""
        return -np.abs(episode.commanded_forces[1:]).sum(axis=1)
