"""Tests for primitives.py."""

import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.skills import CoordinateAtLeast, CoordinateBelow, PositionDistance, SetGoalPose, Status
from tests.robot_tasks.skills.scripted import context


def test_set_goal_pose_asks_and_keeps_running():
    pose, here = Pose((1.0, 2.0, 3.0), TOOL_DOWN), context()
    assert SetGoalPose(pose).tick(here) is Status.RUNNING
    assert here.goal is pose


@pytest.mark.parametrize(("x", "status"), [(0.0499, Status.SUCCESS), (0.05, Status.RUNNING), (1.0, Status.RUNNING)])
def test_position_distance_succeeds_strictly_within_its_threshold(x, status):
    assert PositionDistance((0.0, 0.0, 0.0), threshold=0.05).tick(context((x, 0.0, 0.0))) is status


@pytest.mark.parametrize(("y", "below"), [(0.49, True), (0.5, False), (0.51, False)])
def test_coordinate_conditions_are_opposites_and_the_limit_is_not_below_itself(y, below):
    tip = context((9.0, y, 9.0))
    assert (CoordinateBelow("y", 0.5).tick(tip) is Status.SUCCESS) == below
    assert (CoordinateAtLeast("y", 0.5).tick(tip) is Status.FAILURE) == below


def test_coordinate_conditions_look_at_their_own_axis():
    tip = context((1.0, 2.0, 3.0))
    assert [CoordinateBelow(axis, 2.5).tick(tip).name for axis in "xyz"] == ["SUCCESS", "SUCCESS", "FAILURE"]
