"""Tests for trajectory.py."""

from math import cos, pi, sin

import numpy as np
import pytest

from robot_tasks.geometry import Pose, rotation_angle
from robot_tasks.motion import Trajectory

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def about_z(angle: float) -> tuple[float, float, float, float]:
    return cos(angle / 2), 0.0, 0.0, sin(angle / 2)


def test_a_translation_runs_straight_along_its_profile():
    trajectory = Trajectory(Pose((1.0, 0.0, 0.0), IDENTITY), Pose((1.0, 0.6, 0.8), IDENTITY))
    assert trajectory.duration == pytest.approx(6.0)
    assert trajectory.at(2 / 3).position == pytest.approx((1.0, 0.6 / 15, 0.8 / 15))
    assert trajectory.at(2 / 3).quaternion == pytest.approx(IDENTITY)


def test_a_rotation_runs_along_its_own_profile():
    trajectory = Trajectory(Pose((0.0, 0.0, 0.0), IDENTITY), Pose((0.0, 0.0, 0.0), about_z(pi / 2)))
    ramps = 0.25 / 1.0 + 0.25 / 0.7
    assert trajectory.duration == pytest.approx(1.0 + (pi / 2 - ramps) / 0.5 + 0.5 / 0.35)
    assert rotation_angle(IDENTITY, trajectory.at(1.0).quaternion) == pytest.approx(0.25)


def test_the_shorter_motion_is_stretched_to_arrive_with_the_longer():
    trajectory = Trajectory(Pose((0.0, 0.0, 0.0), IDENTITY), Pose((0.0, 0.0, 1.0), about_z(0.1)))
    assert trajectory.duration == pytest.approx(6.0)
    just_before = trajectory.at(5.9)
    assert rotation_angle(just_before.quaternion, about_z(0.1)) > 0.0
    assert 1.0 - just_before.position[2] == pytest.approx(0.5 * 0.15 * 0.1**2)


def test_the_trajectory_starts_at_the_start_and_stays_at_the_goal():
    start, goal = Pose((0.1, 0.2, 0.3), about_z(0.2)), Pose((0.4, 0.2, 0.3), about_z(-0.2))
    trajectory = Trajectory(start, goal)
    assert np.concatenate(trajectory.at(0.0)) == pytest.approx(np.concatenate(start))
    assert trajectory.at(trajectory.duration) is goal
    assert trajectory.at(100.0) is goal


def test_a_goal_equal_to_the_start_is_reached_at_once():
    pose = Pose((0.1, 0.2, 0.3), IDENTITY)
    assert Trajectory(pose, pose).duration == 0.0
    assert Trajectory(pose, pose).at(0.0) is pose
