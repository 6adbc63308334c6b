"""Driving the optimizer from a loop of one's own."""

import math

import pytest

from hypermap_lite import Optimizer
from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import State
from tests.optimizers.runs import run, scenario_of, two_objectives


def test_it_suggests_what_a_run_would() -> None:
    optimizer = Optimizer(scenario_of())
    for _ in range(8):
        for suggestion in optimizer.ask():
            optimizer.tell(suggestion, two_objectives(suggestion.configuration))
    assert [e.configuration for e in optimizer.history] == [e.configuration for e in run(scenario_of(), 8).history]


def test_it_goes_on_from_stored_evaluations() -> None:
    whole = run(scenario_of(), 9)
    optimizer = Optimizer(scenario_of(), evaluations=list(whole.history)[:8])
    assert optimizer.ask()[0].configuration == whole.history[8].configuration


def test_results_may_come_in_any_order_by_trial_number() -> None:
    optimizer = Optimizer(scenario_of())
    first, second = optimizer.ask(2)
    optimizer.tell(second.trial, {"near": 1, "far": 2})
    assert len(optimizer.history) == 0
    optimizer.tell(first.trial, {"near": 0, "far": 3})
    assert [e.values for e in optimizer.pareto_front()] == [{"near": 0.0, "far": 3.0}]
    assert optimizer.pending == []


@pytest.mark.parametrize(
    ("result", "state"),
    [
        (None, State.FAILED),
        ({"near": 1.0}, State.FAILED),
        ({"near": 1.0, "far": math.nan}, State.FAILED),
        ({"feasible": False}, State.INFEASIBLE),
        ({"near": 1.0, "far": 2.0}, State.COMPLETED),
    ],
)
def test_a_result_that_is_none_is_a_state(result: object, state: State) -> None:
    optimizer = Optimizer(scenario_of())
    evaluation = optimizer.tell(optimizer.ask()[0], result)
    assert evaluation.state is state
    assert bool(evaluation.error) == (state is not State.COMPLETED)


def test_a_failure_keeps_its_reason() -> None:
    optimizer = Optimizer(scenario_of())
    assert optimizer.tell(optimizer.ask()[0], error="the gripper lost the peg").error == "the gripper lost the peg"


def test_an_unknown_trial_is_refused() -> None:
    with pytest.raises(UsageError, match="trial 4 is not pending"):
        Optimizer(scenario_of()).tell(4, {"near": 1, "far": 1})


def test_nothing_told_means_an_empty_front() -> None:
    assert Optimizer(scenario_of()).pareto_front() == []


ASYNCHRONOUS = {
    "input_parameters": {"x": {"parameter_type": "real", "values": [0, 4]}},
    "objectives": [{"name": "loss"}],
    "design_of_experiment": {"number_of_samples": 4},
    "budget": {"asynchronous": True},
}


def test_an_asynchronous_optimizer_learns_from_a_result_before_an_earlier_one_is_there() -> None:
    optimizer = Optimizer(ASYNCHRONOUS)
    first, *others = optimizer.ask(4)
    for suggestion in others:
        optimizer.tell(suggestion, (suggestion.configuration["x"] - 1) ** 2)
    (by_model,) = optimizer.ask()
    assert by_model.trial == 4
    assert by_model.phase == "model"
    assert [e.trial for e in optimizer.history] == [1, 2, 3]
    assert [s.trial for s in optimizer.pending] == [0, 4]
    optimizer.tell(first, 1.0)
    assert [e.trial for e in optimizer.history] == [1, 2, 3, 0]


@pytest.mark.parametrize("n", [3, 6])
def test_an_asynchronous_optimizer_that_goes_on_asks_again_for_what_was_pending(n: int) -> None:
    optimizer = Optimizer(ASYNCHRONOUS)
    for suggestion in [s for s in optimizer.ask(n) if s.trial != 1]:
        optimizer.tell(suggestion, suggestion.configuration["x"])
    (pending,) = optimizer.pending
    restored = Optimizer(ASYNCHRONOUS, evaluations=list(optimizer.history))
    again, following = restored.ask(2)
    assert (again.trial, again.configuration) == (1, pending.configuration)
    assert following.trial == n
    for suggestion in (following, again):
        restored.tell(suggestion, suggestion.configuration["x"])
    assert [e.trial for e in restored.history] == [0, *range(2, n), n, 1]
    assert restored.ask()[0].trial == n + 1
