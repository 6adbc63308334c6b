"""Tests for library.py."""

import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.skills import Status
from robot_tasks.skills.library import pass_over_obstacle
from tests.robot_tasks.skills.scripted import context

FIRST = Pose((-0.5, 0.7, 1.1), TOOL_DOWN)
SECOND = Pose((-0.5, 0.0, 1.0), TOOL_DOWN)
GOAL = Pose((-0.6, 0.0, 0.7), TOOL_DOWN)


@pytest.fixture
def tree():
    return pass_over_obstacle(FIRST, SECOND, GOAL, clear_height=0.95, passed_y=0.05, success_distance=0.05)


@pytest.mark.parametrize(
    ("tip", "goal"),
    [
        pytest.param((-0.5, 0.6, 0.75), FIRST, id="low and before the obstacle: rise"),
        pytest.param((-0.5, 0.6, 0.95), SECOND, id="high enough: cross"),
        pytest.param((-0.5, 0.04, 1.0), GOAL, id="past the obstacle: descend"),
        pytest.param((-0.5, 0.04, 0.75), GOAL, id="past the obstacle and low: descend all the same"),
    ],
)
def test_the_position_of_the_tip_chooses_the_goal(tree, tip, goal):
    here = context(tip)
    assert tree.tick(here) is Status.RUNNING
    assert here.goal is goal


def test_the_choice_follows_the_tip_back_and_forth(tree):
    here = context((-0.5, 0.6, 0.9))
    goals = []
    for z in (0.9, 1.0, 0.9):
        here.tip = (-0.5, 0.6, z)
        here.world["tool_tip"] = Pose(here.tip, TOOL_DOWN)
        tree.tick(here)
        goals.append(here.goal)
    assert goals == [FIRST, SECOND, FIRST]


def test_the_skill_succeeds_near_the_goal(tree):
    assert tree.tick(context((-0.5, 0.6, 0.75))) is Status.RUNNING
    assert tree.tick(context((-0.6, 0.0, 0.749))) is Status.SUCCESS


def test_the_skill_refuses_to_start_at_its_goal(tree):
    assert tree.tick(context((-0.6, 0.0, 0.749))) is Status.FAILURE
    assert str(tree.violated) == "not at(tool_tip, goal) within 0.05 m"
