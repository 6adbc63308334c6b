"""Runs whose workers do not wait for each other."""

import csv
import heapq
from contextlib import closing
from dataclasses import replace

import pytest

from hypermap_lite.errors import RepeatedFailureError
from hypermap_lite.evaluation.asynchronous import AsynchronousRunner
from hypermap_lite.evaluation.evaluator import call
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.outcome import Outcome, State
from hypermap_lite.evaluation.runner import Runner, StopReason
from hypermap_lite.history.history import History
from hypermap_lite.history.suggestions import SuggestionLog
from hypermap_lite.scenario.model import BudgetSpec
from tests.evaluation.examples import OBJECTIVES, SPACE, ScriptedOptimizer, folder, function

TIMINGS = {"Timestamp", "suggest_seconds", "evaluate_seconds", "seconds", "pid"}


class Killed(BaseException):
    """Stands for SIGKILL: nothing in between may catch it."""


class Workers:
    """Makes w calls at a time, each as long as a table says, on a clock of its own; may be killed at the n-th end."""

    is_one_call = False

    def __init__(self, n_workers, durations=(), *, killed_at=None):
        self.n_workers = n_workers
        self.durations = durations
        self.remaining = killed_at
        self.n_busy = []

    def run(self, evaluator, requests):
        waiting, running, now = iter(requests), [], 0.0
        while True:
            while len(running) < self.n_workers and (request := next(waiting, None)) is not None:
                length = self.durations[request.trial % len(self.durations)] if self.durations else 1.0
                heapq.heappush(running, (now + length, request.trial, request.replicate, request))
            if not running:
                return
            self.n_busy.append(len(running))
            if self.remaining == 0:
                raise Killed
            self.remaining = None if self.remaining is None else self.remaining - 1
            now, *_, request = heapq.heappop(running)
            yield call(evaluator, request)

    def close(self):
        pass


def evaluate(request):
    x = request.configuration["x"]
    return Outcome(state=State.COMPLETED, values={"f": x**2 + request.seed * 1e-12, "g": (x - 1) ** 2})


def run(path, executor, *, evaluator=evaluate, n=8, runner=AsynchronousRunner, in_order=False, **options):
    optimizer = options.pop("optimizer", None) or ScriptedOptimizer(History(SPACE, OBJECTIVES, in_order=in_order))
    retry_failed = options.pop("retry_failed", False)
    with folder(path) as open_folder, closing(executor):
        driver = runner(
            optimizer=optimizer,
            evaluator=evaluator,
            executor=executor,
            folder=open_folder,
            budget=BudgetSpec(evaluations=n, asynchronous=True),
            seed=3,
            **options,
        )
        if retry_failed:
            driver.set_failures_aside()
        return driver.run()


def rows(path, name):
    with (path / name).open(newline="") as file:
        return [{k: v for k, v in row.items() if k not in TIMINGS} for row in csv.DictReader(file)]


SLOW = (9.0, 1.0, 2.5, 1.0)
"""Every fourth call is far slower than the others."""


@pytest.mark.parametrize("replicates", [1, 3])
@pytest.mark.parametrize("in_order", [False, True])
def test_workers_are_busy_until_there_is_nothing_more_to_begin(tmp_path, replicates, in_order):
    workers = Workers(3, SLOW)
    assert run(tmp_path, workers, n=12, replicates=replicates, in_order=in_order) is StopReason.BUDGET
    assert set(workers.n_busy[:-2]) == {3}
    assert len(workers.n_busy) == 12 * replicates


def test_rows_stand_in_the_order_of_trials_and_calls_in_that_of_their_ends(tmp_path):
    run(tmp_path, Workers(3, SLOW))
    assert [int(row["trial"]) for row in rows(tmp_path, "history.csv")] == list(range(8))
    assert [int(row["trial"]) for row in rows(tmp_path, "evaluations.csv")] == [1, 3, 2, 5, 6, 7, 0, 4]


