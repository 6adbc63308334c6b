"""Tests for runs.py."""

import json

import numpy as np
import pytest

from hypermap_lite.errors import RunFolderError, UsageError
from hypermap_lite.objectives import Goal
from hypermap_lite.plotting import plot_function
from hypermap_lite.plotting.runs import by_label, legend_labels, load_run, load_runs
from tests.plotting.run_folders import TWO_MAXIMIZED, write_run

NAN = np.nan


@pytest.fixture
def folder(tmp_path):
    Y = [[1.0, -2.0], [NAN, NAN], [0.1 + 0.2, -1.0], [0.0, -3.0]]
    sem = np.array([[0.1, 0.2], [NAN, NAN], [NAN, NAN], [0.3, 0.4]])
    return write_run(tmp_path / "run", Y, n_design=2, sem=sem)


def test_run_holds_values_as_the_user_directed_them(folder):
    run = load_run(folder)
    np.testing.assert_array_equal(run.values, [[1.0, -2.0], [NAN, NAN], [0.1 + 0.2, -1.0], [0.0, -3.0]])
    np.testing.assert_array_equal(run.Y, -run.values)
    np.testing.assert_array_equal(run.standard_errors[[0, 3]], [[0.1, 0.2], [0.3, 0.4]])


def test_run_knows_its_scenario(folder):
    run = load_run(folder)
    assert run.name == "demo"
    assert run.label == "run"
    assert [(o.name, o.goal) for o in run.objectives] == [("performance", Goal.MAXIMIZE), ("safety", Goal.MAXIMIZE)]


def test_run_tells_design_state_and_front_of_each_row(folder):
    run = load_run(folder)
    assert run.n_design == 2
    assert run.is_design.tolist() == [True, True, False, False]
    assert run.states == ["completed", "failed", "completed", "completed"]
    assert run.is_completed.tolist() == [True, False, True, True]
    assert run.is_front.tolist() == [True, False, True, False]


def test_history_file_stands_for_its_folder(folder):
    assert load_run(folder / "history.csv").folder == folder


def test_folder_may_be_called_like_a_table(tmp_path):
    folder = write_run(tmp_path / "a.csv", [[1.0, 1.0]])
    assert load_run(folder).folder == folder


@pytest.mark.parametrize("kind", ["pareto", "objectives", "hypervolume", "attainment", "parameters"])
def test_values_that_no_axis_holds_are_refused(tmp_path, kind):
    folder = write_run(tmp_path, [[1e308, -1e308], [-1e308, 1e308]])
    with pytest.raises(UsageError, match=r"values up to 1e\+308 in size cannot be drawn"):
        plot_function(kind)([folder])


def test_hypervolume_beyond_all_floats_is_refused(tmp_path):
    folder = write_run(tmp_path, [[1e200, -1e200], [-1e200, 1e200]])
    with pytest.raises(UsageError, match="beyond all floats"):
        plot_function("hypervolume")([folder])


def test_row_that_is_not_completed_has_no_values_even_if_the_file_has_numbers(tmp_path):
    folder = write_run(tmp_path, [[1.0, 1.0], [9.0, 9.0]], states=["completed", "timeout"])
    assert np.isnan(load_run(folder).values[1]).all()


