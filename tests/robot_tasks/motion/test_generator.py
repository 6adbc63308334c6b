"""Tests for generator.py."""

import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.motion import MotionGenerator

START = Pose((0.0, 0.0, 1.0), TOOL_DOWN)


def test_without_a_goal_the_first_pose_is_held():
    generator = MotionGenerator(START)
    assert generator.reference(3.0) is START
    assert generator.is_finished(0.0)


def test_a_goal_is_approached_from_the_time_it_was_set():
    generator = MotionGenerator(START)
    generator.move_to(Pose((1.0, 0.0, 1.0), TOOL_DOWN), measured=START, time=2.0)
    assert generator.reference(2.0).position == pytest.approx((0.0, 0.0, 1.0))
    assert generator.reference(2.0 + 2 / 3).position == pytest.approx((1 / 15, 0.0, 1.0))
    assert not generator.is_finished(7.99)
    assert generator.is_finished(8.01)


def test_a_new_goal_starts_from_the_measured_pose_and_from_rest():
    generator = MotionGenerator(START)
    generator.move_to(Pose((1.0, 0.0, 1.0), TOOL_DOWN), measured=START, time=0.0)
    lagging = Pose((0.3, 0.01, 1.0), TOOL_DOWN)
    generator.move_to(Pose((0.3, 1.01, 1.0), TOOL_DOWN), measured=lagging, time=3.0)
    assert generator.reference(3.0).position == pytest.approx(lagging.position)
    assert generator.reference(3.1).position == pytest.approx((0.3, 0.01 + 0.5 * 0.3 * 0.1**2, 1.0))
    assert generator.goal.position == (0.3, 1.01, 1.0)
