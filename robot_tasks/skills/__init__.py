"""Behaviour trees: what the robot decides to do at every tick."""

from robot_tasks.skills.behaviour import Behaviour, Condition, SkillContext, Status, World
from robot_tasks.skills.composites import NoFail, ParallelFf, ParallelFs, Selector, SelectorStar, Serial, SerialStar
from robot_tasks.skills.conditions import At, Not, PointsDown, Relation, Within
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

__all__ = [
    "ApplyForce",
    "At",
    "Behaviour",
    "ChangeStiffness",
    "Condition",
    "CoordinateAtLeast",
    "CoordinateBelow",
    "NoFail",
    "Not",
    "OverlayMotion",
    "ParallelFf",
    "ParallelFs",
    "ParameterKind",
    "PointsDown",
    "PositionDistance",
    "Relation",
    "Selector",
    "SelectorStar",
    "Serial",
    "SerialStar",
    "SetGoalPose",
    "Skill",
    "SkillContext",
    "SkillDescription",
    "SkillParameter",
    "Status",
    "Within",
    "World",
]
