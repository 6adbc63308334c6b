"""Domain randomization: what may differ between rollouts, drawn from a seed, applied to a simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from robot_tasks.geometry import Pose, Vector, moved, turned
from robot_tasks.simulation import Simulation


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyShift:
    """Bodies that stand a little off their nominal places, in x and y, all by the same offset.

    Each offset is Gaussian and clipped at one standard deviation: a third of the rollouts sits on a bound.
    """

    bodies: tuple[str, ...]
    """Names of the bodies."""
    sigma: float
    """Standard deviation before clipping, and largest offset, in [m]."""

    def sample(self, rng: np.random.Generator) -> dict[str, Vector]:
        """Draw the offset x, y, 0 of each body in [m]."""
        x, y = np.clip(rng.normal(0.0, self.sigma, size=2), -self.sigma, self.sigma).tolist()
        return dict.fromkeys(self.bodies, (x, y, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectPlacement:
    """A free body that begins a little off its nominal pose, in x, y and about the vertical; clipped as `BodyShift`."""

    body: str
    """Name of the body."""
    pose: Pose
    """Nominal pose, at rest."""
    sigma: float
    """Standard deviation of x and y before clipping, and largest offset, in [m]."""
    sigma_yaw: float
    """Standard deviation of the angle before clipping, and largest angle, in [rad]."""

    def sample(self, rng: np.random.Generator) -> Pose:
        """Draw a pose."""
        scale = np.array([self.sigma, self.sigma, self.sigma_yaw])
        x, y, yaw = np.clip(rng.normal(0.0, scale), -scale, scale).tolist()
        return turned(moved(self.pose, (x, y, 0.0)), yaw)


@dataclass(frozen=True, slots=True, kw_only=True)
class Variation:
    """The circumstances of one rollout."""

    start: tuple[float, ...]
    """Joint angles at the start in [rad]."""
    shifts: Mapping[str, Vector]
    """Offset of each shifted body in [m]."""
    objects: Mapping[str, Pose] = field(default_factory=dict)
    """Pose of each free body at the start."""

    def apply(self, simulation: Simulation) -> None:
        """Reset a simulation and set it up for the rollout."""
        simulation.reset()
        for body, offset in self.shifts.items():
            simulation.shift_body(body, offset)
        for body, pose in self.objects.items():
            simulation.place_body(body, pose)
        simulation.place_arm(self.start)


@dataclass(frozen=True, slots=True, kw_only=True)
class Randomization:
    """What varies between the rollouts of a task."""

    starts: Mapping[str, tuple[float, ...]]
    """Start states, equally likely: name and joint angles in [rad]."""
    shifts: tuple[BodyShift, ...] = ()
    objects: tuple[ObjectPlacement, ...] = ()

    def sample(self, rng: np.random.Generator) -> Variation:
        """Draw a start state, the offsets of all shifted bodies and the poses of all objects."""
        start = list(self.starts.values())[int(rng.integers(len(self.starts)))]
        return Variation(
            start=start,
            shifts={name: shift for group in self.shifts for name, shift in group.sample(rng).items()},
            objects={placement.body: placement.sample(rng) for placement in self.objects},
        )

    def nominal(self, start: str) -> Variation:
        """Return the variation with a named start state and every body in its place."""
        return Variation(
            start=self.starts[start], shifts={}, objects={placement.body: placement.pose for placement in self.objects}
        )
