"""Tests for attainment.py."""

import csv

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting.attainment import label_surfaces, plot_attainment
from hypermap_lite.plotting.runs import load_runs
from tests.plotting.run_folders import write_run

MIXED = ({"name": "gain", "goal": "maximize"}, {"name": "cost", "goal": "minimize"})
VALUES = ([[1.0, 1.0], [3.0, 2.0]], [[2.0, 1.0], [0.0, 9.0]], [[3.0, 3.0]])


@pytest.fixture
def folders(tmp_path):
    return [write_run(tmp_path / str(i), Y, objectives=MIXED) for i, Y in enumerate(VALUES)]


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def lines_of(figure, width):
    return [line.get_xydata() for line in figure.axes[0].lines if line.get_linewidth() == width]


def corners_in(file, fraction):
    rows = csv.DictReader(file.read_text().splitlines())
    return [(row["gain"], row["cost"]) for row in rows if row["fraction"] == fraction]


def test_median_of_three_runs_in_the_users_directions(folders, tmp_path):
    *_, file = plot_attainment(folders, tmp_path / "a.png", labels=["x"] * 3, data=True)
    # two of the three reach a gain of 3 at a cost of 3, the first two 2 at 2, and 1 at 1
    assert corners_in(file, "0.5") == [("3.0", "3.0"), ("2.0", "2.0"), ("1.0", "1.0")]
    assert corners_in(file, "0.25") == [("3.0", "2.0"), ("2.0", "1.0")]
    assert corners_in(file, "0.75") == [("2.0", "3.0")]


def test_single_run_draws_its_front_without_a_band(folders, tmp_path, figures):
    plot_attainment(folders[:1], tmp_path / "a.png")
    (line,) = lines_of(figures[0], 2.2)
    assert line[1:-1].tolist() == [[3, 2], [1, 2], [1, 1]]
    assert not figures[0].axes[0].patches
    assert legend_of(figures[0])[0] == "0 (1 run)"


def test_band_lies_between_the_quartile_surfaces(folders, tmp_path, figures):
    plot_attainment(folders, tmp_path / "a.png", labels=["x"] * 3)
    (band,) = figures[0].axes[0].patches
    assert {(3.0, 2.0), (2.0, 1.0), (2.0, 3.0)} <= set(map(tuple, band.get_xy()))
    assert not band.get_path().contains_point((1.0, 9.0))  # all runs attain it
    assert not band.get_path().contains_point((2.9, 1.0))  # none does


def test_legend_says_how_many_runs_each_label_has(folders, tmp_path, figures):
    plot_attainment(folders, tmp_path / "a.png", labels=["x", "x", "y"], reference_point={"gain": 1, "cost": 4})
    assert legend_of(figures[0]) == [
        "x (2 runs)",
        "y (1 run)",
        "median",
        "25 % to 75 % of the runs",
        "reference point",
    ]


def test_surfaces_of_repetitions_that_agree_are_one_line(tmp_path, figures):
    folders = [write_run(tmp_path / name, VALUES[0], objectives=MIXED) for name in "abc"]
    surfaces = label_surfaces(load_runs(folders, ["x"] * 3))["x"]
    assert all(np.array_equal(surface, surfaces[0]) for surface in surfaces)
    plot_attainment(folders, tmp_path / "a.png", labels=["x"] * 3)
    assert not figures[0].axes[0].patches


def test_view_fits_the_surfaces_and_not_a_far_reference_point(folders, tmp_path, figures):
    plot_attainment(folders, tmp_path / "a.png", labels=["x"] * 3, reference_point={"gain": -1e6, "cost": 1e6})
    assert figures[0].axes[0].get_xlim()[0] > -10
    assert "reference point" not in legend_of(figures[0])


def test_end_of_a_front_beyond_the_reference_point_does_not_set_the_scale(tmp_path, figures):
    Y = [[float(i), float(i)] for i in range(5)] + [[4.1, 1e6]]
    folder = write_run(tmp_path, Y, objectives=MIXED)
    plot_attainment([folder], tmp_path / "a.png", reference_point={"gain": 0, "cost": 5})
    assert figures[0].axes[0].get_ylim()[1] < 10
    assert "reference point" in legend_of(figures[0])


def test_label_wholly_beyond_the_reference_point_is_in_view(folders, tmp_path, figures):
    far = write_run(tmp_path / "far", [[-100.0, 500.0]], objectives=MIXED)
    plot_attainment(
        [*folders, far], tmp_path / "a.png", labels=["x"] * 3 + ["far"], reference_point={"gain": 0, "cost": 4}
    )
    assert figures[0].axes[0].get_xlim()[0] < -100
    assert figures[0].axes[0].get_ylim()[1] > 500


def test_failed_evaluations_play_no_part(tmp_path):
    folder = write_run(tmp_path, [[np.nan] * 2, *VALUES[0]], objectives=MIXED)
    *_, file = plot_attainment([folder], tmp_path / "a.png", data=True)
    assert corners_in(file, "0.5") == [("3.0", "2.0"), ("1.0", "1.0")]


@pytest.mark.parametrize(("names", "other"), [("a", "objectives"), ("abc", "hypervolume")])
def test_another_number_of_objectives_is_an_error_that_names_a_kind(tmp_path, names, other):
    folder = write_run(tmp_path, [[1.0] * len(names)], objectives=[{"name": name} for name in names])
    message = f"needs 2 objectives, this scenario has {len(names)}: try `plot {other}`"
    with pytest.raises(UsageError, match=message):
        plot_attainment([folder])
