"""The skills of the tasks, as trees built from their parameters."""

from __future__ import annotations

from typing import Final

from robot_tasks.geometry import Pose
from robot_tasks.skills.composites import ParallelFs, Selector, Serial
from robot_tasks.skills.conditions import At, Not
from robot_tasks.skills.primitives import CoordinateAtLeast, CoordinateBelow, PositionDistance, SetGoalPose
from robot_tasks.skills.skill import ParameterKind, Skill, SkillDescription, SkillParameter

TIP: Final = "tool_tip"
"""Site of the scenes that skills move."""

_LEARNED: Final = ParameterKind.LEARNED
_REQUIRED: Final = ParameterKind.REQUIRED
_OPTIONAL: Final = ParameterKind.OPTIONAL


def pass_over_obstacle(
    first: Pose, second: Pose, goal: Pose, *, clear_height: float, passed_y: float, success_distance: float
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
            SkillParameter(name="first", kind=_LEARNED, value="pose", description="Way-point to rise to"),
            SkillParameter(name="second", kind=_LEARNED, value="pose", description="Way-point beyond the obstacle"),
            SkillParameter(name="clear_height", kind=_LEARNED, value="m", description="Height from which to cross"),
            SkillParameter(name="passed_y", kind=_LEARNED, value="m", description="World y below which to descend"),
            SkillParameter(name="goal", kind=_REQUIRED, value="pose", description="Where the tip is to arrive"),
            SkillParameter(name="success_distance", kind=_OPTIONAL, value="m", description="How near is near enough"),
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
