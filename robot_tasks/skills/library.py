"""The skills of the tasks, as trees built from their parameters."""

from __future__ import annotations

from functools import partial
from math import inf, radians
from typing import Final

from robot_tasks.geometry import Pose, Stiffness
from robot_tasks.motion.spiral import ArchimedesSpiral
from robot_tasks.names import TIP
from robot_tasks.skills.behaviour import Behaviour
from robot_tasks.skills.composites import ParallelFs, Selector, Serial, SerialStar
from robot_tasks.skills.conditions import At, Not, PointsDown, Within
from robot_tasks.skills.primitives import (
    ApplyForce,
    ChangeStiffness,
    CoordinateAtLeast,
    CoordinateBelow,
    OverlayMotion,
    PositionDistance,
    SetGoalPose,
)
from robot_tasks.skills.skill import ParameterKind, Skill, SkillDescription, SkillParameter

SEARCH_STIFFNESS: Final[Stiffness] = (500.0, 500.0, 0.0, 50.0)
"""Stiffness of a search over a surface: stiff along it, pressed onto it by force alone."""
PUSH_STIFFNESS: Final[Stiffness] = (700.0, 700.0, 700.0, 50.0)
"""Stiffness of a push."""
PUSH_FORCE: Final = -7.0
"""Vertical force in [N] that keeps a pushing tool down."""
OBJECT_TOLERANCE: Final = 0.03
"""Distance of an object to its goal in [m] that counts as arrived."""
OBJECT_ANGLE_TOLERANCE: Final = radians(10.0)
"""Angle of an object to its goal in [rad] that counts as arrived."""
APPROACH_RADIUS: Final = 0.2
"""Half the width in [m] of the region above a hole from which an insertion may begin."""
LARGEST_TILT: Final = radians(15.0)
"""Tilt of a peg in [rad] beyond which it would jam or break something."""


def pass_over_obstacle(
    first: Pose, second: Pose, goal: Pose, *, clear_height: float, passed_y: float, success_distance: float = 0.05
) -> Skill:
    """Move over an obstacle through two way-points, deciding at every tick which goal to head for.

    Parameters
    ----------
    first
        Way-point to rise to, the fall-back of the decision.
    second
        Way-point to head for once the tip is at least `clear_height` high.
    goal
        Goal to head for once the tip's y is below `passed_y`, whatever its height.
    clear_height
        Height of the tip in [m].
    passed_y
        World y of the tip in [m]; the motion runs towards negative y.
    success_distance
        Distance of the tip to the goal's position in [m] that ends the skill.

    Returns
    -------
    Skill
        Succeeds near the goal; fails only if it starts there.
    """
    tip_at_goal = At(thing=TIP, place=goal, place_name="goal", distance=success_distance)
    description = SkillDescription(
        name="pass_over_obstacle",
        description="Move over an obstacle through two way-points.",
        parameters=(
            _learned("first", Pose, "Way-point to rise to"),
            _learned("second", Pose, "Way-point beyond the obstacle"),
            _learned("clear_height", float, "Height from which to cross", unit="m"),
            _learned("passed_y", float, "World y below which to descend", unit="m"),
            _required("goal", Pose, "Where the tip is to arrive"),
            _optional("success_distance", float, "How near is near enough", unit="m"),
        ),
        preconditions=(Not(tip_at_goal),),
        postconditions=(tip_at_goal,),
    )
    body = ParallelFs(
        Selector(
            Serial(CoordinateBelow("y", passed_y), SetGoalPose(goal)),
            Serial(CoordinateAtLeast("z", clear_height), SetGoalPose(second)),
            SetGoalPose(first),
        ),
        PositionDistance(goal.position, threshold=success_distance),
    )
    return Skill(description, body)


