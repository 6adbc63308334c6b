"""Tests for runner.py."""

import csv
import logging
import math
from contextlib import closing
from dataclasses import replace

import pytest

from hypermap_lite.errors import ClientError, NoValidEvaluationError, RepeatedFailureError
from hypermap_lite.evaluation import runner as runner_module
from hypermap_lite.evaluation.batch_plan import BatchPlan
from hypermap_lite.evaluation.batches import BatchExecutor
from hypermap_lite.evaluation.evaluator import EvaluationRequest, call
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.observer import RunObserver
from hypermap_lite.evaluation.outcome import Outcome, State
from hypermap_lite.evaluation.python_function import PythonFunction
from hypermap_lite.evaluation.runner import Clock, Runner, StopReason
from hypermap_lite.evaluation.seeds import replicate_seed
from hypermap_lite.scenario.model import BudgetSpec
from tests.evaluation.examples import ScriptedOptimizer, folder, function

TIMINGS = {"Timestamp", "suggest_seconds", "evaluate_seconds", "seconds", "pid"}


class Killed(BaseException):
    """Stands for SIGKILL: nothing in between may catch it."""


def evaluate(request: EvaluationRequest) -> Outcome:
    x = request.configuration["x"]
    return Outcome(state=State.COMPLETED, values={"f": x**2 + request.seed * 1e-12, "g": (x - 1) ** 2})


class KilledAt:
    """Evaluates until the n-th call, counted from 0, which never returns."""

    def __init__(self, n):
        self.remaining = n

    def __call__(self, request):
        if self.remaining == 0:
            raise Killed
        self.remaining -= 1
        return evaluate(request)


def run(path, evaluator=evaluate, *, executor=None, optimizer=None, n=7, batch=1, minutes=None, **options):
    with folder(path) as open_folder, closing(executor or InProcessExecutor()) as open_executor:
        return Runner(
            optimizer=optimizer or ScriptedOptimizer(),
            evaluator=evaluator,
            executor=open_executor,
            folder=open_folder,
            budget=BudgetSpec(evaluations=n, batch_size=batch, minutes=minutes),
            seed=3,
            **options,
        ).run()


def rows(path, name):
    with (path / name).open(newline="") as file:
        return [{k: v for k, v in row.items() if k not in TIMINGS} for row in csv.DictReader(file)]


def everything(path):
    return [rows(path, name) for name in ("history.csv", "evaluations.csv", "pareto.csv")]


def test_run_uses_its_budget_and_writes_every_row(tmp_path):
    assert run(tmp_path, replicates=2) is StopReason.BUDGET
    assert [row["trial"] for row in rows(tmp_path, "history.csv")] == [str(t) for t in range(7)]
    calls = rows(tmp_path, "evaluations.csv")
    assert [(row["trial"], row["replicate"]) for row in calls] == [(str(t), str(r)) for t in range(7) for r in (0, 1)]
    assert calls[3]["seed"] == str(replicate_seed(3, 1, 1))


def test_row_is_the_mean_of_its_replicates(tmp_path):
    run(tmp_path, n=1, replicates=2)
    (row,) = rows(tmp_path, "history.csv")
    values = [float(call["f"]) for call in rows(tmp_path, "evaluations.csv")]
    assert float(row["f"]) == sum(values) / 2
    assert float(row["f_sem"]) == pytest.approx(abs(values[0] - values[1]) / 2)


@pytest.mark.parametrize(("batch", "replicates"), [(1, 1), (1, 3), (3, 1), (3, 2), (10, 2)])
def test_run_killed_at_any_call_ends_like_one_that_was_not(tmp_path, batch, replicates):
    options = {"n": 5, "batch": batch, "replicates": replicates}
    run(tmp_path / "whole", **options)
    for n in range(5 * replicates):
        path = tmp_path / str(n)
        with pytest.raises(Killed):
            run(path, KilledAt(n), **options)
        kept = rows(path, "evaluations.csv") if n else []
        assert len(kept) == n
        assert run(path, KilledAt(5 * replicates - n), **options) is StopReason.BUDGET
        assert everything(path) == everything(tmp_path / "whole")


def test_run_killed_again_and_again_ends_like_one_that_was_not(tmp_path):
    run(tmp_path / "whole", batch=3, replicates=2)
    for _ in range(13):
        with pytest.raises(Killed):
            run(tmp_path / "killed", KilledAt(1), batch=3, replicates=2)
    run(tmp_path / "killed", batch=3, replicates=2)
    assert everything(tmp_path / "killed") == everything(tmp_path / "whole")


@pytest.mark.parametrize("first", [1, 4])
def test_first_batch_of_another_size_stands_kills_too(tmp_path, first):
    options = {"n": 7, "batch": 2, "plan": BatchPlan(size=2, first=first)}
    run(tmp_path / "whole", **options)
    for n in range(7):
        path = tmp_path / str(n)
        with pytest.raises(Killed):
            run(path, KilledAt(n), **options)
        run(path, KilledAt(7 - n), **options)
        assert everything(path) == everything(tmp_path / "whole")


