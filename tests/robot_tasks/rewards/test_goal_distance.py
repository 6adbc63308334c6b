"""Tests for goal_distance.py, against numbers worked out by hand."""

from math import exp

import pytest

from robot_tasks.rewards import GoalDistance

REWARD = GoalDistance(goal=(-0.6, 0.0, 0.7), width=0.4, offset=0.25)


def test_at_the_goal_only_the_offset_remains(make_episode):
    assert REWARD(make_episode([(0.0, 0.0, 0.0), (-0.6, 0.0, 0.7)])) == pytest.approx([0.4578], abs=5e-5)


def test_the_distance_enters_squared(make_episode):
    rewards = REWARD(make_episode([(0.0, 0.0, 0.0), (-0.6, 0.3, 0.7), (-0.6, 0.0, 0.3)]))
    assert rewards == pytest.approx([exp(-0.34 / 0.32), exp(-0.41 / 0.32)])


def test_a_step_is_worth_where_it_ends(make_episode):
    assert len(REWARD(make_episode([(-0.6, 0.0, 0.7)] * 3))) == 2
