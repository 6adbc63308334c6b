"""A charge on the distance between tip and reference, to which the force of the controller's spring is proportional."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_tasks.episode import Episode, FloatArray


def _error(episode: Episode) -> FloatArray:
    """Return the distance of tip and reference at the end of each step in [m], shape (n_steps,)."""
    return np.linalg.norm(episode.tip_positions[1:] - episode.reference_positions[1:], axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackingError:
    """Charge the distance between tip and reference in [m]; times the stiffness it is the spring's force in [N]."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, not positive, shape (n_steps,)."""
        return -_error(episode)


@dataclass(frozen=True, slots=True, kw_only=True)
class NegativeTrackingBell:
    """Charge exp(-(e^2 + m) / (2 w^2)) for a distance e of tip and reference, as the published code does.

    Its sense is inverted: the larger the error, and with it the force, the smaller the charge.
    """

    width: float
    """w in [m]."""
    offset: float = 0.0
    """m in [m^2]."""

    def __call__(self, episode: Episode) -> FloatArray:
        """Return the reward of each step, in [-1, 0), shape (n_steps,)."""
        return -np.exp(-(np.square(_error(episode)) + self.offset) / (2.0 * self.width**2))
