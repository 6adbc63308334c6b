"""Tests for pareto.py."""

import csv

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting import style
from hypermap_lite.plotting.pareto import plot_pareto, staircase
from tests.plotting.run_folders import write_run

MIXED = ({"name": "gain", "goal": "maximize"}, {"name": "cost", "goal": "minimize"})


def staircase_of(figure):
    (line,) = [line for line in figure.axes[0].lines if line.get_linestyle() == "-"]
    return line.get_xydata()


def limits_of(figure):
    """Return the limits of the first panel, a row per axis."""
    axes = figure.axes[0]
    return np.array([axes.get_xlim(), axes.get_ylim()])


def triangles_of(figure):
    """Return how many points each direction has, of those that lie outside of the first panel."""
    counts = {line.get_marker(): len(line.get_xdata()) for line in figure.axes[0].lines}
    return {shape: counts[shape] for shape in "<>v^" if counts.get(shape)}


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def run_with_errors(folder, n_objectives=2, seed=0):
    rng = np.random.default_rng(seed)
    Y = rng.normal(size=(30, n_objectives))
    Y[3] = np.nan
    names = ("performance", "safety", "effort", "time", "noise", "wear")
    objectives = [{"name": names[j], "goal": "maximize" if j < 2 else "minimize"} for j in range(n_objectives)]
    return write_run(folder, Y, objectives=objectives, n_design=6, sem=np.abs(rng.normal(size=Y.shape)) / 9)


def test_staircase_of_two_points_to_be_minimized():
    corners = staircase(np.array([[2.0, 1.0], [1.0, 3.0], [1.0, 3.0]]), np.array([9.0, 8.0]))
    assert corners.tolist() == [[1, 8], [1, 3], [2, 3], [2, 1], [9, 1]]


def test_staircase_runs_over_the_worse_side_of_each_objective(tmp_path, figures):
    # gain is to be large, cost small: between (1, 1) and (3, 2) the border passes (1, 2), not (3, 1)
    plot_pareto([write_run(tmp_path, [[1.0, 1.0], [3.0, 2.0], [1.0, 3.0]], objectives=MIXED)])
    corners = staircase_of(figures[0])[1:-1].tolist()
    assert corners in ([[3, 2], [1, 2], [1, 1]], [[1, 1], [1, 2], [3, 2]])


def test_staircase_ends_at_the_worse_sides_of_the_view(tmp_path, figures):
    plot_pareto([write_run(tmp_path, [[1.0, 1.0], [3.0, 2.0]], objectives=MIXED)])
    axes = figures[0].axes[0]
    assert staircase_of(figures[0])[:, 0].min() == axes.get_xlim()[0]
    assert staircase_of(figures[0])[:, 1].max() == axes.get_ylim()[1]


def test_picture_goes_into_the_run_folder_as_png_and_pdf(tmp_path):
    folder = run_with_errors(tmp_path / "run")
    assert plot_pareto([folder]) == [folder / "pareto.png", folder / "pareto.pdf"]


def test_legend_explains_what_is_drawn(tmp_path, figures):
    plot_pareto([run_with_errors(tmp_path)], tmp_path / "a.png", reference_point={"performance": -1, "safety": -1})
    assert legend_of(figures[0])[1:] == ["dominated", "initial design", "± standard error", "reference point"]
    assert legend_of(figures[0])[0].startswith("Pareto front (")


def test_chosen_reference_point_is_always_in_view(tmp_path, figures):
    plot_pareto([run_with_errors(tmp_path)], tmp_path / "a.png", reference_point={"performance": -99, "safety": -1})
    assert "reference point" in legend_of(figures[0])
    assert figures[0].axes[0].get_xlim()[0] < -99


def test_reference_point_that_no_axis_holds_is_refused(tmp_path):
    with pytest.raises(UsageError, match=r"reference point of 1e\+308 in size cannot be drawn"):
        plot_pareto([run_with_errors(tmp_path)], tmp_path / "a.png", reference_point={"performance": -1e308})


def test_a_bad_evaluation_does_not_squeeze_the_front(tmp_path, figures):
    Y = [[i, 10.0 - i] for i in range(10)] + [[-1e6, 3.0], [2.0, -1e6], [-1e6, -1e7]]
    plot_pareto([write_run(tmp_path, Y)], tmp_path / "a.png")
    assert limits_of(figures[0]).min() > -20
    assert "3 outside" in legend_of(figures[0])
    assert triangles_of(figures[0]) == {"<": 1, "v": 2}


