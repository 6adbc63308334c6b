"""Turn goals, which may change at any tick, into a reference pose for the controller."""

from __future__ import annotations

from math import sqrt
from typing import Final

from robot_tasks.geometry import Pose, Vector
from robot_tasks.motion.overlay import Overlay
from robot_tasks.motion.trajectory import Trajectory

FADING_SPEED: Final = 0.05
"""Speed in [m/s] at which the last offset of an overlay that was taken away shrinks to zero."""

_NO_OFFSET: Final[Vector] = (0.0, 0.0, 0.0)


class MotionGenerator:
    """Hold a pose, or follow a trajectory to the latest goal, with an overlay on top.

    A goal that differs from the present one starts a new trajectory from the *measured* pose and from rest: there is
    no blending, so an arm that lags behind its reference pauses at every change of mind.

    Parameters
    ----------
    pose
        Pose to hold until the first goal is set.
    """

    __slots__ = ("_last_offset", "_overlay", "_overlay_changed", "_started", "_trajectory")

    def __init__(self, pose: Pose) -> None:
        self._trajectory = Trajectory(pose, pose)
        self._started = 0.0
        self._overlay: Overlay | None = None
        self._overlay_changed = 0.0
        self._last_offset = _NO_OFFSET

    @property
    def goal(self) -> Pose:
        """Where the present trajectory ends."""
        return self._trajectory.goal

    def move_to(self, goal: Pose, *, measured: Pose, time: float) -> None:
        """Start a trajectory to a new goal, from the measured pose, at a time in [s]."""
        self._trajectory = Trajectory(measured, goal)
        self._started = time

    def set_overlay(self, overlay: Overlay | None, time: float) -> None:
        """Start an overlay at a time in [s] unless an equal one runs; None lets the last offset fade."""
        if overlay is self._overlay or overlay == self._overlay:
            return
        self._last_offset = self._offset(time)
        self._overlay = overlay
        self._overlay_changed = time

    def reference(self, time: float) -> Pose:
        """Return the reference pose at a time in [s]."""
        pose = self._trajectory.at(time - self._started)
        if self._overlay is None and self._last_offset is _NO_OFFSET:
            return pose
        (x, y, z), (dx, dy, dz) = pose.position, self._offset(time)
        return Pose((x + dx, y + dy, z + dz), pose.quaternion)

    def is_finished(self, time: float) -> bool:
        """Tell whether the reference stands still at the goal from this time in [s] on."""
        is_shifting = not self._overlay.is_still if self._overlay is not None else self._offset(time) != _NO_OFFSET
        return not is_shifting and time - self._started >= self._trajectory.duration

    def _offset(self, time: float) -> Vector:
        """Return the overlay's offset, or what is left of the last one."""
        elapsed = time - self._overlay_changed
        if self._overlay is not None:
            return self._overlay.offset(elapsed)
        x, y, z = self._last_offset
        length = sqrt(x * x + y * y + z * z)
        left = length - FADING_SPEED * elapsed
        if left <= 0.0:
            return _NO_OFFSET
        scale = left / length
        return scale * x, scale * y, scale * z
