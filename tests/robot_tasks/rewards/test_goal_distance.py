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


@pytest.mark.parametrize(("distance", "published"), [(0.0, 22.89), (0.3, 17.28)])
def test_fifty_times_the_reward_has_the_published_size(make_episode, distance, published):
    tip = (-0.6 + distance, 0.0, 0.7)
    assert 50.0 * REWARD(make_episode([tip, tip])) == pytest.approx([published], abs=5e-3)


@pytest.mark.parametrize(
    ("follows", "squared_distance"),
    [
        pytest.param("block", 0.0, id="the goal moves with its body"),
        pytest.param(None, 0.25, id="the goal stays"),
        pytest.param("engine", 0.25, id="the goal moves with a body that stands in its place"),
    ],
)
def test_the_goal_may_follow_a_shifted_body(make_episode, follows, squared_distance):
    reward = GoalDistance(goal=(-0.6, 0.0, 0.7), width=0.4, offset=0.25, follows=follows)
    episode = make_episode([(-0.3, -0.4, 0.7)] * 2, shifts={"block": (0.3, -0.4, 0.0)})
    assert reward(episode) == pytest.approx([exp(-(squared_distance + 0.25) / 0.32)])