def test_front_is_in_view_however_far_its_ends_are(tmp_path, figures):
    Y = [[i, 10.0 - i] for i in range(10)] + [[-1e6, 11.0], [10.0, -1e6]]
    plot_pareto([write_run(tmp_path, Y)], tmp_path / "a.png")
    assert limits_of(figures[0])[:, 0].max() < -1e6
    assert not any("outside" in text for text in legend_of(figures[0]))


def test_evaluation_outside_of_several_panels_counts_once(tmp_path, figures):
    objectives = [{"name": name} for name in "abc"]
    Y = [[i, 10.0 - i, 5.0] for i in range(10)] + [[1e6, 1e6, 1e6]]
    plot_pareto([write_run(tmp_path, Y, objectives=objectives)], tmp_path / "a.png")
    assert "1 outside" in legend_of(figures[0])


def test_points_outside_have_the_colour_of_their_label(tmp_path, figures):
    Y = [[1, 2], [2, 1], [2, 1], [1, 2]]
    folders = [write_run(tmp_path / "a", [*Y, [-1e6, 1]]), write_run(tmp_path / "b", Y)]
    plot_pareto(folders, tmp_path / "a.png")
    (mark,) = [line for line in figures[0].axes[0].lines if line.get_marker() == "<" and len(line.get_xdata())]
    assert mark.get_markerfacecolor() == style.colour(0)


def test_error_bars_only_where_there_are_replicates(tmp_path, figures):
    plot_pareto([write_run(tmp_path, [[1, 1], [2, 0]])], tmp_path / "a.png")
    assert not figures[0].axes[0].containers
    assert "± standard error" not in legend_of(figures[0])


@pytest.mark.parametrize(("n_objectives", "n_panels"), [(3, 3), (4, 6), (5, 10)])
def test_more_objectives_get_a_panel_per_pair(tmp_path, figures, n_objectives, n_panels):
    plot_pareto([run_with_errors(tmp_path, n_objectives)], tmp_path / "a.png")
    assert sum(axes.axison for axes in figures[0].axes) == n_panels
    assert figures[0].axes[2].get_xlabel().startswith("safety" if n_objectives == 3 else "performance")


def test_several_runs_are_overlaid_with_their_labels(tmp_path, figures):
    folders = [run_with_errors(tmp_path / name, seed=i) for i, name in enumerate("ab")]
    plot_pareto(folders, tmp_path / "a.png", labels=["with prior", "$no_prior$"])
    assert legend_of(figures[0])[:2] == ["with prior", "$no_prior$"]


def test_repetitions_share_colour_and_show_fronts_only(tmp_path, figures):
    folders = [run_with_errors(tmp_path / name, seed=i) for i, name in enumerate("abc")]
    plot_pareto(folders, tmp_path / "a.png", labels=["x", "x", "y"])
    assert legend_of(figures[0])[:2] == ["x (2 runs)", "y"]
    assert not figures[0].axes[0].containers


def test_single_point_can_be_drawn(tmp_path):
    assert plot_pareto([write_run(tmp_path, [[0.0, 0.0]])], tmp_path / "a.png")


@pytest.mark.parametrize("n_objectives", [1, 6])
def test_objectives_that_cannot_be_drawn_are_an_error(tmp_path, n_objectives):
    folder = run_with_errors(tmp_path, n_objectives)
    with pytest.raises(UsageError, match=f"needs 2 to 5 objectives, this scenario has {n_objectives}: try `plot obj"):
        plot_pareto([folder])


def test_data_behind_the_picture(tmp_path):
    folder = write_run(tmp_path, [[1.0, 1.0], [np.nan, 1.0], [0.0, 0.1]], n_design=1)
    *_, file = plot_pareto([folder], tmp_path / "a.png", data=True)
    rows = list(csv.DictReader(file.read_text().splitlines()))
    assert [(r["evaluation"], r["phase"], r["on_front"], r["safety"]) for r in rows] == [
        ("1", "design", "True", "1.0"),
        ("3", "model", "False", "0.1"),
    ]
