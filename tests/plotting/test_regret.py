"""Tests for regret.py."""

import csv

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting import plot_function
from hypermap_lite.plotting.regret import plot_regret, regret
from hypermap_lite.plotting.runs import load_run
from tests.plotting.run_folders import write_run

NAN = np.nan
SMALL = ({"name": "f"},)
LARGE = ({"name": "f", "goal": "maximize"},)


def test_regret_is_the_distance_of_the_best_so_far(tmp_path):
    run = load_run(write_run(tmp_path, [[NAN], [3.0], [5.0], [2.0]], objectives=SMALL))
    np.testing.assert_array_equal(regret(run, 1.5), [NAN, 1.5, 1.5, 0.5])


def test_regret_of_an_objective_to_be_maximized_is_positive_too(tmp_path):
    run = load_run(write_run(tmp_path, [[3.0], [5.0]], objectives=LARGE))
    np.testing.assert_array_equal(regret(run, 6.0), [3.0, 1.0])


def test_picture_has_the_mean_of_each_label(tmp_path, figures):
    for i, y in enumerate(([[3.0], [1.0]], [[5.0], [1.0]])):
        write_run(tmp_path / str(i), y, objectives=SMALL, n_design=1)
    *_, data = plot_regret(
        [tmp_path / "0", tmp_path / "1"], tmp_path / "p.png", labels=["a", "a"], optimum=0.5, data=True
    )
    with data.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["regret"], row["mean"]) for row in rows] == [
        ("2.5", "3.5"),
        ("0.5", "0.5"),
        ("4.5", "3.5"),
        ("0.5", "0.5"),
    ]
    assert "optimum: f 0.5" in figures[0].axes[0].get_xlabel()


def test_without_an_optimum_the_best_of_all_runs_counts(tmp_path, figures):
    write_run(tmp_path / "a", [[3.0]], objectives=SMALL)
    write_run(tmp_path / "b", [[1.0]], objectives=SMALL)
    *_, data = plot_regret([tmp_path / "a", tmp_path / "b"], tmp_path / "p.png", data=True)
    assert [line.split(",")[3] for line in data.read_text().splitlines()] == ["regret", "2.0", "0.0"]
    assert "best value found: f 1" in figures[0].axes[0].get_xlabel()


def test_logarithmic_axis_has_plain_numbers(tmp_path, figures):
    run = write_run(tmp_path / "a", [[1000.0], [10.0], [1.0], [0.0]], objectives=SMALL)
    plot_function("regret", options={"log": True, "optimum": 0.0})([run], tmp_path / "p.png")
    (axes,) = figures[0].axes
    assert axes.get_yscale() == "log"
    assert "$" not in "".join(label.get_text() for label in axes.get_yticklabels())


def test_nothing_above_zero_has_no_logarithm(tmp_path):
    run = write_run(tmp_path / "a", [[1.0]], objectives=SMALL)
    with pytest.raises(UsageError, match="no value above zero"):
        plot_regret([run], tmp_path / "p.png", log=True)


def test_several_objectives_are_refused(tmp_path):
    run = write_run(tmp_path / "a", [[1.0, 2.0]])
    with pytest.raises(UsageError, match="needs one objective: try `plot hypervolume_gap`"):
        plot_regret([run], tmp_path / "p.png")