def test_batch_that_is_one_call_is_written_whole_before_the_run_is_stopped_for_failures(tmp_path):
    def fail_but_for_the_last(columns, trial):
        return {"f": [math.nan, math.nan, math.nan, 1.0], "g": [0.0] * 4}

    evaluator = PythonFunction(function=fail_but_for_the_last, objectives=("f", "g"), batch=True)
    executor = BatchExecutor(InProcessExecutor())
    run(tmp_path / "ends well", evaluator, executor=executor, n=4, batch=4, max_consecutive_failures=2)
    assert [row["state"] for row in rows(tmp_path / "ends well", "history.csv")] == ["failed"] * 3 + ["completed"]
    evaluator = PythonFunction(function=lambda columns: [None] * 4, objectives=("f", "g"), batch=True)
    with pytest.raises(RepeatedFailureError, match="the last 4 configurations"):
        run(tmp_path / "ends badly", evaluator, executor=executor, n=8, batch=4, max_consecutive_failures=2)
    assert len(rows(tmp_path / "ends badly", "history.csv")) == 4


def test_broken_client_leaves_the_folder_in_order(tmp_path, caplog):
    class Client:
        is_one_call = True

        def run(self, evaluator, requests):
            yield call(evaluator, next(iter(requests)))
            raise ClientError("the client is gone\n  hint: call it back")

        def close(self):
            pass

    with pytest.raises(ClientError):
        run(tmp_path, executor=Client(), n=4, batch=2)
    assert len(rows(tmp_path, "evaluations.csv")) == len(rows(tmp_path, "history.csv")) == 1
    assert (tmp_path / "pareto.csv").exists()
    assert "the run is stopped: the client is gone" in (tmp_path / "run.log").read_text()
    run(tmp_path, n=4, batch=2)
    run(tmp_path / "whole", n=4, batch=2)
    assert everything(tmp_path) == everything(tmp_path / "whole")


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_rows_do_not_depend_on_the_number_of_workers(tmp_path, workers):
    run(tmp_path / "one", function("sphere"), batch=3, replicates=2)
    run(tmp_path / "some", function("sphere"), executor=ProcessExecutor(workers), batch=3, replicates=2)
    assert everything(tmp_path / "some") == everything(tmp_path / "one")


def test_larger_budget_goes_on_where_the_run_ended(tmp_path):
    run(tmp_path / "whole", n=8, batch=3)
    run(tmp_path / "extended", n=4, batch=3)
    run(tmp_path / "extended", n=8, batch=3)
    assert everything(tmp_path / "extended") == everything(tmp_path / "whole")


def test_finished_run_evaluates_nothing_more(tmp_path):
    run(tmp_path)
    assert run(tmp_path, KilledAt(0)) is StopReason.BUDGET
    assert run(tmp_path, KilledAt(0), n=5) is StopReason.BUDGET
    assert len(rows(tmp_path, "history.csv")) == 7


def test_exhausted_space_ends_the_run_gracefully(tmp_path, caplog):
    with caplog.at_level(logging.INFO):
        assert run(tmp_path, optimizer=ScriptedOptimizer(n_available=4), batch=3) is StopReason.EXHAUSTED
    assert len(rows(tmp_path, "history.csv")) == 4
    assert "the search space holds no other configuration" in caplog.text
    assert run(tmp_path, optimizer=ScriptedOptimizer(n_available=4), batch=3) is StopReason.EXHAUSTED


def test_time_limit_of_the_run_counts_all_its_sessions(tmp_path, monkeypatch):
    now = [0.0]
    monkeypatch.setattr(runner_module.time, "monotonic", lambda: now[0])

    def take_20_seconds(request):
        now[0] += 20.0
        return evaluate(request)

    with pytest.raises(Killed):
        run(tmp_path, KilledAt(0), minutes=1.0)
    assert run(tmp_path, take_20_seconds, n=2, minutes=1.0) is StopReason.BUDGET
    now[0] += 3600.0
    assert run(tmp_path, take_20_seconds, minutes=1.0) is StopReason.TIME
    assert len(rows(tmp_path, "history.csv")) == 3


def test_clock_goes_on_from_the_last_row():
    assert 5000 <= Clock(5000).ms < 6000


def test_failures_are_rows_and_the_run_goes_on(tmp_path):
    run(tmp_path, function("crash_sometimes"))
    states = [row["state"] for row in rows(tmp_path, "history.csv")]
    assert states == ["failed", "completed", "completed", "failed", "completed", "completed", "completed"]
    assert rows(tmp_path, "history.csv")[0]["error"] == "ValueError: trial 0"
    assert (tmp_path / "trials" / "0003" / "replicate_0.traceback.log").exists()


def test_failures_in_a_row_stop_the_run_after_saving(tmp_path):
    with pytest.raises(
        RepeatedFailureError, match=r"last 3 configurations gave no usable result: RuntimeError: no such"
    ):
        run(tmp_path, function("crash"), max_consecutive_failures=3)
    assert len(rows(tmp_path, "history.csv")) == 3
    assert rows(tmp_path, "pareto.csv") == []


