"""Tests for dominance.py."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hypermap_lite.pareto.dominance import non_dominated

# few distinct values, so that ties, duplicates and NaN rows are common
POINTS = st.integers(1, 5).flatmap(
    lambda m: arrays(float, st.tuples(st.integers(0, 12), st.just(m)), elements=st.sampled_from([0.0, 1, 2, 3, np.nan]))
)


def brute_force(Y):
    def dominates(a, b):
        return (a <= b).all() and (a < b).any()

    return np.array([not np.isnan(y).any() and not any(dominates(other, y) for other in Y) for y in Y], dtype=bool)


def test_front_of_a_staircase_with_two_dominated_points():
    Y = np.array([[1, 3], [2, 2], [3, 1], [3, 3], [2, 2.5]])
    assert non_dominated(Y).tolist() == [True, True, True, False, False]


def test_all_duplicates_of_a_front_point_stay():
    Y = np.array([[1, 2], [2, 1], [1, 2], [2, 2], [2, 2]])
    assert non_dominated(Y).tolist() == [True, True, True, False, False]


def test_weakly_dominated_point_is_not_on_the_front():
    assert non_dominated(np.array([[1.0, 1.0, 1.0], [1.0, 1.0, 2.0]])).tolist() == [True, False]


def test_one_objective_keeps_all_copies_of_the_minimum():
    assert non_dominated(np.array([[2.0], [1.0], [1.0]])).tolist() == [False, True, True]


def test_row_with_nan_is_not_on_the_front_and_dominates_nothing():
    Y = np.array([[np.nan, 0.0], [1.0, 1.0], [np.nan, np.nan]])
    assert non_dominated(Y).tolist() == [False, True, False]


def test_infinities_compare_as_numbers():
    Y = np.array([[np.inf, 0.0], [1.0, 1.0], [np.inf, 1.0], [-np.inf, 2.0]])
    assert non_dominated(Y).tolist() == [True, True, False, True]


@pytest.mark.parametrize("m", [1, 2, 3, 6])
def test_no_points_have_an_empty_front(m):
    front = non_dominated(np.empty((0, m)))
    assert front.shape == (0,)
    assert front.dtype == bool


@pytest.mark.parametrize("shape", [(3,), (2, 0), (2, 2, 2)], ids=str)
def test_wrong_shape_is_an_error_that_shows_it(shape):
    with pytest.raises(ValueError, match=r"shape \(n, m\) with m >= 1 objectives. Got Y.shape="):
        non_dominated(np.zeros(shape))


def test_input_is_left_alone():
    Y = np.array([[1.0, np.nan], [2.0, 1.0]])
    before = Y.copy()
    non_dominated(Y)
    np.testing.assert_array_equal(Y, before)


@given(POINTS)
def test_agrees_with_the_definition(Y):
    np.testing.assert_array_equal(non_dominated(Y), brute_force(Y))


@pytest.mark.parametrize("m", [2, 3, 4, 6])
def test_agrees_with_the_definition_on_many_points(m):
    Y = np.random.default_rng(m).integers(0, 6, (400, m)).astype(float)
    np.testing.assert_array_equal(non_dominated(Y), brute_force(Y))


@given(POINTS)
def test_front_of_the_front_is_the_front(Y):
    assert non_dominated(Y[non_dominated(Y)]).all()


@given(POINTS, st.randoms(use_true_random=False))
def test_order_does_not_matter(Y, random):
    order = random.sample(range(len(Y)), len(Y))
    np.testing.assert_array_equal(non_dominated(Y[order]), non_dominated(Y)[order])
