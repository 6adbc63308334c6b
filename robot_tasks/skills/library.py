"""The skills of the tasks, as trees built from their parameters."""

from __future__ import annotations

from robot_tasks.geometry import Pose
from robot_tasks.skills.behaviour import Behaviour
from robot_tasks.skills.composites import ParallelFs, Selector, Serial
from robot_tasks.skills.primitives import CoordinateAtLeast, CoordinateBelow, PositionDistance, SetGoalPose


def pass_over_obstacle(
    first: Pose, second: Pose, goal: Pose, *, clear_height: float, passed_y: float, success_distance: float
) -> Behaviour:
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
    Behaviour
        Succeeds near the goal and never fails.
    """
    return ParallelFs(
        Selector(
            Serial(CoordinateBelow("y", passed_y), SetGoalPose(goal)),
            Serial(CoordinateAtLeast("z", clear_height), SetGoalPose(second)),
            SetGoalPose(first),
        ),
        PositionDistance(goal.position, threshold=success_distance),
    )
