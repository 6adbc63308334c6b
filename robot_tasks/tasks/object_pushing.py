"""Object pushing: push a prism over a table into the corner between a block and a fixture, along one straight line."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, cos, sin
from typing import Final

from robot_tasks.geometry import TOOL_DOWN, Pose, Quaternion, Vector
from robot_tasks.randomization import BodyShift, ObjectPlacement, Randomization
from robot_tasks.rewards import (
    GoalDistance,
    NegativeTrackingBell,
    ObjectOrientation,
    ObjectPosition,
    Reward,
    RewardTerm,
    TrackingError,
)
from robot_tasks.skills import Behaviour
from robot_tasks.skills.conditions import At
from robot_tasks.skills.library import OBJECT_ANGLE_TOLERANCE, OBJECT_TOLERANCE, PUSH_STIFFNESS, push_object
from robot_tasks.tasks.base import Parameter, Task

OBJECT_FRAME: Final[Vector] = (-0.357, 0.484, 0.61)
"""What the start of a push is measured from, in [m]: the prism's centre of mass at first, 10 mm over the table."""
GOAL_FRAME: Final[Vector] = (-0.525, 0.15, 0.6)
"""What the end of the push is measured from, in [m]: where the middle of the prism's hypotenuse is to arrive."""
TOOL_ALONG_HYPOTENUSE: Final[Quaternion] = (0.0, cos(0.5 * atan2(1, 2)), -sin(0.5 * atan2(1, 2)), 0.0)
"""The tool straight down, one of its sides along the hypotenuse of a prism that has arrived."""
TIP_GOAL: Final[Vector] = (-0.425, 0.1, 0.6)
"""Position in [m] that the reward pulls the tip to."""
ARRIVAL_DISTANCE: Final = 0.05
"""Distance of the tip to a goal in [m] that counts as arrived."""

PRISM_YAW: Final = 0.4625122
"""Angle in [rad] by which the prism is turned from its goal at the start."""
PRISM_START: Final = Pose((-0.2, 0.35, 0.67), (0.0, cos(0.5 * PRISM_YAW), -sin(0.5 * PRISM_YAW), 0.0))
"""Pose of the prism at the start: upside down, so that its frame, at a corner, is on top."""
PRISM_GOAL: Final[Vector] = (-0.375, 0.075, 0.67)
"""Position of the prism's frame in [m] when its right angle is in the corner."""
PUBLISHED_PRISM_GOAL: Final[Vector] = (-0.375, 0.075, 0.65)
"""The same in the published code: 20 mm below where the prism can lie."""

STARTS: Final = {
    "s0": (0.33, 0.89, -0.16, -1.39, 1.19, 1.39, -1.23),
    "s1": (0.29, 0.85, -0.14, -1.87, 1.25, 1.25, -1.66),
    "s2": (0.31, 1.15, -0.08, -1.63, 1.34, 1.17, -1.71),
    "s3": (0.27, 1.34, -0.13, -1.47, 1.34, 1.23, -1.31),
}
"""Joint angles in [rad] with the tool straight down, 0.14 to 0.27 m above the prism."""


def build_tree(parameters: Mapping[str, float]) -> Behaviour:
    """Build the skill from its four parameters."""
    return push_object(
        _beside(OBJECT_FRAME, parameters["offset_x_start"], parameters["offset_y_start"]),
        _beside(GOAL_FRAME, parameters["offset_x_goal"], parameters["offset_y_goal"]),
        thing="prism",
        goal_site="prism_goal",
        arrival_distance=ARRIVAL_DISTANCE,
    )


def _beside(frame: Vector, dx: float, dy: float) -> Pose:
    x, y, z = frame
    return Pose((x + dx, y + dy, z), TOOL_ALONG_HYPOTENUSE)


def _offset(name: str, description: str) -> Parameter:
    return Parameter(name=name, low=-0.3, high=0.3, unit="m", description=description)


def _task(*, prism_goal: Vector, force: RewardTerm, placement: ObjectPlacement, follows: str | None) -> Task:
    return Task(
        name="object_pushing",
        description="Push a prism into the corner between a block and a fixture.",
        scene="object_pushing.xml",
        duration=12.0,
        parameters=(
            _offset("offset_x_start", "World x of the start of the push from the prism's centre of mass"),
            _offset("offset_y_start", "World y of the start of the push from the prism's centre of mass"),
            _offset("offset_x_goal", "World x of the end of the push from the goal frame"),
            _offset("offset_y_goal", "World y of the end of the push from the goal frame"),
        ),
        build_tree=build_tree,
        objectives={
            "object_push": (
                RewardTerm(
                    name="tip_distance", reward=GoalDistance(goal=TIP_GOAL, width=0.4, offset=0.25, follows=follows)
                ),
                RewardTerm(
                    name="object_position",
                    reward=ObjectPosition(goal=prism_goal, width=0.4, offset=0.25, follows=follows),
                    weight=6.0,
                ),
                RewardTerm(
                    name="object_orientation",
                    reward=ObjectOrientation(goal=TOOL_DOWN, width=0.4, offset=0.25),
                    weight=2.0,
                ),
            ),
            "force": (force,),
        },
        randomization=Randomization(
            starts=STARTS, shifts=(BodyShift(bodies=("block", "fixture"), sigma=0.007),), objects=(placement,)
        ),
        object_body="prism",
        final_condition=At(
            thing="prism",
            place="prism_goal",
            place_name="prism_goal",
            distance=OBJECT_TOLERANCE,
            angle=OBJECT_ANGLE_TOLERANCE,
        ),
    )


def _placement(sigma: float, sigma_yaw: float) -> ObjectPlacement:
    return ObjectPlacement(body="prism", pose=PRISM_START, sigma=sigma, sigma_yaw=sigma_yaw)


def _force(reward: Reward, weight: float) -> RewardTerm:
    return RewardTerm(name="tracking_force", reward=reward, weight=weight)


OBJECT_PUSHING: Final = _task(
    prism_goal=PRISM_GOAL,
    force=_force(TrackingError(), PUSH_STIFFNESS[0]),
    placement=_placement(0.007, 0.01),
    follows="block",
)
"""The paper's task: force is charged, and rewards know where the corner is."""
OBJECT_PUSHING_PUBLISHED: Final = _task(
    prism_goal=PUBLISHED_PRISM_GOAL,
    force=_force(NegativeTrackingBell(width=0.4, offset=0.25), 1.0),
    placement=_placement(0.0, 0.0),
    follows=None,
)
"""The published code's: a tip far from its reference is rewarded, the prism always begins in its place, and rewards are
computed for a corner in its nominal place and a prism 20 mm lower."""
