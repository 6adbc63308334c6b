"""A straight movement of a pose: line and shortest rotation, arriving at the same time."""

from __future__ import annotations

from typing import Final

from robot_tasks.geometry import Pose, Slerp, distance
from robot_tasks.motion.profile import MotionLimits, TrapezoidalProfile

TRANSLATION_LIMITS: Final = MotionLimits(speed=0.2, acceleration=0.3, deceleration=0.15)
ROTATION_LIMITS: Final = MotionLimits(speed=0.5, acceleration=0.5, deceleration=0.35)


class Trajectory:
    """Move from one pose to another, from rest to rest.

    Translation and rotation have a trapezoidal profile each; the shorter one is stretched in time to the
    duration of the longer one.

    Parameters
    ----------
    start, goal
        First and last pose.
    translation, rotation
        Limits in [m] and [rad].
    """

    __slots__ = (
        "_direction",
        "_rotation",
        "_rotation_rate",
        "_slerp",
        "_translation",
        "_translation_rate",
        "duration",
        "goal",
        "start",
    )

    def __init__(
        self,
        start: Pose,
        goal: Pose,
        *,
        translation: MotionLimits = TRANSLATION_LIMITS,
        rotation: MotionLimits = ROTATION_LIMITS,
    ) -> None:
        self.start = start
        self.goal = goal
        self._slerp = Slerp(start.quaternion, goal.quaternion)
        length = distance(start.position, goal.position)
        scale = 1.0 / length if length else 0.0
        (x, y, z), (goal_x, goal_y, goal_z) = start.position, goal.position
        self._direction = ((goal_x - x) * scale, (goal_y - y) * scale, (goal_z - z) * scale)
        self._translation = TrapezoidalProfile.plan(length, translation)
        self._rotation = TrapezoidalProfile.plan(self._slerp.angle, rotation)
        self.duration = max(self._translation.duration, self._rotation.duration)
        self._translation_rate = self._translation.duration / self.duration if self.duration else 0.0
        self._rotation_rate = self._rotation.duration / self.duration if self.duration else 0.0

    def at(self, time: float) -> Pose:
        """Return the pose at a time in [s] since the start; the goal from the duration on."""
        if time >= self.duration:
            return self.goal
        s = self._translation.travelled(time * self._translation_rate)
        x, y, z = self.start.position
        dx, dy, dz = self._direction
        angle = self._slerp.angle
        fraction = self._rotation.travelled(time * self._rotation_rate) / angle if angle else 1.0
        return Pose((x + s * dx, y + s * dy, z + s * dz), self._slerp.at(fraction))
