"""Behaviour trees: what the robot decides to do at every tick."""

from robot_tasks.skills.behaviour import Behaviour, Condition, SkillContext, Status
from robot_tasks.skills.composites import NoFail, ParallelFf, ParallelFs, Selector, SelectorStar, Serial, SerialStar
from robot_tasks.skills.primitives import CoordinateAtLeast, CoordinateBelow, PositionDistance, SetGoalPose

__all__ = [
    "Behaviour",
    "Condition",
    "CoordinateAtLeast",
    "CoordinateBelow",
    "NoFail",
    "ParallelFf",
    "ParallelFs",
    "PositionDistance",
    "Selector",
    "SelectorStar",
    "Serial",
    "SerialStar",
    "SetGoalPose",
    "SkillContext",
    "Status",
]
