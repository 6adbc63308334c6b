"""Leaves of a behaviour tree: one question to the robot or one demand on it."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from robot_tasks.geometry import Pose, Vector, distance
from robot_tasks.skills.behaviour import FAILURE, RUNNING, SUCCESS, Behaviour, Condition, SkillContext, Status

Axis: TypeAlias = Literal["x", "y", "z"]

_AXES: Final = "xyz"


class SetGoalPose(Behaviour):
    """Ask for a pose and keep running; another behaviour tells when to stop.

    Parameters
    ----------
    pose
        Where to move.
    """

    __slots__ = ("pose",)

    def __init__(self, pose: Pose) -> None:
        super().__init__()
        self.pose = pose

    def _update(self, context: SkillContext) -> Status:
        context.goal = self.pose
        return RUNNING


class PositionDistance(Behaviour):
    """Succeed when the tip is near a point; run until then.

    Parameters
    ----------
    target
        The point in world axes, in [m].
    threshold
        Distance in [m] below which the tip counts as near.
    """

    __slots__ = ("target", "threshold")

    def __init__(self, target: Vector, *, threshold: float) -> None:
        super().__init__()
        self.target = target
        self.threshold = threshold

    def _update(self, context: SkillContext) -> Status:
        return SUCCESS if distance(context.tip, self.target) < self.threshold else RUNNING


class CoordinateBelow(Condition):
    """Succeed while a coordinate of the tip is below a limit, fail otherwise.

    Parameters
    ----------
    axis
        World axis.
    limit
        Limit in [m].
    """

    __slots__ = ("_index", "limit")

    def __init__(self, axis: Axis, limit: float) -> None:
        super().__init__()
        self._index = _AXES.index(axis)
        self.limit = limit

    def _update(self, context: SkillContext) -> Status:
        return SUCCESS if context.tip[self._index] < self.limit else FAILURE


class CoordinateAtLeast(CoordinateBelow):
    """Succeed while a coordinate of the tip is at or above a limit, fail otherwise."""

    __slots__ = ()

    def _update(self, context: SkillContext) -> Status:
        return FAILURE if context.tip[self._index] < self.limit else SUCCESS
