"""Tests for hypervolume_gap.py."""

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting.hypervolume_gap import gap, plot_hypervolume_gap
from hypermap_lite.plotting.reference import ReferencePoint
from hypermap_lite.plotting.runs import load_runs
from tests.plotting.run_folders import write_run

NAN = np.nan
TWO = ({"name": "f"}, {"name": "g"})
A = [[2.0, 2.0], [NAN, NAN], [3.0, 1.0]]
B = [[1.0, 3.0]]


def runs_of(tmp_path, scale=(1.0, 1.0), shift=(0.0, 0.0)):
    for name, Y in (("a", A), ("b", B)):
        write_run(tmp_path / name, np.array(Y) * scale + shift, objectives=TWO)
    corner = np.array([4.0, 4.0]) * scale + shift
    return load_runs([tmp_path / "a", tmp_path / "b"]), ReferencePoint(
        values=corner, names=("f", "g"), is_inferred=False
    )


def test_gap_is_the_missing_share_of_the_volume_of_all_runs(tmp_path):
    runs, reference = runs_of(tmp_path)
    # all together 3 + 2 + 1 = 6; run a has 4, then 5; run b has 3
    assert gap(runs[0], runs, reference) == pytest.approx([2 / 6, 2 / 6, 1 / 6])
    assert gap(runs[1], runs, reference) == pytest.approx([3 / 6])


@pytest.mark.parametrize(("scale", "shift"), [((1e6, 1e-3), (0, 0)), ((1, 1), (-500, 9e4))])
def test_gap_does_not_depend_on_units(tmp_path, scale, shift):
    runs, reference = runs_of(tmp_path, scale, shift)
    assert gap(runs[0], runs, reference) == pytest.approx([2 / 6, 2 / 6, 1 / 6])


def test_front_of_all_runs_leaves_no_gap(tmp_path):
    write_run(tmp_path / "a", [*A, *B], objectives=TWO)
    runs = load_runs([tmp_path / "a"])
    reference = ReferencePoint(values=np.array([4.0, 4.0]), names=("f", "g"), is_inferred=False)
    assert gap(runs[0], runs, reference)[-1] == 0


def test_nothing_better_than_the_reference_point_is_an_error(tmp_path):
    runs, _ = runs_of(tmp_path)
    reference = ReferencePoint(values=np.array([2.0, 2.0]), names=("f", "g"), is_inferred=False)
    with pytest.raises(UsageError, match="no evaluation beats the reference point in every objective"):
        gap(runs[0], runs, reference)


@pytest.mark.parametrize(("against", "label"), [("evaluations", "evaluations"), ("time", "time [s]")])
def test_axis_is_evaluations_or_time(tmp_path, figures, against, label):
    runs_of(tmp_path)
    plot_hypervolume_gap([tmp_path / "a", tmp_path / "b"], tmp_path / "p.png", against=against)
    assert figures[0].axes[0].get_xlabel().startswith(label)


def test_over_time_the_mean_holds_each_value_until_the_next_row(tmp_path, figures):
    runs_of(tmp_path)  # rows of run a at 0, 0.1 and 0.2 s
    plot_hypervolume_gap([tmp_path / "a"], tmp_path / "p.png", against="time", reference_point={"f": 4.0, "g": 4.0})
    line = figures[0].axes[0].lines[0]
    assert line.get_xdata() == pytest.approx([0.0, 0.1, 0.2])
    assert line.get_ydata() == pytest.approx([1 / 5, 1 / 5, 0.0])


def test_one_objective_is_refused(tmp_path):
    run = write_run(tmp_path, [[1.0]], objectives=({"name": "f"},))
    with pytest.raises(UsageError, match=r"needs at least 2 objectives.*try `plot regret`"):
        plot_hypervolume_gap([run], tmp_path / "p.png")
