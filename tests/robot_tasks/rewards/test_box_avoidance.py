"""Tests for box_avoidance.py, against numbers worked out by hand."""

import numpy as np
import pytest

from robot_tasks.rewards import Box, BoxAvoidance

ENGINE = Box(low=(-0.71, 0.15, 0.6), high=(-0.33, 0.45, 0.9))
REWARD = BoxAvoidance(box=ENGINE, width=7.0, margin=0.03)


@pytest.mark.parametrize(
    ("point", "distance"),
    [
        pytest.param((-0.5, 0.3, 0.7), 0.0, id="inside"),
        pytest.param((-0.5, 0.3, 0.9), 0.0, id="on the top"),
        pytest.param((-0.5, 0.3, 1.0), 0.1, id="over a face"),
        pytest.param((-0.5, 0.48, 0.94), 0.05, id="off an edge"),
        pytest.param((-0.31, 0.46, 0.92), 0.03, id="off a corner"),
        pytest.param((-0.5, 0.05, 0.7), 0.1, id="on the lower side"),
    ],
)
def test_distance_of_a_point_to_a_box(point, distance):
    assert ENGINE.distance(np.array([point])) == pytest.approx([distance])


def test_a_box_needs_an_extent():
    with pytest.raises(ValueError, match="every low must be below its high"):
        Box(low=(0.0, 0.0, 1.0), high=(1.0, 1.0, 1.0))


def test_the_charge_inside_is_finite_and_falls_with_the_square_of_the_distance(make_episode):
    rewards = REWARD(make_episode([(9.0, 9.0, 9.0), (-0.5, 0.3, 0.7), (-0.5, 0.3, 1.0)]))
    assert rewards == pytest.approx([-158.73, -1.0 / (7.0 * 0.13**2)], abs=5e-3)


@pytest.mark.parametrize(("weight", "charge"), [(1.5, -238.1), (0.15, -23.81)])
def test_weighted_charges_inside_have_the_published_size(make_episode, weight, charge):
    assert weight * REWARD(make_episode([(0.0, 0.0, 0.0), (-0.5, 0.3, 0.7)]))[0] == pytest.approx(charge, abs=5e-3)
