"""Tests for executors.py."""

import os
import time

import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation import executors
from hypermap_lite.evaluation.command import Command
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.evaluation.python_function import PythonFunction
from tests.evaluation.black_boxes import DiesWhileLoading, RefusesToLoad
from tests.evaluation.examples import function, request


def requests(directory, n, **configuration):
    return [request(directory, trial=i, **configuration) for i in range(n)]


def test_calls_in_this_process_come_in_order(tmp_path):
    records = list(InProcessExecutor().run(function("crash_sometimes"), requests(tmp_path, 4)))
    states = [State.FAILED, State.COMPLETED, State.COMPLETED, State.FAILED]
    assert [r.outcome.state for r in records] == states


def test_workers_are_other_processes_that_stay(tmp_path):
    with ProcessExecutor(1) as executor:
        pids = {
            record.outcome.metrics["pid"]
            for start in (0, 1)
            for record in executor.run(function("sphere"), requests(tmp_path / str(start), 2))
        }
    assert len(pids) == 1
    assert os.getpid() not in pids


def test_workers_work_at_the_same_time(tmp_path):
    with ProcessExecutor(2) as executor:
        calls = executor.run(function("wait_for_others"), requests(tmp_path, 2, together=2, folder=str(tmp_path)))
        assert [record.outcome.error for record in calls] == ["", ""]


def test_call_past_the_time_limit_is_killed_with_its_children(tmp_path):
    target = tmp_path / "late"
    with ProcessExecutor(1, timeout_seconds=0.2) as executor:
        (record,) = executor.run(function("start_a_late_writer"), requests(tmp_path, 1, target=str(target)))
        assert record.outcome.state is State.TIMEOUT
        assert record.outcome.error == "ran past its time limit of 0.2 s and was killed"
        (following,) = executor.run(function("sphere"), [request(tmp_path)])
        assert following.outcome.state is State.COMPLETED
    assert (tmp_path / "late.started").exists()
    wait_until_gone_or(target)
    assert not target.exists()


def test_program_past_the_time_limit_is_killed_with_its_children(tmp_path):
    target = tmp_path / "late"
    script = f"(sleep 0.6; echo late > {target}) & touch {target}.started; sleep 60"
    command = Command(command=["/bin/sh", "-c", script], objectives=("f",))
    with ProcessExecutor(1, timeout_seconds=0.2) as executor:
        (record,) = executor.run(command, [request(tmp_path)])
        assert record.outcome.state is State.TIMEOUT
    assert (tmp_path / "late.started").exists()
    wait_until_gone_or(target)
    assert not target.exists()


def wait_until_gone_or(target):
    """Give a survivor the time to write its file."""
    deadline = time.monotonic() + 0.8
    while time.monotonic() < deadline and not target.exists():
        time.sleep(0.05)


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("segfault", "the worker process ended: killed by signal 11 (SIGSEGV)"),
        ("exit_at_once", "the worker process ended: exit status 3"),
        ("exit_politely", "SystemExit: enough"),
        ("interrupt", "KeyboardInterrupt"),
        ("close_everything", "the worker process ended: exit status 1"),
        ("crash", "RuntimeError: no such luck"),
    ],
)
def test_death_of_the_black_box_is_an_outcome_and_the_next_call_works(tmp_path, name, error):
    with ProcessExecutor(1) as executor:
        (record,) = executor.run(function(name), [request(tmp_path)])
        assert (record.outcome.state, record.outcome.error) == (State.FAILED, error)
        (following,) = executor.run(function("sphere"), [request(tmp_path)])
        assert following.outcome.state is State.COMPLETED


def test_deaths_in_a_row_are_told_apart_from_calls_that_work(tmp_path):
    with ProcessExecutor(2) as executor:
        records = list(executor.run(function("exit_at_once"), requests(tmp_path, 4)))
    assert sorted(r.trial for r in records) == [0, 1, 2, 3]


def test_output_goes_to_the_trials_folder_and_empty_logs_are_removed(tmp_path):
    with ProcessExecutor(1) as executor:
        (record,) = executor.run(function("chatty"), [request(tmp_path)])
        assert record.outcome.state is State.COMPLETED
        list(executor.run(function("sphere"), [request(tmp_path, trial=1)]))
    logs = tmp_path / "0000"
    assert (logs / "replicate_0.stdout.log").read_text() == "on stdout\nfrom a child\n"
    assert (logs / "replicate_0.stderr.log").read_text() == "on stderr\n"
    assert not (tmp_path / "0001").exists()


def test_what_a_dying_worker_said_is_kept(tmp_path):
    with ProcessExecutor(1) as executor:
        list(executor.run(function("segfault"), [request(tmp_path)]))
    assert "Segmentation fault" in (tmp_path / "0000" / "replicate_0.stderr.log").read_text()


