"""Tests for hypervolume.py."""

import csv
import logging

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting.hypervolume import plot_hypervolume, run_traces
from hypermap_lite.plotting.reference import common_reference_point
from hypermap_lite.plotting.runs import load_runs
from tests.plotting.run_folders import write_run

ZERO = {"performance": 0.0, "safety": 0.0}


@pytest.fixture
def folders(tmp_path):
    first = write_run(tmp_path / "a", [[1.0, 1.0], [np.nan, np.nan], [2.0, 3.0]], n_design=1)
    second = write_run(tmp_path / "b", [[1.0, 3.0], [2.0, 2.0], [1.0, 1.0], [5.0, 5.0]], n_design=2)
    return [first, second]


def test_traces_measure_each_run_from_one_corner(folders):
    runs = load_runs(folders, ["x", "y"])
    volumes = run_traces(runs, common_reference_point(runs, ZERO))
    assert [v.tolist() for v in volumes["x"]] == [[1.0, 1.0, 6.0]]
    assert [v.tolist() for v in volumes["y"]] == [[3.0, 5.0, 5.0, 25.0]]


def test_picture_of_one_run(folders):
    assert plot_hypervolume(folders[:1]) == [folders[0] / "hypervolume.png", folders[0] / "hypervolume.pdf"]


def test_inferred_reference_point_is_said(folders, tmp_path, caplog):
    with caplog.at_level(logging.WARNING):
        plot_hypervolume(folders, tmp_path / "h.png")
    assert "inferred reference point: performance 4.5, safety 4.5" in caplog.text


def test_given_reference_point_needs_no_words(folders, tmp_path, caplog):
    plot_hypervolume(folders, tmp_path / "h.png", reference_point=ZERO)
    assert not caplog.records


def test_data_hold_each_run_and_the_mean_of_its_label(folders, tmp_path):
    *_, file = plot_hypervolume(folders, tmp_path / "h.png", labels=["x", "x"], reference_point=ZERO, data=True)
    rows = [
        [r["evaluation"], r["hypervolume"], r["mean"], r["standard_error"]]
        for r in csv.DictReader(file.read_text().splitlines())
    ]
    assert rows[0] == ["1", "1.0", "2.0", "1.0"]
    assert rows[2] == ["3", "6.0", "5.5", "0.5"]
    assert rows[-1] == ["4", "25.0", "", ""]


def test_one_objective_is_an_error(tmp_path):
    folder = write_run(tmp_path, [[1.0]], objectives=[{"name": "f"}])
    with pytest.raises(UsageError, match=r"needs at least 2 objectives.*try `plot objectives`"):
        plot_hypervolume([folder])
