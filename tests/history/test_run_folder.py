"""Tests for run_folder.py."""

import csv
import json
import logging
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import Outcome, State
from hypermap_lite.history.run_folder import RunFolder
from tests.history.examples import OBJECTIVES, SPACE, evaluation, folder, replicate


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_rows_read_back_in_the_next_session(tmp_path):
    with folder(tmp_path / "run") as run:
        run.append_replicate(replicate(0, speed=2.0))
        run.append_evaluation(evaluation(0))
        run.append_evaluation(evaluation(1, None))
    with folder(tmp_path / "run") as run:
        assert [(e.trial, e.error) for e in run.evaluations] == [(0, ""), (1, "it broke")]
        assert run.replicates == {(0, 0): replicate(0, speed=2.0)}


def test_row_is_in_the_file_when_append_returns(tmp_path):
    with folder(tmp_path) as run:
        for trial in range(3):
            run.append_evaluation(evaluation(trial))
            run.append_replicate(replicate(trial))
            assert [row["trial"] for row in rows_of(run.history_path)] == [str(t) for t in range(trial + 1)]
            assert [row["trial"] for row in rows_of(run.evaluations_path)] == [str(t) for t in range(trial + 1)]


def test_row_out_of_order_is_refused(tmp_path):
    with folder(tmp_path) as run, pytest.raises(RunFolderError, match="trial 1 is not the next one"):
        run.append_evaluation(evaluation(1))


def test_new_metric_gets_a_column_and_no_row_is_lost(tmp_path):
    with folder(tmp_path) as run:
        for row in (replicate(0), replicate(0, 1, speed=1.0), replicate(0, 2, seconds=9.0, speed=2.0)):
            run.append_replicate(row)
        rows = rows_of(run.evaluations_path)
    assert [(row["speed"], row["result.seconds"]) for row in rows] == [("", ""), ("1.0", ""), ("2.0", "9.0")]
    with folder(tmp_path) as run:
        assert run.replicates[0, 2].outcome.metrics == {"speed": 2.0, "seconds": 9.0}


def test_sorting_makes_the_file_independent_of_who_was_first(tmp_path):
    calls = [replicate(0, 0, a=1.0), replicate(0, 1, b=2.0), replicate(1, 0)]
    texts = []
    for name, order in (("x", calls), ("y", calls[::-1])):
        with folder(tmp_path / name) as run:
            for call in order:
                run.append_replicate(call)
            run.sort_replicates()
            texts.append(run.evaluations_path.read_text())
    assert texts[0] == texts[1]
    assert [line.split(",")[:2] for line in texts[0].splitlines()[1:]] == [["0", "0"], ["0", "1"], ["1", "0"]]


def test_front_has_the_non_dominated_completed_rows(tmp_path):
    with folder(tmp_path) as run:
        for trial, values in enumerate([(1.0, 1.0), (2.0, 2.0), (0.5, 2.0), (None, 0.0), (2.0, 2.0)]):
            run.append_evaluation(evaluation(trial, *values))
        run.write_pareto()
        assert [row["trial"] for row in rows_of(run.pareto_path)] == ["0", "1", "4"]


def test_front_without_rows_is_only_a_header(tmp_path):
    with folder(tmp_path) as run:
        run.write_pareto()
        assert rows_of(run.pareto_path) == []


def test_folder_of_another_scenario_is_refused(tmp_path):
    with folder(tmp_path):
        pass
    with pytest.raises(RunFolderError, match=r"another scenario\n  \$.seed: 1 there, 2 now"), folder(tmp_path, seed=2):
        pass


def test_folder_with_rows_of_unknown_meaning_is_refused(tmp_path):
    (tmp_path / "history.csv").write_text("a,b\n")
    with pytest.raises(RunFolderError, match=r"has a history.csv but no scenario.json"), folder(tmp_path):
        pass


def test_folder_in_use_is_refused(tmp_path):
    with folder(tmp_path), pytest.raises(RunFolderError, match="another process"), folder(tmp_path):
        pass


