"""A search motion: Archimedes' spiral, out and in again, at constant speed along its path."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, pi, sin, sqrt
from typing import Final

from robot_tasks.geometry import Vector

CORE: Final = 0.001
"""Radius in [m] added in the law of motion, which keeps the turning rate finite at the centre."""
NOTHING: Final = 1e-12
"""Pitch and radius in [m] and speed in [m/s] below which there is no motion."""
PUBLISHED_STEP: Final = 0.1
"""Seconds between two points of the spiral in the published code."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArchimedesSpiral:
    """A horizontal spiral r = pitch theta / (2 pi) that grows to a radius, shrinks to zero, and begins again.

    The reference turns at d theta / dt = speed / (r + `CORE`), so it moves along the path at `speed` but for the
    innermost millimetres. The angle grows all the time; on the way in the turns lie between or on those of the way out.

    Raises
    ------
    ValueError
        If a field is negative.
    """

    pitch: float
    """Distance between neighbouring turns in [m]; 0: no motion."""
    speed: float
    """Speed along the path in [m/s]; 0: no motion."""
    radius: float
    """Largest radius in [m]; 0: no motion."""

    def __post_init__(self) -> None:
        if min(self.pitch, self.speed, self.radius) < 0.0:
            raise ValueError(f"{self}: no number may be negative")

    def __str__(self) -> str:
        return f"spiral, pitch {self.pitch:g} m, {self.speed:g} m/s, radius up to {self.radius:g} m"

    @property
    def is_still(self) -> bool:
        """Whether pitch, speed or radius leave no motion."""
        return min(self.pitch, self.speed, self.radius) < NOTHING

    def offset(self, time: float) -> Vector:
        """Return the offset in world axes in [m] at a time in [s] since the start.

        With b = pitch / (2 pi), the way out solves b theta^2 / 2 + `CORE` theta = speed t; the way in is the way out
        backwards in time, with the angle going on.
        """
        if self.is_still:
            return 0.0, 0.0, 0.0
        b = self.pitch / (2.0 * pi)
        widest = self.radius / b  # angle at the largest radius
        one_way = (0.5 * b * widest + CORE) * widest / self.speed  # [s]
        rounds, time = divmod(time, 2.0 * one_way)
        is_outbound = time <= one_way
        way = self.speed * (time if is_outbound else 2.0 * one_way - time)
        turned = (sqrt(CORE * CORE + 2.0 * b * way) - CORE) / b
        r = b * turned
        angle = 2.0 * widest * rounds + (turned if is_outbound else 2.0 * widest - turned)
        return r * cos(angle), r * sin(angle), 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SteppedSpiral(ArchimedesSpiral):
    """The same law by explicit Euler steps of `PUBLISHED_STEP`, held between them, as in the published code.

    Where speed x step is large against the radius it is no spiral: 0.1 m/s with a pitch of 15 mm leaps to a radius of
    20 mm in the first step. On the way in it leaps from near the centre to the largest radius again.
    """

    _points: list[Vector] = field(default_factory=lambda: [(0.0, 0.0, 0.0)], init=False, repr=False, compare=False)
    _state: list[float] = field(default_factory=lambda: [0.0, 0.0, 1.0], init=False, repr=False, compare=False)

    def offset(self, time: float) -> Vector:
        """Return the offset in world axes in [m] at a time in [s] since the start."""
        n_steps = int(time / PUBLISHED_STEP + 1e-6)
        while len(self._points) <= n_steps:
            self._step()
        return self._points[n_steps]

    def _step(self) -> None:
        r, angle, direction = self._state
        turn = self.speed * PUBLISHED_STEP / (r + CORE)
        r, angle = r + direction * turn * self.pitch / (2.0 * pi), angle + turn
        if r > self.radius:
            r, direction = self.radius, -1.0
        elif r < 0.0:
            r, direction = 0.0, 1.0
        self._state[:] = r, angle, direction
        self._points.append((r * cos(angle), r * sin(angle), 0.0))