def test_run_stopped_for_failures_can_go_on(tmp_path):
    with pytest.raises(RepeatedFailureError):
        run(tmp_path, function("crash"), max_consecutive_failures=3)
    assert run(tmp_path, max_consecutive_failures=3) is StopReason.BUDGET
    assert len(rows(tmp_path, "history.csv")) == 7


def test_failures_before_a_kill_count(tmp_path):
    def crash_then_die(request):
        if request.trial == 2:
            raise Killed
        raise ValueError("no")

    with pytest.raises(Killed):
        run(tmp_path, crash_then_die, max_consecutive_failures=3)
    with pytest.raises(RepeatedFailureError):
        run(tmp_path, function("crash"), max_consecutive_failures=3)
    assert len(rows(tmp_path, "history.csv")) == 3


def test_infeasible_configurations_are_answers_not_failures(tmp_path):
    def refuse(request):
        return Outcome(state=State.INFEASIBLE, error="no") if request.trial < 6 else evaluate(request)

    assert run(tmp_path, refuse, max_consecutive_failures=2) is StopReason.BUDGET


def test_run_without_any_result_is_an_error(tmp_path):
    with pytest.raises(
        NoValidEvaluationError, match=r"none of the 4 evaluations(.|\n)*trial 0 failed: RuntimeError: no"
    ):
        run(tmp_path, function("crash"), n=4)


def test_stop_lets_running_calls_finish_and_loses_none(tmp_path):
    finished = []

    class Observer(RunObserver):
        def on_replicate(self, replicate):
            finished.append(replicate.trial)

    reason = run(tmp_path, batch=3, observer=Observer(), should_stop=lambda: len(finished) >= 4)
    assert reason is StopReason.INTERRUPTED
    assert [row["trial"] for row in rows(tmp_path, "history.csv")] == ["0", "1", "2", "3"]
    run(tmp_path, batch=3)
    run(tmp_path / "whole", batch=3)
    assert everything(tmp_path) == everything(tmp_path / "whole")


def test_interrupt_before_any_result_is_no_error(tmp_path):
    assert run(tmp_path, should_stop=lambda: True) is StopReason.INTERRUPTED


def test_configuration_that_was_evaluated_is_kept_if_the_optimizer_now_chooses_another(tmp_path, caplog):
    class Changed(ScriptedOptimizer):
        def _suggest(self, trial):
            return replace(super()._suggest(trial), configuration={"x": 1.25})

    with pytest.raises(Killed):
        run(tmp_path, KilledAt(5), batch=3, replicates=2)
    first = rows(tmp_path, "evaluations.csv")
    run(tmp_path, optimizer=Changed(), batch=3, replicates=2, n=3)
    assert [row["x"] for row in rows(tmp_path, "history.csv")] == [first[0]["x"], first[2]["x"], first[4]["x"]]
    assert "has been evaluated and is kept" in caplog.text


def test_observer_hears_of_every_step(tmp_path):
    heard = []

    class Observer(RunObserver):
        def on_start(self, *, done, total):
            heard.append(("start", done, total))

        def on_suggestions(self, trials, n_calls):
            heard.append(("suggestions", *trials, n_calls))

        def on_replicate(self, replicate):
            heard.append(("replicate", replicate.replicate))

        def on_evaluation(self, evaluation, front):
            heard.append(("evaluation", evaluation.trial, front))

    run(tmp_path, n=1, replicates=2, observer=Observer())
    assert heard == [
        ("start", 0, 1),
        ("suggestions", 0, 2),
        *(("replicate", 0), ("replicate", 1)),
        ("evaluation", 0, "front +1"),
    ]


def test_log_has_a_line_per_trial(tmp_path):
    run(tmp_path, n=2)
    lines = (tmp_path / "run.log").read_text().splitlines()
    assert sum(" trial " in line and " model completed 0.0 s f=" in line for line in lines) == 2


class LosesAnAnswer(InProcessExecutor):
    """Does not bring back the second call of a batch."""

    def run(self, evaluator, requests):
        yield from (record for i, record in enumerate(super().run(evaluator, requests)) if i != 1)


def test_result_that_does_not_arrive_ends_the_run_with_an_error(tmp_path):
    with pytest.raises(RuntimeError, match="trial 1 was evaluated, but its result did not arrive"):
        run(tmp_path, executor=LosesAnAnswer(), batch=3)
    assert [row["trial"] for row in rows(tmp_path, "evaluations.csv")] == ["0", "2"]


def test_black_box_that_forks_ends_like_one_that_does_not(tmp_path):
    assert run(tmp_path, function("fork"), executor=ProcessExecutor(2), batch=2) is StopReason.BUDGET
    assert [row["f"] for row in rows(tmp_path, "history.csv")] == [f"{t}.0" for t in range(7)]


def test_no_call_begins_before_the_one_before_it_is_written(tmp_path):
    unwritten = []

    class Observer(RunObserver):
        def on_replicate(self, replicate):
            begun = list((tmp_path / "trials").glob("*/begun"))
            unwritten.append(len(begun) - len(rows(tmp_path, "evaluations.csv")))

    run(tmp_path, function("note_that_it_began"), executor=ProcessExecutor(1), batch=3, observer=Observer())
    assert unwritten == [0] * 7
