"""Turn goals, which may change at any tick, into a reference pose for the controller."""

from __future__ import annotations

from robot_tasks.geometry import Pose
from robot_tasks.motion.trajectory import Trajectory


class MotionGenerator:
    """Hold a pose, or follow a trajectory to the latest goal.

    A goal that differs from the present one starts a new trajectory from the *measured* pose and from rest: there is
    no blending, so an arm that lags behind its reference pauses at every change of mind.

    Parameters
    ----------
    pose
        Pose to hold until the first goal is set.
    """

    __slots__ = ("_started", "_trajectory")

    def __init__(self, pose: Pose) -> None:
        self._trajectory = Trajectory(pose, pose)
        self._started = 0.0

    @property
    def goal(self) -> Pose:
        """Where the present trajectory ends."""
        return self._trajectory.goal

    def move_to(self, goal: Pose, *, measured: Pose, time: float) -> None:
        """Start a trajectory to a new goal, from the measured pose, at a time in [s]."""
        self._trajectory = Trajectory(measured, goal)
        self._started = time

    def reference(self, time: float) -> Pose:
        """Return the reference pose at a time in [s]."""
        return self._trajectory.at(time - self._started)

    def is_finished(self, time: float) -> bool:
        """Tell whether the reference stands still at the goal from this time in [s] on."""
        return time - self._started >= self._trajectory.duration
