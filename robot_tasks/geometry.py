"""Positions, quaternions and poses as plain tuples of floats.

A tick handles a few dozen numbers; at that size tuples are several times faster than NumPy arrays.
"""

from __future__ import annotations

from math import acos, cos, sin, sqrt
from typing import NamedTuple, TypeAlias

Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]

Stiffness: TypeAlias = tuple[float, float, float, float]
"""Stiffness along x, y, z in [N/m] and about every axis in [Nm/rad]."""

TOOL_DOWN: Quaternion = (0.0, 1.0, 0.0, 0.0)
"""Half a turn about world x: the tool points straight down and its x axis along world x."""

_SMALL_ANGLE = 1e-9


class Pose(NamedTuple):
    """A position and an orientation in world axes."""

    position: Vector
    """x, y, z in [m]."""
    quaternion: Quaternion
    """Unit quaternion w, x, y, z."""


def distance(a: Vector, b: Vector) -> float:
    """Measure the straight distance between two points in [m]."""
    dx, dy, dz = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return sqrt(dx * dx + dy * dy + dz * dz)


def turned(pose: Pose, angle: float) -> Pose:
    """Turn a pose in place about the vertical by an angle in [rad]."""
    c, s = cos(0.5 * angle), sin(0.5 * angle)
    w, x, y, z = pose.quaternion
    return Pose(pose.position, (c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w))


def moved(pose: Pose, offset: Vector) -> Pose:
    """Move a pose by an offset in world axes in [m]."""
    (x, y, z), (dx, dy, dz) = pose.position, offset
    return Pose((x + dx, y + dy, z + dz), pose.quaternion)


def rotation_angle(a: Quaternion, b: Quaternion) -> float:
    """Measure the angle of the shortest rotation between two orientations, in [0, pi] [rad]."""
    return 2.0 * acos(min(1.0, abs(_dot(a, b))))


class Slerp:
    """Interpolate between two orientations along the shortest rotation, at constant speed.

    Parameters
    ----------
    start, end
        Unit quaternions w, x, y, z. The end may be replaced by its negative, the same orientation.
    """

    __slots__ = ("_end", "_half_angle", "_scale", "_start", "angle")

    def __init__(self, start: Quaternion, end: Quaternion) -> None:
        sign = 1.0 if _dot(start, end) >= 0.0 else -1.0
        self._start = start
        self._end: Quaternion = (sign * end[0], sign * end[1], sign * end[2], sign * end[3])
        self.angle = rotation_angle(start, end)
        self._half_angle = 0.5 * self.angle
        self._scale = 1.0 / sin(self._half_angle) if self.angle > _SMALL_ANGLE else 0.0

    def at(self, fraction: float) -> Quaternion:
        """Return the orientation at a fraction of the way, 0 at the start and 1 at the end."""
        if self._scale == 0.0:
            return self._end
        a = sin((1.0 - fraction) * self._half_angle) * self._scale
        b = sin(fraction * self._half_angle) * self._scale
        p, q = self._start, self._end
        return (a * p[0] + b * q[0], a * p[1] + b * q[1], a * p[2] + b * q[2], a * p[3] + b * q[3])


def _dot(a: Quaternion, b: Quaternion) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