def test_line_still_being_written_is_left_out(folder):
    with (folder / "history.csv").open("a") as stream:
        stream.write("0.4,99.0,99")
    assert len(load_run(folder).rows) == 4


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        pytest.param(
            lambda f: (f / "scenario.json").unlink(), "not a run folder .no scenario.json in it", id="scenario"
        ),
        pytest.param(
            lambda f: (f / "history.csv").unlink(), "history.csv: not found; .* first evaluation", id="history"
        ),
        pytest.param(lambda f: (f / "scenario.json").write_text("{"), "scenario.json: not valid JSON", id="json"),
        pytest.param(lambda f: (f / "scenario.json").write_text("[]"), "expected a JSON object, got list", id="list"),
        pytest.param(
            lambda f: (f / "scenario.json").write_text("{}"), "its objectives cannot be read", id="objectives"
        ),
        pytest.param(
            lambda f: (f / "history.csv").write_text("a,b\n"), "no column 'state', 'performance'", id="columns"
        ),
        pytest.param(lambda f: (f / "history.csv").write_text(""), "found none", id="empty"),
        pytest.param(
            lambda f: (f / "history.csv").write_text("performance,safety,state\n1,2,completed\n1,x,completed\n"),
            "record 3: safety is not a number: 'x'",
            id="number",
        ),
        pytest.param(
            lambda f: (f / "history.csv").write_text("performance,safety,state\n1,2\n"),
            "record 2 has 2 fields, the header 3",
            id="ragged",
        ),
    ],
)
def test_damaged_folder_is_an_error_that_names_the_file(folder, damage, message):
    damage(folder)
    with pytest.raises(RunFolderError, match=message):
        load_run(folder)


def test_missing_folder_is_an_error(tmp_path):
    with pytest.raises(RunFolderError, match=r"nowhere: not a run folder \(no such folder\)"):
        load_run(tmp_path / "nowhere")


def test_run_without_completed_evaluations_is_an_error_that_counts_the_states(tmp_path):
    folder = write_run(tmp_path, [[NAN, NAN]] * 3, states=["failed", "failed", "timeout"])
    with pytest.raises(RunFolderError, match=r"no completed evaluation yet \(2 failed, 1 timeout\)"):
        load_runs([folder])


def test_no_runs_are_an_error():
    with pytest.raises(UsageError, match="no run folder given"):
        load_runs([])


def test_labels_must_be_one_per_run(folder):
    with pytest.raises(UsageError, match="2 labels for 1 runs"):
        load_runs([folder], ["a", "b"])


def test_runs_with_different_objectives_cannot_share_a_picture(tmp_path):
    minimized = ({**TWO_MAXIMIZED[0], "goal": "minimize"}, TWO_MAXIMIZED[1])
    first = write_run(tmp_path / "a", [[1, 1]])
    second = write_run(tmp_path / "b", [[1, 1]], objectives=minimized)
    with pytest.raises(UsageError, match=r"a has performance \(maximize\).*b has performance \(minimize\)"):
        load_runs([first, second])


def test_default_labels_are_the_shortest_that_differ(tmp_path):
    folders = [write_run(tmp_path / end, [[1, 1]]) for end in ("a/run", "b/run", "b/other")]
    assert [run.label for run in load_runs(folders)] == ["a/run", "b/run", "b/other"]
    assert [run.label for run in load_runs(folders[1:])] == ["run", "other"]


def test_one_folder_twice_is_an_error(folder):
    with pytest.raises(UsageError, match="given twice"):
        load_runs([folder, folder / "history.csv"])


def test_runs_that_share_a_label_are_repetitions(tmp_path):
    folders = [write_run(tmp_path / name, [[1, 1]]) for name in "abc"]
    runs = load_runs(folders, ["with", "without", "with"])
    assert {label: [r.folder.name for r in group] for label, group in by_label(runs).items()} == {
        "with": ["a", "c"],
        "without": ["b"],
    }
    assert legend_labels(runs) == ["with (2 runs)", "without"]


def test_byte_order_mark_of_a_spreadsheet_program_does_no_harm(folder):
    file = folder / "history.csv"
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes())
    assert load_run(folder).columns[0] == "x"


def test_scenario_is_read_as_written(folder):
    assert load_run(folder).scenario == json.loads((folder / "scenario.json").read_text())


def test_values_of_an_infeasible_evaluation_are_no_values(tmp_path):
    folder = write_run(tmp_path, [[1, 2], [9, 9]], states=["completed", "infeasible"], sem=np.ones((2, 2)))
    run = load_run(folder)
    assert run.is_completed.tolist() == run.is_front.tolist() == [True, False]
    assert np.isnan(run.values[1]).all()
    assert np.isnan(run.standard_errors[1]).all()
