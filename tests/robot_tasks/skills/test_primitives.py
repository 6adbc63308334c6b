"""Tests for primitives.py."""

import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.skills import (
    ApplyForce,
    ChangeStiffness,
    CoordinateAtLeast,
    CoordinateBelow,
    OverlayMotion,
    PositionDistance,
    SetGoalPose,
    Status,
)
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


def test_demands_are_made_at_every_tick_and_forgotten_between():
    here, overlay = context(), object()
    demands = ChangeStiffness((500.0, 500.0, 0.0, 50.0)), ApplyForce((0.0, 0.0, -3.0)), OverlayMotion(overlay)
    for _ in range(2):
        assert [demand.tick(here) for demand in demands] == [Status.RUNNING] * 3
        assert (here.stiffness, here.force) == ((500.0, 500.0, 0.0, 50.0), (0.0, 0.0, -3.0))
        assert here.overlay is overlay
        here.forget_demands()
        assert (here.stiffness, here.force, here.overlay) == ((400.0, 400.0, 400.0, 50.0), (0.0, 0.0, 0.0), None)


@pytest.mark.parametrize(
    ("leaf", "label"),
    [
        (SetGoalPose(Pose((1.0, 2.0, 0.5), TOOL_DOWN)), "SetGoalPose (1, 2, 0.5)"),
        (ChangeStiffness((500.0, 500.0, 0.0, 50.0)), "ChangeStiffness (500, 500, 0) N/m, 50 Nm/rad"),
        (ApplyForce((0.0, 0.0, -7.0)), "ApplyForce (0, 0, -7) N"),
        (OverlayMotion("spiral"), "OverlayMotion spiral"),
        (PositionDistance((0.0, 0.0, 1.0), threshold=0.05), "PositionDistance to (0, 0, 1) < 0.05 m"),
        (CoordinateBelow("y", 0.05), "CoordinateBelow y, 0.05 m"),
        (CoordinateAtLeast("z", 0.95), "CoordinateAtLeast z, 0.95 m"),
    ],
)
def test_labels_tell_what_a_leaf_does(leaf, label):
    assert leaf.label == label
    assert leaf.children == ()