def test_a_suggestion_rests_on_all_that_has_finished_and_counts_the_others_as_pending(tmp_path):
    run(tmp_path, Workers(3, SLOW))
    finished = [int(row["trial"]) for row in rows(tmp_path, "evaluations.csv")]
    by_trial = {int(row["trial"]): row for row in rows(tmp_path, "history.csv")}
    log = SuggestionLog(tmp_path, SPACE).read()
    assert [asked.known for asked in log] == [0, 0, 0, 1, 2, 3, 4, 5]
    with folder(tmp_path) as open_folder:
        evaluations = {e.trial: e for e in open_folder.evaluations}
    for asked in log:
        known = finished[: asked.known]
        optimizer = ScriptedOptimizer(History(SPACE, OBJECTIVES, in_order=False))
        optimizer.history.extend(evaluations[trial] for trial in known)
        optimizer.expect([a.suggestion for a in log[: asked.suggestion.trial] if a.suggestion.trial not in known])
        (again,) = optimizer.ask()
        assert again.trial == asked.suggestion.trial
        assert again.configuration == asked.suggestion.configuration
        assert by_trial[again.trial]["x"] == str(again.configuration["x"])


@pytest.mark.parametrize("replicates", [1, 2])
@pytest.mark.parametrize("in_order", [False, True])
def test_a_killed_run_loses_no_call_and_repeats_no_question(tmp_path, replicates, in_order):
    options = {"replicates": replicates, "in_order": in_order}
    for n in range(8 * replicates):
        path = tmp_path / str(n)
        with pytest.raises(Killed):
            run(path, Workers(3, SLOW, killed_at=n), **options)
        calls = rows(path, "evaluations.csv") if n else []
        asked = rows(path, "suggestions.csv")
        assert len(calls) == n
        second = Workers(3, SLOW)
        assert run(path, second, **options) is StopReason.BUDGET
        assert rows(path, "evaluations.csv")[:n] == calls
        assert rows(path, "suggestions.csv")[: len(asked)] == asked
        assert len(second.n_busy) == 8 * replicates - n
        assert [row["x"] for row in rows(path, "history.csv")] == [row["x"] for row in rows(path, "suggestions.csv")]


def test_a_run_stopped_between_two_calls_ends_like_one_that_was_not(tmp_path):
    workers = Workers(1)
    run(tmp_path / "whole", workers)
    for n in range(1, 8):
        path = tmp_path / str(n)
        with pytest.raises(Killed):
            run(path, Workers(1, killed_at=n))
        run(path, Workers(1))
        for name in ("history.csv", "evaluations.csv", "suggestions.csv", "pareto.csv"):
            assert rows(path, name) == rows(tmp_path / "whole", name)


def test_the_order_in_which_evaluations_finished_survives_a_stop(tmp_path):
    class Watched(ScriptedOptimizer):
        def _suggest(self, trial):
            seen.append([e.trial for e in self.history])
            return super()._suggest(trial)

    seen = []
    with pytest.raises(Killed):
        run(tmp_path, Workers(3, SLOW, killed_at=6), optimizer=Watched(History(SPACE, OBJECTIVES, in_order=False)))
    before = seen[-1]
    seen.clear()
    run(tmp_path, Workers(3, SLOW), n=9, optimizer=Watched(History(SPACE, OBJECTIVES, in_order=False)))
    assert before == [1, 3, 2, 5, 6]
    assert seen == [[1, 3, 2, 5, 6, 7]]


def test_what_was_in_flight_keeps_the_part_of_the_prior_in_its_choice(tmp_path):
    class Trusting(ScriptedOptimizer):
        def _suggest(self, trial):
            return replace(super()._suggest(trial), prior_weight=0.5, prior_trust=0.25, prior_of="g")

    def trusting():
        return Trusting(History(SPACE, OBJECTIVES, in_order=False))

    with pytest.raises(Killed):
        run(tmp_path, Workers(3, SLOW, killed_at=4), optimizer=trusting())
    resumed = trusting()
    run(tmp_path, Workers(3, SLOW), optimizer=resumed)
    suggestions = [e.suggestion for e in resumed.history]
    assert {(s.prior_weight, s.prior_trust, s.prior_of) for s in suggestions if s.trial in (0, 4)} == {(0.5, 0.25, "g")}


def test_one_worker_asks_what_a_run_without_batches_asks(tmp_path):
    run(tmp_path / "asynchronous", InProcessExecutor())
    run(tmp_path / "plain", InProcessExecutor(), runner=Runner, in_order=True)
    assert rows(tmp_path / "asynchronous", "history.csv") == rows(tmp_path / "plain", "history.csv")


