"""Tests for box.py, against numbers worked out by hand."""

import numpy as np
import pytest

from robot_tasks.rewards import Box

ENGINE = Box(low=(-0.71, 0.15, 0.6), high=(-0.33, 0.45, 0.9))


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


def test_distances_of_many_points_come_one_by_one():
    points = np.array([(-0.5, 0.3, 0.7), (-0.5, 0.3, 1.0), (-1.01, 0.05, 1.2)])
    assert ENGINE.distance(points) == pytest.approx([0.0, 0.1, np.sqrt(0.09 + 0.01 + 0.09)])


@pytest.mark.parametrize("high", [(1.0, 1.0, 1.0), (-1.0, 1.0, 2.0)])
def test_a_box_needs_an_extent(high):
    with pytest.raises(ValueError, match=r"every low must be below its high, got \(0.0, 0.0, 1.0\) and "):
        Box(low=(0.0, 0.0, 1.0), high=high)
