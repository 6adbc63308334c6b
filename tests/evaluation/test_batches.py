"""Tests for batches.py, and for functions that take batches."""

import pytest

from hypermap_lite.evaluation.batches import BatchExecutor
from hypermap_lite.evaluation.executors import InProcessExecutor, ProcessExecutor
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.evaluation.python_function import PythonFunction
from tests.evaluation.examples import request


def batch_function(name):
    return PythonFunction(function=f"tests.evaluation.black_boxes:{name}", objectives=("f", "g"), batch=True)


def run(evaluator, requests, inner=None):
    executor = BatchExecutor(inner or InProcessExecutor())
    try:
        return list(executor.run(evaluator, requests))
    finally:
        executor.close()


@pytest.mark.parametrize("inner", [InProcessExecutor, lambda: ProcessExecutor(1)], ids=["here", "worker"])
def test_batch_is_one_call_with_lists(tmp_path, inner):
    records = run(
        batch_function("batch_of_spheres"), [request(tmp_path, trial=i, x=float(i)) for i in range(3)], inner()
    )
    assert [(r.trial, r.outcome.values) for r in records] == [(i, {"f": i**2 + 11.0, "g": float(i)}) for i in range(3)]
    assert [r.outcome.metrics["called with"] for r in records] == [3.0] * 3
    assert all(r.outcome.metrics["trial"] == r.trial for r in records)


def test_no_request_is_no_call(tmp_path):
    assert run(batch_function("crash"), []) == []


def test_exception_fails_the_whole_batch_and_says_so(tmp_path):
    records = run(batch_function("crash"), [request(tmp_path, trial=i) for i in (4, 5)])
    assert [r.outcome.state for r in records] == [State.FAILED] * 2
    assert records[1].outcome.error == "RuntimeError: no such luck (the one call for trials 4 to 5)"
    assert (tmp_path / "0004" / "replicate_0.traceback.log").exists()


def test_death_and_time_limit_are_those_of_the_batch(tmp_path):
    requests = [request(tmp_path, trial=i) for i in range(2)]
    dead = run(batch_function("exit_at_once"), requests, ProcessExecutor(1))
    late = run(batch_function("hang"), requests, ProcessExecutor(1, timeout_seconds=0.2))
    assert [r.outcome.state for r in dead + late] == [State.FAILED] * 2 + [State.TIMEOUT] * 2
    assert late[0].outcome.error == "ran past its time limit of 0.2 s and was killed (the one call for trials 0 to 1)"


def test_duration_of_the_call_is_shared(tmp_path):
    records = run(batch_function("batch_of_spheres"), [request(tmp_path, trial=i, x=0.0) for i in range(4)])
    assert len({r.seconds for r in records}) == 1


def test_single_request_to_a_batch_function_is_a_batch_of_one(tmp_path):
    outcome = batch_function("batch_of_spheres")(request(tmp_path, x=2.0))
    assert outcome.values == {"f": 15.0, "g": 2.0}
