"""Tests for view.py."""

import numpy as np
import pytest

from hypermap_lite.plotting import style
from hypermap_lite.plotting.view import MARGIN, View, robust_view

SQUARE = np.array([[0.0, 0.0], [1.0, 1.0]])
UNIT = View(low=np.zeros(2), high=np.ones(2))


def test_view_holds_all_important_points_with_a_margin():
    view = robust_view(SQUARE, np.empty((0, 2)))
    assert view.low.tolist() == [-MARGIN] * 2
    assert view.high.tolist() == [1 + MARGIN] * 2


def test_others_widen_the_view_up_to_the_range_of_the_core():
    view = robust_view(SQUARE, np.array([[2.0, 0.5], [-1.0, 0.5]]))
    assert view.contains(np.array([[2.0, 0.5], [-1.0, 0.5]])).all()


@pytest.mark.parametrize("outlier", [[2.1, 0.5], [0.5, -1e9], [1e9, 1e9]])
def test_outlier_is_left_out_in_both_objectives(outlier):
    view = robust_view(np.repeat(SQUARE, 5, axis=0), np.array([outlier]))
    assert view.high.tolist() == [1 + MARGIN] * 2
    assert not view.contains(np.array([outlier])).any()


def test_what_a_quarter_of_the_points_have_in_common_is_no_outlier():
    others = np.full((4, 2), [-1000.0, 0.5])
    assert robust_view(SQUARE, others).contains(others).all()


def test_points_without_range_get_a_view():
    view = robust_view(np.zeros((1, 2)), np.zeros((3, 2)))
    assert (view.low < 0).all()
    assert (view.high > 0).all()


@pytest.mark.parametrize(
    ("point", "shape"), [([-5, 0.5], "<"), ([5, 0.5], ">"), ([0.5, -5], "v"), ([0.5, 5], "^"), ([2, -9], "v")]
)
def test_points_outside_are_marked_at_the_border_they_lie_beyond(point, shape):
    with style.house_style():
        axes = style.new_figure(4, 3).subplots()
        UNIT.apply(axes)
        n = UNIT.draw_outside(axes, np.array([point, [0.5, 0.5]], dtype=float), "blue")
    (mark,) = [line for line in axes.lines if len(line.get_xdata())]
    assert n == 1
    assert mark.get_marker() == shape
    assert UNIT.contains(mark.get_xydata()).all()