def insert_peg(goal: Pose, *, force: float, search: ArchimedesSpiral, success_distance: float = 0.04) -> Skill:
    """Press a peg onto a surface and search on a spiral until it drops into the hole.

    Horizontally the tip follows the spiral around the goal; vertically only the force acts.

    Parameters
    ----------
    goal
        Pose of the inserted tip, in the middle of where the hole is believed to be.
    force
        Force along world z in [N]; negative presses down.
    search
        The spiral, which already runs during the descent.
    success_distance
        Distance of the tip to the goal's position in [m] that ends the skill.

    Returns
    -------
    Skill
        Succeeds near the goal; fails if it does not start above it, or if the peg tilts.
    """
    tip_in_hole = At(thing=TIP, place=goal, place_name="hole", distance=success_distance)
    description = SkillDescription(
        name="insert_peg",
        description="Press a peg onto a surface and search on a spiral until it drops into a hole.",
        parameters=(
            _learned("force", float, "Force along world z", unit="N"),
            _learned("search", ArchimedesSpiral, "Pitch, path speed and radius"),
            _required("goal", Pose, "Where the inserted tip is"),
            _optional("success_distance", float, "How near is near enough", unit="m"),
        ),
        preconditions=(Not(tip_in_hole), _above(goal)),
        holdconditions=(PointsDown(thing=TIP, angle=LARGEST_TILT),),
        postconditions=(tip_in_hole,),
    )
    body = ParallelFs(
        SetGoalPose(goal),
        ChangeStiffness(SEARCH_STIFFNESS),
        ApplyForce((0.0, 0.0, force)),
        OverlayMotion(search),
        PositionDistance(goal.position, threshold=success_distance),
    )
    return Skill(description, body)


def push_object(start: Pose, goal: Pose, *, thing: str, goal_site: str, arrival_distance: float = 0.05) -> Skill:
    """Put the tool down beside an object and push it along a straight line.

    Parameters
    ----------
    start
        Where the push begins.
    goal
        Where the tool heads for with the object before it.
    thing
        Body that is pushed.
    goal_site
        Site of the scene that marks the object's goal.
    arrival_distance
        Distance of the tip in [m] to `start` that ends the approach, and to `goal` that ends the push.

    Returns
    -------
    Skill
        Ends near the goal: successfully if the object is at its own.
    """
    object_at_goal = At(
        thing=thing, place=goal_site, place_name=goal_site, distance=OBJECT_TOLERANCE, angle=OBJECT_ANGLE_TOLERANCE
    )
    description = SkillDescription(
        name="push_object",
        description="Put the tool down beside an object and push it along a straight line.",
        parameters=(
            _learned("start", Pose, "Where the push begins"),
            _learned("goal", Pose, "Where the tool heads for"),
            _required("thing", str, "What is pushed"),
            _required("goal_site", str, "Where it is to arrive"),
            _optional("arrival_distance", float, "How near is near enough", unit="m"),
        ),
        preconditions=(Not(object_at_goal),),
        postconditions=(object_at_goal, At(thing=TIP, place=goal, place_name="goal", distance=arrival_distance)),
    )
    body = SerialStar(
        ParallelFs(_go_to(start, arrival_distance), ChangeStiffness(PUSH_STIFFNESS)),
        ParallelFs(_go_to(goal, arrival_distance), ChangeStiffness(PUSH_STIFFNESS), ApplyForce((0.0, 0.0, PUSH_FORCE))),
    )
    return Skill(description, body)


def _go_to(pose: Pose, arrival_distance: float) -> Behaviour:
    """Move straight to a pose until near it."""
    return ParallelFs(SetGoalPose(pose), PositionDistance(pose.position, threshold=arrival_distance))


def _above(goal: Pose) -> Within:
    """Tell that the tip is above a goal in the depth of a hole, and not far off."""
    x, y, z = goal.position
    low = (x - APPROACH_RADIUS, y - APPROACH_RADIUS, z)
    high = (x + APPROACH_RADIUS, y + APPROACH_RADIUS, inf)
    return Within(thing=TIP, low=low, high=high, region_name="above hole")


def _parameter(kind: ParameterKind, name: str, value_type: type, description: str, *, unit: str = "") -> SkillParameter:
    return SkillParameter(name=name, kind=kind, value_type=value_type, unit=unit, description=description)


_learned = partial(_parameter, ParameterKind.LEARNED)
_required = partial(_parameter, ParameterKind.REQUIRED)
_optional = partial(_parameter, ParameterKind.OPTIONAL)
