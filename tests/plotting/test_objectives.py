"""Tests for objectives.py."""

import csv

import numpy as np
import pytest

from hypermap_lite.plotting.objectives import plot_objectives, running_best
from hypermap_lite.plotting.runs import load_run
from tests.plotting.run_folders import write_run

MIXED = ({"name": "gain", "goal": "maximize"}, {"name": "cost", "goal": "minimize"})
STATES = ["failed", "completed", "timeout", "completed", "infeasible", "completed"]
Y = [[np.nan] * 2, [1.0, 5.0], [np.nan] * 2, [3.0, 7.0], [np.nan] * 2, [2.0, 4.0]]


@pytest.fixture
def folder(tmp_path):
    return write_run(tmp_path / "run", Y, objectives=MIXED, states=STATES, n_design=2, sem=np.array(Y) / 10)


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_running_best_follows_each_goal_and_skips_failures(folder):
    best = running_best(load_run(folder))
    np.testing.assert_array_equal(best, [[np.nan] * 2, [1, 5], [1, 5], [3, 5], [3, 5], [3, 4]])


def test_one_panel_per_objective(folder, figures):
    assert plot_objectives([folder]) == [folder / "objectives.png", folder / "objectives.pdf"]
    assert [axes.get_ylabel().splitlines()[0] for axes in figures[0].axes] == ["gain", "cost"]


def test_each_state_has_its_mark_and_its_legend(folder, figures):
    plot_objectives([folder])
    assert legend_of(figures[0])[-3:] == ["failed", "timeout", "infeasible"]


def test_states_that_did_not_occur_are_not_explained(tmp_path, figures):
    plot_objectives([write_run(tmp_path, [[1.0]], objectives=[{"name": "f"}])])
    assert legend_of(figures[0]) == ["best so far", "evaluation"]


def test_repetitions_are_lines_alone(folder, tmp_path, figures):
    other = write_run(tmp_path / "other", Y, objectives=MIXED, states=STATES, n_design=2)
    plot_objectives([folder, other], tmp_path / "o.png", labels=["x", "x"])
    assert legend_of(figures[0]) == ["x (2 runs)", "± standard error", "end of design"]


def test_several_runs_are_overlaid(folder, tmp_path, figures):
    other = write_run(tmp_path / "other", [[1.0, 1.0]], objectives=MIXED)
    plot_objectives([folder, other], tmp_path / "o.png")
    assert legend_of(figures[0])[:2] == ["run", "other"]


def test_data_behind_the_picture(folder, tmp_path):
    *_, file = plot_objectives([folder], tmp_path / "o.png", data=True)
    rows = list(csv.DictReader(file.read_text().splitlines()))
    assert [row["state"] for row in rows] == STATES
    assert [row["cost_best"] for row in rows] == ["", "5.0", "5.0", "5.0", "5.0", "4.0"]
