"""Tests for traces.py."""

import numpy as np
import pytest

from hypermap_lite.plotting import style
from hypermap_lite.plotting.runs import load_runs
from hypermap_lite.plotting.traces import draw_trace, mean_and_error, show_evaluations, trace_legend
from tests.plotting.run_folders import write_run


@pytest.fixture
def axes():
    with style.house_style():
        yield style.new_figure(4, 3).subplots()


def test_mean_and_standard_error_of_two_repetitions():
    mean, error = mean_and_error([np.array([1.0, 2.0]), np.array([3.0, 6.0])])
    assert mean.tolist() == [2.0, 4.0]
    np.testing.assert_allclose(error, [1.0, 2.0])  # std (ddof 1) / sqrt(2)


def test_mean_ends_with_the_shortest_repetition():
    mean, _ = mean_and_error([np.array([1.0, 2.0, 3.0]), np.array([1.0])])
    assert mean.tolist() == [1.0]


def test_single_trace_is_its_own_mean_without_error():
    mean, error = mean_and_error([np.array([1.0, 5.0])])
    assert mean.tolist() == [1.0, 5.0]
    assert error.tolist() == [0.0, 0.0]


def test_band_is_drawn_for_repetitions_only(axes):
    draw_trace(axes, [np.array([1.0, 2.0])], "blue")
    assert len(axes.collections) == 0
    draw_trace(axes, [np.array([1.0, 2.0]), np.array([2.0, 2.0])], "blue")
    assert len(axes.collections) == 1


def test_line_holds_each_value_until_the_next_evaluation(axes):
    draw_trace(axes, [np.array([1.0, 4.0])], "blue")
    (line,) = axes.lines
    assert line.get_drawstyle() == "steps-post"
    assert line.get_xydata().tolist() == [[1.0, 1.0], [2.0, 4.0], [2.5, 4.0]]


def test_legend_names_labels_repetitions_and_the_end_of_the_design(tmp_path):
    folders = [write_run(tmp_path / name, [[1, 1], [2, 2]], n_design=1) for name in "abc"]
    entries = trace_legend(load_runs(folders, ["x", "x", "y"]), single="one")
    assert [e.get_label() for e in entries] == ["x (2 runs)", "y", "± standard error", "end of design"]


def test_evaluations_are_whole_numbers(tmp_path, axes):
    show_evaluations(axes, load_runs([write_run(tmp_path, [[1, 1]] * 3)]))
    assert all(float(tick).is_integer() for tick in axes.get_xticks())
