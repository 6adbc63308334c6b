"""Tests for exports.py."""

import csv
import logging
from dataclasses import replace

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.history.exports import Exports
from hypermap_lite.history.rows import HistoryFormat
from hypermap_lite.history.run_folder import RunFolder
from hypermap_lite.objectives import Objective
from tests.history.examples import CANONICAL, OBJECTIVES, SPACE, evaluation


def open_run(tmp_path, objectives=OBJECTIVES):
    return RunFolder(
        tmp_path / "run",
        space=SPACE,
        objectives=objectives,
        canonical=CANONICAL,
        samples_file=tmp_path / "out" / "samples.csv",
        pareto_file=tmp_path / "out" / "pareto.csv",
    )


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def samples(tmp_path):
    return tmp_path / "out" / "samples.csv"


def test_columns_are_inputs_objectives_and_whole_milliseconds_with_plain_newlines(tmp_path):
    with open_run(tmp_path) as run:
        run.append_evaluation(evaluation(0))
        run.append_evaluation(evaluation(1))
    content = samples(tmp_path).read_bytes()
    assert content.splitlines()[0] == b"force,turns,gain,tool,reward,cost,Timestamp"
    assert content.splitlines()[2] == b"0.14285714285714285,3,2,peg,1.5,2.0,1"
    assert b"\r" not in content


def test_row_is_in_the_file_when_append_returns_and_failed_ones_are_not(tmp_path):
    with open_run(tmp_path) as run:
        for trial, reward in enumerate([1.0, None, 3.0]):
            run.append_evaluation(evaluation(trial, reward))
            assert len(rows_of(samples(tmp_path))) == [1, 1, 2][trial]
    assert [row["reward"] for row in rows_of(samples(tmp_path))] == ["1.0", "3.0"]


def test_infeasible_rows_stand_there_only_if_a_column_says_so(tmp_path):
    form = HistoryFormat(SPACE, OBJECTIVES)
    row = replace(evaluation(0), state=State.INFEASIBLE)
    Exports(form, samples_file=tmp_path / "without.csv").restore([row])
    form.columns = (*form.columns[:6], "Valid", *form.columns[6:])
    Exports(form, samples_file=tmp_path / "with.csv").restore([row])
    assert [len(rows_of(tmp_path / name)) for name in ("without.csv", "with.csv")] == [0, 1]


@pytest.mark.parametrize("cut", [0, 20, -1, -30, None])
def test_file_that_was_cut_anywhere_is_completed_from_the_history(tmp_path, cut, caplog):
    with open_run(tmp_path) as run:
        for trial in range(3):
            run.append_evaluation(evaluation(trial))
    whole = samples(tmp_path).read_bytes()
    samples(tmp_path).write_bytes(whole[:cut])
    with open_run(tmp_path) as run:
        assert samples(tmp_path).read_bytes() == whole
        run.append_evaluation(evaluation(3))
    assert [row["Timestamp"] for row in rows_of(samples(tmp_path))] == ["0", "1", "2", "3"]


def test_file_that_was_deleted_is_written_again(tmp_path):
    with open_run(tmp_path) as run:
        run.append_evaluation(evaluation(0))
        samples(tmp_path).unlink()
        run.append_evaluation(evaluation(1))
    assert len(rows_of(samples(tmp_path))) == 2


def test_files_of_something_else_are_kept_aside(tmp_path, caplog):
    (tmp_path / "out").mkdir()
    for name in ("samples.csv", "pareto.csv"):
        (tmp_path / "out" / name).write_text(f"x,y,Timestamp\n1,2,{name}\n")
    with caplog.at_level(logging.WARNING), open_run(tmp_path) as run:
        run.append_evaluation(evaluation(0))
        run.write_pareto()
    for name in ("samples.csv", "pareto.csv"):
        assert (tmp_path / "out" / f"{name}.bak-1").read_text() == f"x,y,Timestamp\n1,2,{name}\n"
        assert len(rows_of(tmp_path / "out" / name)) == 1
        assert f"{name}: it held something else than rows of this run, now in {name}.bak-1" in caplog.text


def test_own_files_are_not_kept_aside(tmp_path):
    for trial in range(3):
        with open_run(tmp_path) as run:
            run.append_evaluation(evaluation(trial, reward=float(trial)))
            run.write_pareto()
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["pareto.csv", "samples.csv"]


def test_second_run_in_the_same_file_is_an_error_and_no_flood_of_copies(tmp_path):
    with open_run(tmp_path) as run:
        run.append_evaluation(evaluation(0))
        with samples(tmp_path).open("a") as file:
            file.write("a row of another run\n")
        run.append_evaluation(evaluation(1))
        with samples(tmp_path).open("a") as file:
            file.write("a row of another run\n")
        with pytest.raises(RunFolderError, match="something else writes this file too"):
            run.append_evaluation(evaluation(2))
    assert (tmp_path / "out" / "samples.csv.bak-1").exists()


def test_front_counts_all_objectives_keeps_ties_and_leaves_others_out(tmp_path):
    three = (*OBJECTIVES, Objective(name="third"))
    values = [(1.0, 1.0, 9.0), (2.0, 1.0, 9.0), (1.0, 1.0, 0.0), (2.0, 1.0, 9.0)]
    with open_run(tmp_path, three) as run:
        for trial, value in enumerate(values):
            named = dict(zip(("reward", "cost", "third"), value, strict=True))
            run.append_evaluation(replace(evaluation(trial), values=named, standard_errors={}))
        run.append_evaluation(evaluation(4, None))
        run.write_pareto()
    assert [row["Timestamp"] for row in rows_of(tmp_path / "out" / "pareto.csv")] == ["1", "2", "3"]


def test_front_of_a_confirmed_configuration_is_still_this_run_when_it_goes_on(tmp_path, caplog):
    first = evaluation(0, reward=9.0, replicates=1)
    again = replace(
        first, suggestion=replace(first.suggestion, trial=1, phase="confirm"), values={"reward": 1.0, "cost": 4.0}
    )
    with open_run(tmp_path) as run:
        run.append_evaluation(first)
        run.append_evaluation(again)
        run.write_pareto()
    written = (tmp_path / "out" / "pareto.csv").read_text()
    assert "5.0,3.0" in written
    with caplog.at_level(logging.WARNING), open_run(tmp_path):
        assert (tmp_path / "out" / "pareto.csv").read_text() == written
    assert "it held something else" not in caplog.text
