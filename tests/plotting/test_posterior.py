"""Tests for posterior.py."""

import numpy as np
import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.plotting import pareto
from hypermap_lite.plotting.posterior import posterior_points
from hypermap_lite.plotting.runs import load_run, load_runs
from tests.plotting.run_folders import write_run

HEADER = "x,performance,safety,trial,replicates,performance_mean,performance_std,safety_mean,safety_std\n"


@pytest.fixture
def folder(tmp_path):
    write_run(tmp_path / "run", [[1.0, 4.0], [3.0, 2.0], [5.0, 0.0]])
    (tmp_path / "run/posterior_front.csv").write_text(HEADER + "0.1,3.0,2.0,1,7,2.5,0.5,2.25,0.25\n0.2,5,0,2,7,,,,\n")
    return tmp_path / "run"


def test_points_are_the_means_and_deviations_of_the_file(folder):
    points = posterior_points(load_run(folder))
    assert (points.mean.tolist(), points.std.tolist()) == ([[2.5, 2.25]], [[0.5, 0.25]])


def test_run_without_the_file_has_none(tmp_path):
    assert posterior_points(load_run(write_run(tmp_path, [[1.0, 4.0]]))) is None


def test_columns_that_a_parameter_took_first_are_found(folder):
    file = folder / "posterior_front.csv"
    file.write_text(file.read_text().replace("performance_mean", "posterior.performance_mean"))
    assert posterior_points(load_run(folder)).mean.tolist() == [[2.5, 2.25]]


def test_damaged_file_is_named(folder):
    (folder / "posterior_front.csv").write_text(HEADER + "0.1,3.0,2.0,1,7,much,0.5,2.25,0.25\n")
    with pytest.raises(RunFolderError, match=r"posterior_front.csv: record 2: performance_mean is not a number"):
        posterior_points(load_run(folder))


def test_picture_of_one_run_shows_it_and_one_of_several_does_not(folder, tmp_path):
    other = write_run(tmp_path / "other", [[2.0, 2.0]])
    reference = pareto.common_reference_point(load_runs([folder]))
    labels = [
        [str(entry.get_label()) for entry in pareto._legend(runs, reference, line="-", n_outside=0)]
        for runs in (load_runs([folder]), load_runs([folder, other]))
    ]
    assert labels[0][1] == "posterior front (1 point, mean ± std)"
    assert not any("posterior" in label for label in labels[1])
    figure = pareto._draw_plane(load_runs([folder]), reference)
    drawn = [line.get_xydata().tolist() for line in figure.axes[0].lines if line.get_marker() == "D"]
    assert drawn == [[[2.5, 2.25]]]
    bars = [
        c for container in figure.axes[0].containers for c in container.get_children() if hasattr(c, "get_segments")
    ]
    spans = [np.ptp(segment, axis=0).max() for bar in bars for segment in bar.get_segments()]
    assert sorted(spans) == pytest.approx([0.5, 1.0])