def test_requests_are_taken_only_when_they_can_start(tmp_path):
    taken = []

    def ask():
        for item in requests(tmp_path, 3):
            taken.append(item.trial)
            yield item

    with ProcessExecutor(1) as executor:
        calls = executor.run(function("sphere"), ask())
        assert next(calls).trial == 0
        assert taken == [0]
        assert next(calls).trial == 1
        assert taken == [0, 1]
        calls.close()


def test_call_ends_once_though_the_black_box_forks(tmp_path):
    with ProcessExecutor(1) as executor:
        records = list(executor.run(function("fork"), requests(tmp_path, 5)))
        pids = {record.outcome.metrics["pid"] for record in records}
    assert [(r.trial, r.outcome.values["f"]) for r in records] == [(t, t) for t in range(5)]
    assert len(pids) == 1


def test_answer_to_another_request_is_dropped(tmp_path):
    with ProcessExecutor(1) as executor:
        records = list(executor.run(function("answer_for_another"), requests(tmp_path, 3)))
    assert [(r.trial, r.outcome.values["f"]) for r in records] == [(0, 0.0), (1, 1.0), (2, 2.0)]


def test_closed_streams_do_not_spoil_the_calls_that_follow(tmp_path):
    with ProcessExecutor(1) as executor:
        records = list(executor.run(function("close_stdout"), requests(tmp_path, 5)))
    assert [r.outcome.error for r in records] == [""] * 5
    for trial in range(5):
        assert (tmp_path / f"000{trial}" / "replicate_0.stdout.log").read_text() == f"trial {trial}\n"


@pytest.mark.parametrize("name", ["talk_much", "talk_much_and_hang"])
def test_log_keeps_its_beginning_and_its_end(tmp_path, name):
    with ProcessExecutor(1, timeout_seconds=0.3) as executor:
        list(executor.run(function(name), [request(tmp_path)]))
    text = (tmp_path / "0000" / "replicate_0.stdout.log").read_text()
    assert text.startswith("first\n")
    assert text.endswith("x\nlast\n")
    assert "bytes of this log were cut out here" in text
    assert len(text) < 2.1 * 2**20


def test_call_past_the_time_limit_can_stop_in_order(tmp_path):
    target = tmp_path / "stopped"
    script = f"trap 'echo stopped > {target}; exit 0' TERM; while :; do sleep 0.05; done"
    command = Command(command=["/bin/sh", "-c", script], objectives=("f",))
    with ProcessExecutor(1, timeout_seconds=0.2) as executor:
        for evaluator in (command, function("stop_when_told")):
            (record,) = executor.run(evaluator, [request(tmp_path, target=str(target))])
            assert record.outcome.state is State.TIMEOUT
            assert target.read_text().strip() == "stopped"
            target.unlink()


def test_call_that_does_not_stop_in_order_is_killed(tmp_path, monkeypatch):
    monkeypatch.setattr(executors, "GRACE_SECONDS", 0.1)
    command = Command(command=["/bin/sh", "-c", "trap '' TERM; while :; do sleep 0.05; done"], objectives=("f",))
    with ProcessExecutor(1, timeout_seconds=0.2) as executor:
        for evaluator in (command, function("ignore_sigterm")):
            (record,) = executor.run(evaluator, [request(tmp_path)])
            assert record.outcome.state is State.TIMEOUT


def test_abandoned_calls_are_killed(tmp_path):
    with ProcessExecutor(2) as executor:
        calls = executor.run(function("crash_sometimes"), requests(tmp_path, 6))
        next(calls)
        calls.close()
        assert [r.outcome.state for r in executor.run(function("sphere"), [request(tmp_path)])] == [State.COMPLETED]


def test_function_that_only_exists_here_is_refused_with_advice(tmp_path):
    evaluator = PythonFunction(function=lambda c: 1.0, objectives=("f",))
    with ProcessExecutor(2) as executor, pytest.raises(UsageError, match=r"cannot be sent(.|\n)*hint: Move it"):
        list(executor.run(evaluator, [request(tmp_path)]))


def test_black_box_that_a_worker_cannot_load_ends_the_run(tmp_path):
    with (
        ProcessExecutor(1) as executor,
        pytest.raises(UsageError, match="not load the evaluator: ImportError: no such"),
    ):
        list(executor.run(RefusesToLoad(), [request(tmp_path)]))


def test_worker_that_dies_while_loading_ends_the_run(tmp_path):
    with ProcessExecutor(1) as executor, pytest.raises(UsageError, match="exit status 5, before it had loaded"):
        list(executor.run(DiesWhileLoading(), [request(tmp_path)]))


def test_closing_twice_does_no_harm(tmp_path):
    executor = ProcessExecutor(1)
    list(executor.run(function("sphere"), [request(tmp_path)]))
    executor.close()
    executor.close()
