"""Tests for generator.py."""

from dataclasses import dataclass

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


@dataclass(frozen=True)
class Drift:
    """An overlay that moves along x at a speed."""

    speed: float

    @property
    def is_still(self):
        return self.speed == 0.0

    def offset(self, time):
        return self.speed * time, 0.0, 0.0


def test_an_overlay_is_added_to_the_reference_from_the_time_it_began():
    generator = MotionGenerator(START)
    generator.set_overlay(Drift(0.1), 2.0)
    assert generator.reference(2.0).position == pytest.approx((0.0, 0.0, 1.0))
    assert generator.reference(3.0).position == pytest.approx((0.1, 0.0, 1.0))
    assert not generator.is_finished(3.0)


def test_an_equal_overlay_goes_on_and_another_starts_afresh():
    generator = MotionGenerator(START)
    generator.set_overlay(Drift(0.1), 0.0)
    generator.set_overlay(Drift(0.1), 1.0)
    assert generator.reference(2.0).position[0] == pytest.approx(0.2)
    generator.set_overlay(Drift(0.2), 2.0)
    assert generator.reference(3.0).position[0] == pytest.approx(0.2)


def test_the_offset_of_an_overlay_that_ended_fades_at_5_centimetres_per_second():
    generator = MotionGenerator(START)
    generator.set_overlay(Drift(0.1), 0.0)
    generator.set_overlay(None, 1.0)
    assert [generator.reference(t).position[0] for t in (1.0, 2.0, 2.9)] == pytest.approx([0.1, 0.05, 0.005])
    assert not generator.is_finished(2.9)
    assert generator.reference(3.1).position == (0.0, 0.0, 1.0)
    assert generator.is_finished(3.1)


def test_an_overlay_without_motion_does_not_keep_the_reference_from_standing_still():
    generator = MotionGenerator(START)
    generator.set_overlay(Drift(0.0), 0.0)
    assert generator.is_finished(0.0)
