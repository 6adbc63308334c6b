"""Rewards: what a finished episode was worth, step by step.

Adding one: a file with a frozen dataclass, a line in the table below, a test with hand-computed numbers.
"""

from collections.abc import Mapping
from typing import Final

from robot_tasks.rewards.base import Reward, RewardTerm
from robot_tasks.rewards.box import Box
from robot_tasks.rewards.box_attraction import BoxAttraction
from robot_tasks.rewards.box_avoidance import BoxAvoidance
from robot_tasks.rewards.commanded_force import CommandedForce
from robot_tasks.rewards.fixed_success import FixedSuccess
from robot_tasks.rewards.goal_distance import GoalDistance
from robot_tasks.rewards.object_pose import ObjectOrientation, ObjectPosition
from robot_tasks.rewards.tracking_error import NegativeTrackingBell, TrackingError

REWARDS: Final[Mapping[str, type[Reward]]] = {
    "box_attraction": BoxAttraction,
    "box_avoidance": BoxAvoidance,
    "commanded_force": CommandedForce,
    "fixed_success": FixedSuccess,
    "goal_distance": GoalDistance,
    "negative_tracking_bell": NegativeTrackingBell,
    "object_orientation": ObjectOrientation,
    "object_position": ObjectPosition,
    "tracking_error": TrackingError,
}

__all__ = [
    "REWARDS",
    "Box",
    "BoxAttraction",
    "BoxAvoidance",
    "CommandedForce",
    "FixedSuccess",
    "GoalDistance",
    "NegativeTrackingBell",
    "ObjectOrientation",
    "ObjectPosition",
    "Reward",
    "RewardTerm",
    "TrackingError",
]
