"""Domain randomization: what may differ between rollouts, drawn from a seed, applied to a simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from robot_tasks.geometry import Vector
from robot_tasks.simulation import Simulation


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyShift:
    """A body that stands a little off its nominal place, in x and y.

    Each offset is Gaussian and clipped at one standard deviation: a third of the rollouts sits on a bound.
    """

    body: str
    """Name of the body."""
    sigma: float
    """Standard deviation before clipping, and largest offset, in [m]."""

    def sample(self, rng: np.random.Generator) -> Vector:
        """Draw an offset x, y, 0 in [m]."""
        x, y = np.clip(rng.normal(0.0, self.sigma, size=2), -self.sigma, self.sigma).tolist()
        return x, y, 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Variation:
    """The circumstances of one rollout."""

    start: tuple[float, ...]
    """Joint angles at the start in [rad]."""
    shifts: Mapping[str, Vector]
    """Offset of each shifted body in [m]."""

    def apply(self, simulation: Simulation) -> None:
        """Reset a simulation and set it up for the rollout."""
        simulation.reset()
        for body, offset in self.shifts.items():
            simulation.shift_body(body, offset)
        simulation.place_arm(self.start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Randomization:
    """What varies between the rollouts of a task."""

    starts: Mapping[str, tuple[float, ...]]
    """Start states, equally likely: name and joint angles in [rad]."""
    shifts: tuple[BodyShift, ...] = ()

    def sample(self, rng: np.random.Generator) -> Variation:
        """Draw a start state and the offsets of all bodies."""
        start = list(self.starts.values())[int(rng.integers(len(self.starts)))]
        return Variation(start=start, shifts={shift.body: shift.sample(rng) for shift in self.shifts})

    def nominal(self, start: str) -> Variation:
        """Return the variation with a named start state and every body in its place."""
        return Variation(start=self.starts[start], shifts={})
