"""Tests for box_avoidance.py, against numbers worked out by hand."""

import numpy as np
import pytest

from robot_tasks.rewards import Box, BoxAvoidance

ENGINE = Box(low=(-0.71, 0.15, 0.6), high=(-0.33, 0.45, 0.9))
REWARD = BoxAvoidance(box=ENGINE, width=7.0, margin=0.03)


def test_the_charge_inside_is_finite_and_falls_with_the_square_of_the_distance(make_episode):
    rewards = REWARD(make_episode([(9.0, 9.0, 9.0), (-0.5, 0.3, 0.7), (-0.5, 0.3, 1.0)]))
    assert rewards == pytest.approx([-158.73, -1.0 / (7.0 * 0.13**2)], abs=5e-3)


@pytest.mark.parametrize(("weight", "charge"), [(1.5, -238.1), (0.15, -23.81)])
def test_weighted_charges_inside_have_the_published_size(make_episode, weight, charge):
    assert weight * REWARD(make_episode([(0.0, 0.0, 0.0), (-0.5, 0.3, 0.7)]))[0] == pytest.approx(charge, abs=5e-3)


@pytest.mark.parametrize(
    ("follows", "distance"),
    [
        pytest.param("engine", 0.1, id="the box moves with its body"),
        pytest.param(None, 0.12, id="the box stays"),
        pytest.param("block", 0.12, id="the box moves with a body that stands in its place"),
    ],
)
def test_the_box_may_follow_a_shifted_body(make_episode, follows, distance):
    reward = BoxAvoidance(box=ENGINE, width=7.0, margin=0.03, follows=follows)
    episode = make_episode(np.full((2, 3), (-0.21, 0.3, 0.7)), shifts={"engine": (0.02, -0.02, 0.0)})
    assert reward(episode) == pytest.approx([-1.0 / (7.0 * (distance + 0.03) ** 2)])
