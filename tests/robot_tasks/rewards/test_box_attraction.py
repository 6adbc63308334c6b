"""Tests for box_attraction.py, against numbers worked out by hand."""

import numpy as np
import pytest

from robot_tasks.rewards import Box, BoxAttraction

HOLE = Box(low=(-0.601, -0.001, 0.6), high=(-0.599, 0.001, 0.699))
REWARD = BoxAttraction(box=HOLE, width=2.0, margin=0.006)


def test_the_reward_inside_is_finite_and_falls_with_the_distance(make_episode):
    rewards = REWARD(make_episode([(9.0, 9.0, 9.0), (-0.6, 0.0, 0.65), (-0.6, 0.0, 0.703), (-0.6, 0.0, 0.743)]))
    assert rewards == pytest.approx([1.0 / 0.012, 50.0, 10.0])


def test_the_weighted_reward_has_the_published_maximum_of_12_5_per_step(make_episode):
    assert 0.15 * REWARD(make_episode([(-0.6, 0.0, 0.65)] * 2)) == pytest.approx([12.5])


@pytest.mark.parametrize(
    ("follows", "reward"),
    [
        pytest.param("block", 1.0 / 0.012, id="the box moves with its body"),
        pytest.param(None, 1.0 / (2.0 * (0.004 + 0.006)), id="the box stays"),
    ],
)
def test_the_box_may_follow_a_shifted_body(make_episode, follows, reward):
    attraction = BoxAttraction(box=HOLE, width=2.0, margin=0.006, follows=follows)
    episode = make_episode(np.full((2, 3), (-0.595, 0.0, 0.65)), shifts={"block": (0.005, 0.0, 0.0)})
    assert attraction(episode) == pytest.approx([reward])
