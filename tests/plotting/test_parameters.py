"""Tests for parameters.py."""

import csv
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.collections import LineCollection

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting import style
from hypermap_lite.plotting.parameters import WIDEST, plot_parameters
from tests.plotting.run_folders import TWO_PARAMETERS, write_run

MIXED = ({"name": "gain", "goal": "maximize"}, {"name": "cost", "goal": "minimize"})
PARAMETERS = {
    "speed": {"parameter_type": "real", "values": [0, 10]},
    "stiffness": {"parameter_type": "real", "values": [0.01, 100], "scale": "log"},
    "repeats": {"parameter_type": "integer", "values": [1, 5]},
    "mode": {"parameter_type": "categorical", "values": ["soft", "medium", "rigid"]},
}
CONFIGURATIONS = [["2.5", "1.0", "1", "soft"], ["0.0", "1.0", "1", "soft"], ["10.0", "100.0", "4", "rigid"]]
VALUES = [[1.0, 1.0], [0.0, 3.0], [3.0, 2.0]]


@pytest.fixture
def folder(tmp_path):
    return write_run(tmp_path / "run", VALUES, objectives=MIXED, parameters=PARAMETERS, configurations=CONFIGURATIONS)


def rows_of(figure):
    """Return the heights and the colours of the lines, in the order they are drawn."""
    (lines,) = [c for c in figure.axes[0].collections if isinstance(c, LineCollection) and c.get_zorder() == 3]
    return [segment[:, 1].tolist() for segment in lines.get_segments()], lines.get_colors()[:, :3].tolist()


def texts_of(figure):
    return [text.get_text() for text in figure.axes[0].texts]


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def names_of(figure):
    return [label.get_text() for label in figure.axes[0].get_xticklabels()]


def test_axes_are_the_parameters_and_then_the_objectives(folder, figures):
    assert plot_parameters([folder]) == [folder / "parameters.png", folder / "parameters.pdf"]
    assert names_of(figures[0]) == ["speed", "stiffness (log)", "repeats", "mode", "gain", "cost"]


def test_lines_are_the_front_scaled_to_the_bounds(folder, figures):
    plot_parameters([folder])
    heights, _ = rows_of(figures[0])
    np.testing.assert_allclose(heights, [[0.25, 0.5, 0, 0, 0, 0], [1, 1, 0.75, 1, 1, 1]])


def test_bounds_stand_at_the_ends_and_levels_at_the_axis(folder, figures):
    plot_parameters([folder])
    texts = texts_of(figures[0])
    assert {"0", "10", "0.01", "100", "1", "5", "2", "3", "4", "soft", "medium", "rigid"} <= set(texts)


def test_better_ends_are_marked(folder, figures):
    plot_parameters([folder])
    marks = {m.get_marker(): m.get_xydata()[0] for m in figures[0].axes[0].lines if m.get_marker() in ("^", "v")}
    assert marks["^"][1] > 1  # gain, to be maximized
    assert marks["v"][1] < 0
    assert marks["^"][0] < marks["v"][0]


def test_one_run_is_coloured_by_its_first_objective(folder, figures):
    plot_parameters([folder])
    _, (worse, better) = rows_of(figures[0])
    assert sum(worse) < sum(better)  # from dark to light
    assert legend_of(figures[0]) == ["Pareto front (2 points), coloured by gain", "better end"]


def test_several_labels_are_coloured_by_label(tmp_path, figures):
    folders = [write_run(tmp_path / name, [[1.0, 2.0]], parameters=TWO_PARAMETERS) for name in "ab"]
    plot_parameters(folders, tmp_path / "p.png", labels=["with", "without"])
    _, colours = rows_of(figures[0])
    assert [style.mpl.colors.to_hex(colour).upper() for colour in colours] == list(style.COLOURS[:2])
    assert legend_of(figures[0]) == ["with", "without", "better end"]


def test_repetitions_of_one_label_are_one_front_for_all(tmp_path, figures):
    folders = [write_run(tmp_path / name, [[1.0, 2.0]]) for name in "ab"]
    plot_parameters(folders, tmp_path / "p.png", labels=["x", "x"])
    assert legend_of(figures[0])[0] == "Pareto front of 2 runs (2 points), coloured by performance"


def test_objective_that_is_the_same_everywhere_lies_in_the_middle(tmp_path, figures):
    plot_parameters([write_run(tmp_path, [[1.0]], objectives=[{"name": "f"}])])
    ((_, height),), _ = rows_of(figures[0])
    assert height == 0.5
    assert "1" in texts_of(figures[0])


def test_chosen_parameters_come_in_their_order(folder, tmp_path, figures):
    plot_parameters([folder], tmp_path / "p.png", parameters=["mode", "speed"])
    assert names_of(figures[0]) == ["mode", "speed", "gain", "cost"]


def test_twenty_long_names_stay_apart_and_inside_the_picture(tmp_path, figures):
    parameters = {
        f"a_parameter_of_25_chars_{i:02}": {"parameter_type": "real", "values": [-1e5, 12345]} for i in range(20)
    }
    folder = write_run(tmp_path, [[1.0, 2.0]], parameters=parameters, configurations=[["0.0"] * 20])
    plot_parameters([folder], tmp_path / "p.png")
    (figure,) = figures
    figure.canvas.draw()
    assert figure.get_figwidth() <= WIDEST
    boxes = [label.get_window_extent() for label in figure.axes[0].get_xticklabels()]
    assert min(box.x0 for box in boxes) >= 0
    assert all(left.x1 + 20 < right.x1 for left, right in pairwise(boxes[:20]))
    ends = [text.get_window_extent() for text in figure.axes[0].texts if text.get_text() == "12345"]
    assert all(left.x1 < right.x0 for left, right in pairwise(ends))


def test_data_hold_the_front_in_native_units(folder, tmp_path):
    *_, file = plot_parameters([folder], tmp_path / "p.png", data=True)
    rows = list(csv.reader(file.read_text().splitlines()))
    assert rows[0] == ["label", "run", "evaluation", "speed", "stiffness", "repeats", "mode", "gain", "cost"]
    assert [row[2:] for row in rows[1:]] == [
        ["1", "2.5", "1.0", "1", "soft", "1.0", "1.0"],
        ["3", "10.0", "100.0", "4", "rigid", "3.0", "2.0"],
    ]


@pytest.mark.parametrize(
    "other",
    [
        pytest.param({"x": {"parameter_type": "real", "values": [0, 20]}}, id="bounds"),
        pytest.param(TWO_PARAMETERS, id="number"),
        pytest.param({"y": {"parameter_type": "real", "values": [0, 10]}}, id="name"),
    ],
)
def test_runs_with_different_parameters_cannot_share_a_picture(tmp_path, other):
    folders = [write_run(tmp_path / "a", [[1, 1]]), write_run(tmp_path / "b", [[1, 1]], parameters=other)]
    with pytest.raises(UsageError, match=r"a has x \(a number from 0 to 10\); .*b has"):
        plot_parameters(folders, tmp_path / "p.png")
