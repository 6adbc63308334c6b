"""Tests for geometry.py."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_tasks.geometry import TOOL_DOWN, Pose, Slerp, distance, moved, rotation_angle, turned

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def about_z(angle: float) -> tuple[float, float, float, float]:
    return cos(angle / 2), 0.0, 0.0, sin(angle / 2)


def test_distance_of_a_pythagorean_box():
    assert distance((0.0, 0.0, 0.0), (2.0, 3.0, 6.0)) == 7.0


@pytest.mark.parametrize("angle", [0.0, 0.3, pi / 2, pi])
def test_rotation_angle_about_one_axis(angle):
    assert rotation_angle(IDENTITY, about_z(angle)) == pytest.approx(angle, abs=1e-12)


def test_a_quaternion_and_its_negative_are_the_same_orientation():
    negative = tuple(-number for number in about_z(0.4))
    assert rotation_angle(about_z(0.4), negative) == 0.0
    assert Slerp(about_z(0.4), negative).at(0.5) == pytest.approx(about_z(0.4))


@given(st.floats(-3.0, 3.0), st.floats(0.0, 1.0))
def test_slerp_about_one_axis_turns_in_proportion(angle, fraction):
    assert Slerp(IDENTITY, about_z(angle)).at(fraction) == pytest.approx(about_z(angle * fraction), abs=1e-7)


def test_slerp_stays_a_unit_quaternion():
    slerp = Slerp((0.5, 0.5, 0.5, 0.5), (0.0, 0.6, 0.0, 0.8))
    assert [np.linalg.norm(slerp.at(f)) for f in (0.0, 0.3, 1.0)] == pytest.approx([1.0, 1.0, 1.0])


def test_turning_a_pose_keeps_its_position_and_turns_it_about_the_vertical():
    pose = Pose((1.0, 2.0, 3.0), TOOL_DOWN)
    assert turned(pose, pi / 2) == Pose((1.0, 2.0, 3.0), pytest.approx((0.0, cos(pi / 4), sin(pi / 4), 0.0)))
    assert turned(Pose((0.0, 0.0, 0.0), about_z(0.1)), 0.2).quaternion == pytest.approx(about_z(0.3))


def test_moving_a_pose_adds_to_its_position_and_keeps_its_orientation():
    assert moved(Pose((1.0, 2.0, 3.0), TOOL_DOWN), (0.5, 0.0, -1.0)) == Pose((1.5, 2.0, 2.0), TOOL_DOWN)