def test_an_orderly_stop_keeps_what_was_running_and_begins_nothing_more(tmp_path):
    n_calls = 0

    def counting(request):
        nonlocal n_calls
        n_calls += 1
        return evaluate(request)

    reason = run(tmp_path, Workers(3, SLOW), evaluator=counting, should_stop=lambda: n_calls >= 2)
    assert reason is StopReason.INTERRUPTED
    assert n_calls == 4
    assert len(rows(tmp_path, "evaluations.csv")) == 4
    assert run(tmp_path, Workers(3, SLOW)) is StopReason.BUDGET
    assert len(rows(tmp_path, "history.csv")) == 8


def test_a_small_space_ends_the_run_when_all_of_it_is_evaluated(tmp_path):
    optimizer = ScriptedOptimizer(History(SPACE, OBJECTIVES, in_order=False), n_available=5)
    assert run(tmp_path, Workers(3, SLOW), optimizer=optimizer) is StopReason.EXHAUSTED
    assert len(rows(tmp_path, "history.csv")) == 5


def test_failures_in_a_row_end_the_run(tmp_path):
    def fail(request):
        return Outcome(state=State.FAILED, error="broken")

    with pytest.raises(RepeatedFailureError, match="the last 3 configurations"):
        run(tmp_path, Workers(3), evaluator=fail, max_consecutive_failures=3)
    assert len(rows(tmp_path, "history.csv")) == 3


@pytest.mark.parametrize("in_order", [False, True])
@pytest.mark.parametrize("replicates", [1, 2])
def test_failures_that_are_set_aside_leave_no_trace(tmp_path, in_order, replicates):
    def unplugged(request):
        return Outcome(state=State.FAILED, error="unplugged") if request.trial >= 3 else evaluate(request)

    options = {"in_order": in_order, "replicates": replicates}
    run(tmp_path / "whole", Workers(1), **options)
    path = tmp_path / "mended"
    with pytest.raises(RepeatedFailureError):
        run(path, Workers(1), evaluator=unplugged, max_consecutive_failures=3, **options)
    assert len(rows(path, "suggestions.csv")) == 6
    assert run(path, Workers(1), retry_failed=True, **options) is StopReason.BUDGET
    for name in ("history.csv", "evaluations.csv", "suggestions.csv", "pareto.csv"):
        assert rows(path, name) == rows(tmp_path / "whole", name)
    assert len((path / "suggestions.csv.bak-1").read_text().splitlines()) == 7


def test_what_was_asked_without_knowledge_of_a_failure_or_has_a_call_stays(tmp_path):
    def unplugged(request):
        return Outcome(state=State.FAILED, error="unplugged") if request.trial in (2, 3) else evaluate(request)

    with pytest.raises(Killed):  # finished: 1, 3, 2, 5; trial 4 knows of 1, trials 5 and more of a failure
        run(tmp_path, Workers(3, SLOW, killed_at=4), evaluator=unplugged)
    asked = rows(tmp_path, "suggestions.csv")
    assert [row["known"] for row in asked] == ["0", "0", "0", "1", "2", "3", "4"]
    run(tmp_path, Workers(3, SLOW), retry_failed=True, n=7)
    assert rows(tmp_path, "suggestions.csv")[:6] == asked[:6]
    (last,) = rows(tmp_path, "suggestions.csv")[6:]
    assert last["trial"] == "6"
    assert last["x"] != asked[6]["x"]
    assert [row["state"] for row in rows(tmp_path, "history.csv")] == ["completed"] * 7


def test_a_lost_record_of_the_questions_loses_no_evaluation(tmp_path):
    with pytest.raises(Killed):
        run(tmp_path, Workers(3, SLOW, killed_at=5))
    calls = rows(tmp_path, "evaluations.csv")
    (tmp_path / "suggestions.csv").unlink()
    run(tmp_path, Workers(3, SLOW))
    assert rows(tmp_path, "evaluations.csv")[:5] == calls
    assert len(rows(tmp_path, "evaluations.csv")) == len(rows(tmp_path, "history.csv")) == 8


def test_processes_evaluate_without_waiting_for_each_other(tmp_path):
    executor = ProcessExecutor(2)
    assert run(tmp_path, executor, evaluator=function("sphere"), n=6) is StopReason.BUDGET
    assert [row["state"] for row in rows(tmp_path, "history.csv")] == ["completed"] * 6
