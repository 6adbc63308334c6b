"""Tests for contributions.py."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hypermap_lite.pareto import hypervolume, hypervolume_contributions


@pytest.mark.parametrize(
    ("Y", "expected"),
    [
        pytest.param([[1, 3], [2, 2], [3, 1]], [1, 1, 1], id="staircase"),
        pytest.param([[1, 3], [2, 2], [2, 2]], [1, 0, 0], id="equal points add nothing alone"),
        pytest.param([[1, 3], [3, 3]], [2, 0], id="dominated"),
        pytest.param([[1, 3], [0, 5]], [3, 0], id="outside"),
        pytest.param([[5, 5]], [0], id="none inside"),
        pytest.param([[1, 3], [np.nan, 0]], [3, 0], id="NaN"),
        pytest.param([[1, 2, 3]], [3 * 2 * 1], id="three objectives"),
    ],
)
def test_contributions_of_known_fronts(Y, expected):
    Y = np.array(Y, dtype=float)
    assert hypervolume_contributions(Y, np.full(Y.shape[1], 4.0)).tolist() == expected


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        pytest.param([3.0, 1.0, 2.0], [0, 1, 0], id="the best against the next"),
        pytest.param([1.0, 5.0], [3, 0], id="the best against the reference"),
        pytest.param([1.0, 1.0], [0, 0], id="two best"),
        pytest.param([4.0], [0], id="not better than the reference"),
    ],
)
def test_contribution_of_the_best_of_one_objective(values, expected):
    assert hypervolume_contributions(np.array(values)[:, None], np.array([4.0])).tolist() == expected


@given(arrays(float, st.tuples(st.integers(1, 8), st.integers(2, 3)), elements=st.integers(0, 6).map(float)))
def test_contribution_is_what_is_lost_without_the_point(Y):
    corner = np.full(Y.shape[1], 5.0)
    lost = [hypervolume(Y, corner) - hypervolume(np.delete(Y, i, axis=0), corner) for i in range(len(Y))]
    assert hypervolume_contributions(Y, corner) == pytest.approx(np.array(lost))
