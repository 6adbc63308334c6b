"""Tests for hypervolume.py."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.pareto.hypervolume import hypervolume, hypervolume_trace, infer_reference_point

VALUES = st.floats(-2, 2, width=32)
POINTS = st.integers(1, 4).flatmap(lambda m: arrays(float, st.tuples(st.integers(1, 8), st.just(m)), elements=VALUES))


@pytest.mark.parametrize("n", [2, 3, 10, 100])
def test_staircase_has_its_closed_form(n):
    steps = np.arange(n, dtype=float)
    Y = np.column_stack([steps, n - 1 - steps])
    assert hypervolume(Y, np.array([n, n])) == n * n - n * (n - 1) // 2


@pytest.mark.parametrize("m", [1, 2, 3, 4, 5])
def test_one_point_dominates_a_box(m):
    assert hypervolume(np.full((1, m), 1.0), np.full(m, 3.0)) == pytest.approx(2.0**m, rel=1e-14)


def test_union_of_three_slabs_by_inclusion_and_exclusion():
    # three boxes 1 x 2 x 2, pairwise overlaps 1 x 1 x 2, common part 1 x 1 x 1
    Y = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert hypervolume(Y, np.array([2.0, 2.0, 2.0])) == 3 * 4 - 3 * 2 + 1


def test_nested_box_adds_nothing():
    assert hypervolume(np.array([[0.0, 0, 0], [1, 1, 1]]), np.array([2.0, 3.0, 4.0])) == 24.0


def test_circular_front_tends_to_the_limit_of_dtlz2():
    angle = np.linspace(0, np.pi / 2, 20_001)
    Y = np.column_stack([np.cos(angle), np.sin(angle)])
    assert hypervolume(Y, np.array([1.1, 1.1])) == pytest.approx(1.21 - math.pi / 4, abs=1e-4)


def test_spherical_front_tends_to_the_limit_of_dtlz2():
    first, second = np.meshgrid(*[np.linspace(0, np.pi / 2, 61)] * 2)
    Y = np.stack([np.cos(first) * np.cos(second), np.cos(first) * np.sin(second), np.sin(first)], axis=-1)
    limit = 1.1**3 - math.pi / 6
    volume = hypervolume(Y.reshape(-1, 3), np.full(3, 1.1))
    assert limit - 0.04 < volume < limit


def test_points_outside_the_box_and_on_its_border_add_nothing():
    Y = np.array([[-10.0, 3.5], [1, 3], [3, 1]])
    assert hypervolume(Y, np.array([3.0, 3.0])) == 0.0


def test_rows_with_nan_add_nothing():
    assert hypervolume(np.array([[np.nan, 0.0], [1.0, 2.0]]), np.array([3.0, 3.0])) == 2.0


def test_empty_set_has_no_volume():
    assert hypervolume(np.empty((0, 2)), np.array([1.0, 1.0])) == 0.0


def test_reference_point_of_another_length_is_an_error():
    with pytest.raises(ValueError, match=r"`reference_point` to have shape \(2,\).*Got corner.shape=\(3,\)"):
        hypervolume(np.zeros((1, 2)), np.ones(3))


def test_reference_point_with_nan_is_an_error():
    with pytest.raises(ValueError, match=r"to be finite. Got \[1.0, nan\]"):
        hypervolume_trace(np.zeros((1, 2)), np.array([1.0, np.nan]))


@given(POINTS)
def test_adding_a_point_never_lowers_it(Y):
    reference_point = np.full(Y.shape[1], 1.5)
    assert hypervolume(Y, reference_point) >= hypervolume(Y[:-1], reference_point) * (1 - 1e-12)


@given(POINTS)
def test_dominated_points_do_not_count(Y):
    reference_point = np.full(Y.shape[1], 1.5)
    assert hypervolume(Y[non_dominated(Y)], reference_point) == pytest.approx(
        hypervolume(Y, reference_point), rel=1e-12
    )


@given(POINTS)
def test_trace_is_the_hypervolume_after_each_row(Y):
    reference_point = np.full(Y.shape[1], 1.5)
    expected = [hypervolume(Y[: i + 1], reference_point) for i in range(len(Y))]
    np.testing.assert_allclose(hypervolume_trace(Y, reference_point), expected, rtol=1e-12)


@given(POINTS)
def test_trace_never_falls(Y):
    assert (np.diff(hypervolume_trace(Y, np.full(Y.shape[1], 1.5))) >= 0).all()


def test_failed_evaluations_leave_the_trace_as_it_was():
    Y = np.array([[np.nan, np.nan], [1.0, 1.0], [np.nan, 0.0], [0.0, 0.0]])
    assert hypervolume_trace(Y, np.array([2.0, 2.0])).tolist() == [0.0, 1.0, 1.0, 4.0]


def test_trace_of_nothing_is_empty():
    assert hypervolume_trace(np.empty((0, 3)), np.ones(3)).shape == (0,)


def test_inferred_point_is_a_tenth_of_the_range_beyond_the_nadir_of_the_front():
    Y = np.array([[0.0, 10.0], [1.0, 0.0], [5.0, 50.0], [np.nan, 99.0]])
    np.testing.assert_allclose(infer_reference_point(Y), [1.1, 11.0])


@pytest.mark.parametrize(
    ("Y", "expected"),
    [
        pytest.param([[2.0, -5.0]], [2.2, -4.5], id="one point"),
        pytest.param([[2.0, -5.0], [2.0, -5.0]], [2.2, -4.5], id="duplicates"),
        pytest.param([[0.0, 0.0]], [0.1, 0.1], id="zero"),
        pytest.param([[0.0, 3.0], [1.0, 3.0]], [0.1, 3.3], id="one point dominates"),
        pytest.param([[0.0, 3.0, 7.0], [1.0, 2.0, 7.0]], [1.1, 3.1, 7.7], id="flat in one objective"),
    ],
)
def test_inferred_point_is_defined_for_degenerate_fronts(Y, expected):
    np.testing.assert_allclose(infer_reference_point(np.array(Y)), expected)


@given(POINTS)
def test_each_point_of_the_front_lies_inside_the_inferred_box(Y):
    assert (Y[non_dominated(Y)] < infer_reference_point(Y)).all()


def test_no_finite_row_to_infer_from_is_an_error():
    with pytest.raises(ValueError, match="at least one row of finite values"):
        infer_reference_point(np.array([[np.nan, 1.0]]))


def test_reference_point_of_the_largest_floats_is_finite():
    Y = np.array([[1e308, -1e308], [-1e308, 1e308]])
    np.testing.assert_allclose(infer_reference_point(Y), [1.2e308, 1.2e308])
    largest = np.finfo(float).max
    np.testing.assert_array_equal(infer_reference_point(np.array([[largest, 0.0], [0.0, largest]])), [largest, largest])


def test_volume_beyond_all_floats_is_infinite():
    assert hypervolume(np.array([[-1e308, -1e308]]), np.array([1.0, 1.0])) == np.inf
