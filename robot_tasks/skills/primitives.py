"""Leaves of a behaviour tree: one question to the robot or one demand on it."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from robot_tasks.geometry import Pose, Stiffness, Vector, distance
from robot_tasks.motion.overlay import Overlay
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

    @property
    def label(self) -> str:
        """The pose asked for."""
        return f"SetGoalPose {_point(self.pose.position)}"

    def _update(self, context: SkillContext) -> Status:
        context.goal = self.pose
        return RUNNING


class ChangeStiffness(Behaviour):
    """Ask for a stiffness and keep running.

    Parameters
    ----------
    stiffness
        Along x, y, z in [N/m] and about every axis in [Nm/rad].
    """

    __slots__ = ("stiffness",)

    def __init__(self, stiffness: Stiffness) -> None:
        super().__init__()
        self.stiffness = stiffness

    @property
    def label(self) -> str:
        """The stiffness asked for."""
        x, y, z, rotation = self.stiffness
        return f"ChangeStiffness ({x:g}, {y:g}, {z:g}) N/m, {rotation:g} Nm/rad"

    def _update(self, context: SkillContext) -> Status:
        context.stiffness = self.stiffness
        return RUNNING


class ApplyForce(Behaviour):
    """Ask for a force on top of the spring's and keep running.

    Parameters
    ----------
    force
        In world axes in [N].
    """

    __slots__ = ("force",)

    def __init__(self, force: Vector) -> None:
        super().__init__()
        self.force = force

    @property
    def label(self) -> str:
        """The force asked for."""
        return f"ApplyForce {_point(self.force)} N"

    def _update(self, context: SkillContext) -> Status:
        context.force = self.force
        return RUNNING


class OverlayMotion(Behaviour):
    """Ask for a motion on top of the motion to the goal and keep running.

    Parameters
    ----------
    overlay
        The motion. Asking again for an equal one lets it go on.
    """

    __slots__ = ("overlay",)

    def __init__(self, overlay: Overlay) -> None:
        super().__init__()
        self.overlay = overlay

    @property
    def label(self) -> str:
        """The motion asked for."""
        return f"OverlayMotion {self.overlay}"

    def _update(self, context: SkillContext) -> Status:
        context.overlay = self.overlay
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

    @property
    def label(self) -> str:
        """Where the tip is awaited."""
        return f"PositionDistance to {_point(self.target)} < {self.threshold:g} m"

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

    @property
    def label(self) -> str:
        """The question asked."""
        return f"{type(self).__name__} {_AXES[self._index]}, {self.limit:g} m"

    def _update(self, context: SkillContext) -> Status:
        return SUCCESS if context.tip[self._index] < self.limit else FAILURE


class CoordinateAtLeast(CoordinateBelow):
    """Succeed while a coordinate of the tip is at or above a limit, fail otherwise."""

    __slots__ = ()

    def _update(self, context: SkillContext) -> Status:
        return FAILURE if context.tip[self._index] < self.limit else SUCCESS


def _point(vector: Vector) -> str:
    x, y, z = vector
    return f"({x:g}, {y:g}, {z:g})"