def test_folder_that_was_refused_is_not_left_locked(tmp_path):
    with folder(tmp_path):
        pass
    with pytest.raises(RunFolderError, match="another scenario"), folder(tmp_path, seed=2):
        pass
    with folder(tmp_path):
        pass


@settings(deadline=None, max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_cut_at_any_byte_loses_at_most_the_row_that_was_cut(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("run")
    lengths = []
    with folder(path) as run:
        for trial in range(3):
            run.append_evaluation(evaluation(trial))
            run.append_replicate(replicate(trial, speed=trial))
            lengths.append((run.history_path.stat().st_size, run.evaluations_path.stat().st_size))
    cuts = [data.draw(st.integers(0, size)) for size in lengths[-1]]
    for name, cut in zip(("history.csv", "evaluations.csv"), cuts, strict=True):
        (path / name).write_bytes((path / name).read_bytes()[:cut])
    with folder(path) as run:
        assert len(run.evaluations) == sum(size <= cuts[0] for size, _ in lengths)
        assert len(run.replicates) == sum(size <= cuts[1] for _, size in lengths)
        for trial in range(len(run.evaluations), 3):
            run.append_evaluation(evaluation(trial))
        for trial in range(len(run.replicates), 3):
            run.append_replicate(replicate(trial, speed=trial))
    assert (path / "history.csv").stat().st_size == lengths[-1][0]
    assert (path / "evaluations.csv").stat().st_size == lengths[-1][1]


def test_torn_line_is_reported_and_cut_off(tmp_path, caplog):
    with folder(tmp_path) as run:
        run.append_evaluation(evaluation(0))
        run.append_evaluation(evaluation(1))
        size = run.history_path.stat().st_size
    with (tmp_path / "history.csv").open("a") as file:
        file.write('0.5,"tor')
    with caplog.at_level(logging.WARNING), folder(tmp_path) as run:
        assert len(run.evaluations) == 2
        assert run.history_path.stat().st_size == size
    assert "history.csv: the last line was cut off" in caplog.text
    assert "the last line was cut off" in (tmp_path / "run.log").read_text()


def test_blank_lines_at_the_end_are_no_rows(tmp_path, caplog):
    with folder(tmp_path) as run:
        run.append_replicate(replicate(0))
        run.append_evaluation(evaluation(0))
    for name in ("history.csv", "evaluations.csv"):
        with (tmp_path / name).open("a") as file:
            file.write("\n \r\n\n")
    with caplog.at_level(logging.WARNING), folder(tmp_path) as run:
        run.append_replicate(replicate(1))
        run.append_evaluation(evaluation(1))
    assert caplog.text == ""
    with folder(tmp_path) as run:
        assert (len(run.evaluations), len(run.replicates)) == (2, 2)


@pytest.mark.parametrize("damage", ["deleted", "cut"])
def test_missing_calls_of_finished_trials_are_warned_of(tmp_path, caplog, damage):
    with folder(tmp_path) as run:
        for trial in range(3):
            run.append_replicate(replicate(trial))
            run.append_evaluation(evaluation(trial))
    lines = run.evaluations_path.read_text().splitlines(keepends=True)
    run.evaluations_path.write_text("".join(lines[:2])) if damage == "cut" else run.evaluations_path.unlink()
    with caplog.at_level(logging.WARNING), folder(tmp_path):
        pass
    n, first = (2, 1) if damage == "cut" else (3, 0)
    assert f"evaluations.csv: calls of {n} finished trials are missing, the first of trial {first}" in caplog.text
    assert "are missing" in (tmp_path / "run.log").read_text()


def test_record_of_the_scenario_is_written_only_when_the_rows_fit_it(tmp_path):
    with folder(tmp_path) as run:
        run.append_evaluation(evaluation(0))
        before = run.scenario_path.read_text()
    (tmp_path / "history.csv").write_text("a,b\n1,2\n")
    with pytest.raises(RunFolderError, match="columns are not those"), folder(tmp_path, description="other"):
        pass
    assert (tmp_path / "scenario.json").read_text() == before


def test_function_that_was_passed_is_recorded_and_another_is_warned_of(tmp_path, caplog):
    def opened(function):
        return RunFolder(tmp_path, space=SPACE, objectives=OBJECTIVES, canonical={"seed": 1}, function=function)

    with opened("robot.push") as run:
        assert json.loads(run.scenario_path.read_text())["versions"]["function"] == "robot.push"
    with caplog.at_level(logging.WARNING):
        with opened("robot.push"):
            assert caplog.text == ""
        with opened("robot.pull"):
            assert "the function called was robot.push before and is robot.pull now" in caplog.text
        with opened(None):
            assert "was robot.pull before and is the scenario's own evaluator now" in caplog.text
        with opened("robot.push"):
            assert "was the scenario's own evaluator before and is robot.push now" in caplog.text


def failed(call):
    return replace(call, outcome=Outcome(state=State.TIMEOUT, error="too slow"))


def test_failures_at_the_end_are_set_aside_with_their_calls(tmp_path):
    with folder(tmp_path) as run:
        for trial, reward in enumerate([None, 1.0, None, None]):
            run.append_replicate(failed(replicate(trial)) if reward is None else replicate(trial))
            run.append_evaluation(evaluation(trial, reward))
        run.append_replicate(failed(replicate(4)))
        run.append_replicate(replicate(4, 1))
        before = run.history_path.read_text(), run.evaluations_path.read_text()
        assert run.set_failures_aside() == 2
        assert [e.trial for e in run.evaluations] == [0, 1]
        assert run.set_failures_aside() == 0
    with folder(tmp_path) as run:
        assert [e.trial for e in run.evaluations] == [0, 1]
        assert list(run.replicates) == [(0, 0), (1, 0), (4, 1)]
    assert (tmp_path / "history.csv.bak-1").read_text() == before[0]
    assert (tmp_path / "evaluations.csv.bak-1").read_text() == before[1]
    assert not (tmp_path / "history.csv.bak-2").exists()


def test_run_of_failures_alone_starts_from_nothing(tmp_path):
    with folder(tmp_path) as run:
        run.append_replicate(failed(replicate(0)))
        run.append_evaluation(evaluation(0, None))
        assert run.set_failures_aside() == 1
        run.append_replicate(replicate(0))
        run.append_evaluation(evaluation(0))
    with folder(tmp_path) as run:
        assert [e.is_completed for e in run.evaluations] == [True]


def test_front_has_a_confirmed_configuration_once_with_its_mean(tmp_path):
    with folder(tmp_path) as run:
        lucky, other = evaluation(0, reward=9.0, cost=2.0, replicates=1), evaluation(1, reward=4.0, cost=1.0)
        again = replace(lucky.suggestion, trial=2, phase="confirm")
        for row in (lucky, other, replace(lucky, suggestion=again, values={"reward": 1.0, "cost": 0.5}, replicates=3)):
            run.append_evaluation(row)
        run.write_pareto()
        assert len(rows_of(run.history_path)) == 3
        first, second = rows_of(run.pareto_path)
        assert (first["trial"], first["reward"], first["cost"], first["replicates"]) == ("0", "3.0", "0.875", "4")
        assert second["trial"] == "1"


def test_pareto_is_written_again_only_where_the_front_has_changed(tmp_path):
    with folder(tmp_path) as run:
        run.append_evaluation(evaluation(0, 1.0, 1.0))
        run.write_pareto(only_if_changed=True)
        before = run.pareto_path.stat().st_mtime_ns
        run.append_evaluation(evaluation(1, 0.5, 2.0))  # dominated
        run.write_pareto(only_if_changed=True)
        assert run.pareto_path.stat().st_mtime_ns == before
        run.append_evaluation(evaluation(2, 2.0, 0.5))
        run.write_pareto(only_if_changed=True)
        assert [row["trial"] for row in rows_of(run.pareto_path)] == ["2"]
