"""Relations between things, to be checked against the world: what a skill needs, keeps and brings about."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, degrees
from typing import Protocol

from robot_tasks.geometry import Pose, Vector, distance, rotation_angle
from robot_tasks.skills.behaviour import World


class Relation(Protocol):
    """A statement about the world that holds or does not; its text reads like a planner's predicate."""

    def holds(self, world: World) -> bool:
        """Tell whether the statement is true now."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class At:
    """A thing is at a place, within a distance and, if one is given, an angle."""

    thing: str
    """Name of a body or site of the scene."""
    place: Pose | str
    """Where it is to be: a pose in world axes, or the name of another body or site."""
    place_name: str
    """What the place is called, as in ``"hole"``."""
    distance: float
    """Largest distance in [m]."""
    angle: float | None = None
    """Largest rotation in [rad]; None if the orientation does not matter."""

    def holds(self, world: World) -> bool:
        """Tell whether the thing is there."""
        pose = world.pose_of(self.thing)
        place = world.pose_of(self.place) if isinstance(self.place, str) else self.place
        if distance(pose.position, place.position) >= self.distance:
            return False
        return self.angle is None or rotation_angle(pose.quaternion, place.quaternion) < self.angle

    def __str__(self) -> str:
        angle = "" if self.angle is None else f" and {degrees(self.angle):g} deg"
        return f"at({self.thing}, {self.place_name}) within {self.distance:g} m{angle}"


@dataclass(frozen=True, slots=True, kw_only=True)
class PointsDown:
    """The z axis of a thing, that of a tool out of its flange, points straight down but for an angle."""

    thing: str
    """Name of a body or site of the scene."""
    angle: float
    """Largest tilt in [rad]."""

    def holds(self, world: World) -> bool:
        """Tell whether the tilt is small enough; a turn about the vertical does not count."""
        _, x, y, _ = world.pose_of(self.thing).quaternion
        cosine = 2.0 * (x * x + y * y) - 1.0  # of the angle between the axis and straight down
        return cosine > cos(self.angle)

    def __str__(self) -> str:
        return f"points_down({self.thing}) within {degrees(self.angle):g} deg"


@dataclass(frozen=True, slots=True, kw_only=True)
class Within:
    """A thing is inside a region: a box with sides along the world axes."""

    thing: str
    """Name of a body or site of the scene."""
    low: Vector
    """Smallest x, y, z in [m]; minus infinity leaves a side open."""
    high: Vector
    """Largest x, y, z in [m]."""
    region_name: str
    """What the region is called."""

    def holds(self, world: World) -> bool:
        """Tell whether the thing's origin is inside."""
        position = world.pose_of(self.thing).position
        return all(low <= x <= high for low, x, high in zip(self.low, position, self.high, strict=True))

    def __str__(self) -> str:
        return f"within({self.thing}, {self.region_name})"


@dataclass(frozen=True, slots=True)
class Not:
    """The opposite of a relation."""

    relation: Relation

    def holds(self, world: World) -> bool:
        """Tell whether the relation does not hold."""
        return not self.relation.holds(world)

    def __str__(self) -> str:
        return f"not {self.relation}"


def first_violated(relations: Sequence[Relation], world: World) -> Relation | None:
    """Find the first relation that does not hold, in order."""
    return next((relation for relation in relations if not relation.holds(world)), None)
