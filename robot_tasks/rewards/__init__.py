"""Rewards: what a finished episode was worth, step by step.

Adding one: a file with a frozen dataclass, a line in the table below, a test with hand-computed numbers.
"""

from collections.abc import Mapping
from typing import Final

from robot_tasks.rewards.base import Reward, RewardTerm
from robot_tasks.rewards.box_avoidance import Box, BoxAvoidance
from robot_tasks.rewards.fixed_success import FixedSuccess
from robot_tasks.rewards.goal_distance import GoalDistance

REWARDS: Final[Mapping[str, type[Reward]]] = {
    "box_avoidance": BoxAvoidance,
    "fixed_success": FixedSuccess,
    "goal_distance": GoalDistance,
}

__all__ = ["REWARDS", "Box", "BoxAvoidance", "FixedSuccess", "GoalDistance", "Reward", "RewardTerm"]
