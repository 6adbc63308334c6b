"""Obstacle avoidance: carry the tool over an engine to a block behind it, high enough, but no higher than needed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from robot_tasks.geometry import TOOL_DOWN, Pose, Vector
from robot_tasks.randomization import BodyShift, Randomization
from robot_tasks.rewards import Box, BoxAvoidance, FixedSuccess, GoalDistance, RewardTerm
from robot_tasks.skills import Behaviour
from robot_tasks.skills.library import pass_over_obstacle
from robot_tasks.tasks.base import Parameter, Task

GOAL: Final[Vector] = (-0.6, 0.0, 0.7)
"""Position of the tip in [m] at the end: at the mouth of the block's hole."""
WAY_POINT_X: Final = -0.5
"""World x of both way-points in [m]."""
SUCCESS_DISTANCE: Final = 0.05
"""Distance of the tip to the goal in [m] that counts as arrived."""

TABLE: Final = Box(low=(-0.93, -0.7, 0.0), high=(-0.13, 0.5, 0.6))
ENGINE: Final = Box(low=(-0.71, 0.15, 0.6), high=(-0.33, 0.45, 0.9))
"""Boxes of the rewards at their nominal places, in [m]."""

STARTS: Final = {
    "s0": (0.47, 1.54, -0.30, -0.84, 1.48, 1.34, -1.28),
    "s1": (0.43, 1.65, -0.32, -0.56, 1.46, 1.37, -1.11),
    "s2": (0.44, 1.58, -0.30, -0.90, 1.49, 1.34, -1.38),
    "s3": (0.49, 1.45, -0.28, -1.10, 1.50, 1.32, -1.45),
    "s4": (0.48, 1.52, -0.30, -0.74, 1.46, 1.35, -1.15),
}
"""Joint angles in [rad] with the tool straight down, on the far side of the engine."""


def build_tree(parameters: Mapping[str, float]) -> Behaviour:
    """Build the skill from its six parameters."""
    return pass_over_obstacle(
        Pose((WAY_POINT_X, parameters["mp1_position_y"], parameters["mp1_position_z"]), TOOL_DOWN),
        Pose((WAY_POINT_X, parameters["mp2_position_y"], parameters["mp2_position_z"]), TOOL_DOWN),
        Pose(GOAL, TOOL_DOWN),
        clear_height=parameters["mp2_threshold"],
        passed_y=parameters["mp3_threshold"],
        success_distance=SUCCESS_DISTANCE,
    )


def _length(name: str, low: float, high: float, description: str) -> Parameter:
    return Parameter(name=name, low=low, high=high, unit="m", description=description)


def _task(*, follows: str | None) -> Task:
    return Task(
        name="obstacle_avoidance",
        description="Carry the tool over an engine to a block behind it.",
        scene="obstacle_avoidance.xml",
        duration=12.0,
        parameters=(
            _length("mp1_position_y", -0.5, 1.5, "World y of the first way-point"),
            _length("mp1_position_z", 0.5, 1.5, "Height of the first way-point"),
            _length("mp2_position_y", -0.5, 1.5, "World y of the second way-point"),
            _length("mp2_position_z", 0.5, 1.5, "Height of the second way-point"),
            _length("mp2_threshold", 0.5, 1.5, "Height of the tip from which it heads for the second way-point"),
            _length("mp3_threshold", -0.5, 1.5, "World y of the tip below which it heads for the goal"),
        ),
        build_tree=build_tree,
        objectives={
            "performance": (
                RewardTerm(name="success_bonus", reward=FixedSuccess(value=8.0)),
                RewardTerm(name="goal_distance", reward=GoalDistance(goal=GOAL, width=0.4, offset=0.25), weight=50.0),
            ),
            "safety": (
                RewardTerm(name="table_avoidance", reward=BoxAvoidance(box=TABLE, width=7.0, margin=0.03), weight=0.15),
                RewardTerm(
                    name="engine_avoidance",
                    reward=BoxAvoidance(box=ENGINE, width=7.0, margin=0.03, follows=follows),
                    weight=1.5,
                ),
            ),
        },
        randomization=Randomization(
            starts=STARTS,
            shifts=(BodyShift(bodies=("engine",), sigma=0.02), BodyShift(bodies=("block",), sigma=0.007)),
        ),
        obstacle="engine",
    )


OBSTACLE_AVOIDANCE: Final = _task(follows="engine")
"""The paper's task: the distance to the engine is that to the engine where it stands."""
OBSTACLE_AVOIDANCE_PUBLISHED: Final = _task(follows=None)
"""The published code's: the distance is that to the engine's nominal place."""
