"""Distance over time with constant acceleration, constant speed, constant deceleration."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Self


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionLimits:
    """How fast a coordinate may move; [m] for translation, [rad] for rotation."""

    speed: float
    """Largest speed in [m/s] or [rad/s]."""
    acceleration: float
    """Acceleration when speeding up in [m/s^2] or [rad/s^2]."""
    deceleration: float
    """Deceleration when slowing down, positive, in [m/s^2] or [rad/s^2]."""

    def __post_init__(self) -> None:
        if min(self.speed, self.acceleration, self.deceleration) <= 0.0:
            raise ValueError(f"motion limits must be positive, got {self}")


@dataclass(frozen=True, slots=True, kw_only=True)
class TrapezoidalProfile:
    """The fastest motion over a distance from rest to rest within the limits.

    A short distance never reaches full speed; its profile is a triangle.
    """

    distance: float
    """Length of the way in [m] or [rad]."""
    limits: MotionLimits
    t_accelerate: float
    """Seconds of acceleration."""
    t_cruise: float
    """Seconds at full speed."""
    t_decelerate: float
    """Seconds of deceleration."""
    duration: float
    """Sum of the three, in [s]."""

    @classmethod
    def plan(cls, distance: float, limits: MotionLimits) -> Self:
        """Plan the fastest profile for a distance, in [m] or [rad], not negative."""
        v, a, d = limits.speed, limits.acceleration, limits.deceleration
        ramps = v * v / (2.0 * a) + v * v / (2.0 * d)
        if distance > ramps:
            t_accelerate, t_cruise, t_decelerate = v / a, (distance - ramps) / v, v / d
        else:
            t_accelerate = sqrt(2.0 * distance * d / (a * (a + d)))
            t_cruise, t_decelerate = 0.0, t_accelerate * a / d
        return cls(
            distance=distance,
            limits=limits,
            t_accelerate=t_accelerate,
            t_cruise=t_cruise,
            t_decelerate=t_decelerate,
            duration=t_accelerate + t_cruise + t_decelerate,
        )

    def travelled(self, time: float) -> float:
        """Return the distance covered at a time in [s] since the start."""
        if time >= self.duration:
            return self.distance
        a = self.limits.acceleration
        if time <= self.t_accelerate:
            return 0.5 * a * time * time
        if time <= self.t_accelerate + self.t_cruise:
            return a * self.t_accelerate * (time - 0.5 * self.t_accelerate)
        remaining = self.duration - time
        return self.distance - 0.5 * self.limits.deceleration * remaining * remaining
