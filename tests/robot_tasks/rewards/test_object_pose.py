"""Tests for object_pose.py, against numbers worked out by hand."""

from math import cos, exp, pi, sin

import numpy as np
import pytest

from robot_tasks.geometry import TOOL_DOWN
from robot_tasks.rewards import ObjectOrientation, ObjectPosition

GOAL = (-0.375, 0.075, 0.67)
POSITION = ObjectPosition(goal=GOAL, width=0.4, offset=0.25)
ORIENTATION = ObjectOrientation(goal=TOOL_DOWN, width=0.4, offset=0.25)


def at(*positions):
    return np.array([(0.0,) * 7, *((*position, *TOOL_DOWN) for position in positions)])


def turned(*angles):
    """Poses of something upside down that is turned about the vertical by angles in [rad]."""
    return np.array([(0.0,) * 7, *((*GOAL, 0.0, cos(angle / 2), sin(angle / 2), 0.0) for angle in angles)])


def test_at_the_goal_only_the_offset_remains(make_episode):
    episode = make_episode(np.zeros((2, 3)), object_poses=at(GOAL))
    assert POSITION(episode) == pytest.approx([0.4578], abs=5e-5)
    assert ORIENTATION(episode) == pytest.approx([0.4578], abs=5e-5)


@pytest.mark.parametrize(("weight", "reward", "largest"), [(6.0, POSITION, 2.747), (2.0, ORIENTATION, 0.916)])
def test_weighted_rewards_at_the_goal_have_the_published_size(make_episode, weight, reward, largest):
    assert weight * reward(make_episode(np.zeros((2, 3)), object_poses=at(GOAL)))[0] == pytest.approx(largest, abs=5e-4)


def test_the_distance_enters_unsquared(make_episode):
    poses = at((-0.375, 0.375, 0.67), (-0.375, 0.075, 0.27), (-0.075, 0.475, 0.67))
    rewards = POSITION(make_episode(np.zeros((4, 3)), object_poses=poses))
    assert rewards == pytest.approx([exp(-0.55 / 0.32), exp(-0.65 / 0.32), exp(-0.75 / 0.32)])


def test_the_angle_enters_unsquared_and_without_its_sign(make_episode):
    rewards = ORIENTATION(make_episode(np.zeros((4, 3)), object_poses=turned(0.5, -0.5, pi)))
    assert rewards == pytest.approx([exp(-0.75 / 0.32), exp(-0.75 / 0.32), exp(-(pi + 0.25) / 0.32)])


def test_a_quaternion_and_its_negative_are_worth_the_same(make_episode):
    poses = turned(0.5, 0.5)
    poses[2, 3:] *= -1.0
    first, second = ORIENTATION(make_episode(np.zeros((3, 3)), object_poses=poses))
    assert first == second


def test_the_position_of_the_object_is_no_matter_to_its_orientation_and_the_reverse(make_episode):
    moved, rotated = at((0.0, 0.0, 0.0)), turned(1.0)
    assert ORIENTATION(make_episode(np.zeros((2, 3)), object_poses=moved)) == pytest.approx([0.4578], abs=5e-5)
    assert POSITION(make_episode(np.zeros((2, 3)), object_poses=rotated)) == pytest.approx([0.4578], abs=5e-5)


@pytest.mark.parametrize(
    ("follows", "distance"),
    [
        pytest.param("block", 0.0, id="the goal moves with its body"),
        pytest.param(None, 0.005, id="the goal stays"),
    ],
)
def test_the_goal_may_follow_a_shifted_body(make_episode, follows, distance):
    reward = ObjectPosition(goal=GOAL, width=0.4, offset=0.25, follows=follows)
    poses = at((-0.371, 0.072, 0.67))
    episode = make_episode(np.zeros((2, 3)), object_poses=poses, shifts={"block": (0.004, -0.003, 0.0)})
    assert reward(episode) == pytest.approx([exp(-(distance + 0.25) / 0.32)])
