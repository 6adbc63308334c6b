"""What the model of the objectives learns from infeasible evaluations that report values."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_history, build_optimizer
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers import Optimizer
from hypermap_lite.optimizers.beside import FAR, MOST, telling, values_of_failures
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates.tails import Tail
from tests.optimizers.runs import configurations, resumed, scenario_of, two_objectives

Values = dict[str, float]
IGNORED: dict[str, Any] = {"surrogate": {"learn_infeasible": False}}
EDGE = 0.6


def row(trial: int, values: Values, *, state: State = State.INFEASIBLE, a: float | None = None) -> Evaluation:
    configuration = {"a": trial / 1000 if a is None else a, "b": 0.0}
    return Evaluation(
        suggestion=Suggestion(trial=trial, configuration=configuration, phase="model"), state=state, values=values
    )


def kept(*rows: Evaluation) -> list[int]:
    """Return the trials that are learned from, after feasible evaluations from 0 to 1 and from 10 to 30."""
    history = build_history(load_scenario(scenario_of()))
    history.append(row(0, {"near": 0.0, "far": 10.0}, state=State.COMPLETED))
    history.append(row(1, {"near": 1.0, "far": 30.0}, state=State.COMPLETED))
    history.extend(rows)
    return [e.suggestion.trial for e in telling(list(history), history.objectives)]


def test_values_of_their_own_near_the_feasible_ones_are_kept() -> None:
    assert kept(row(2, {"near": 1 + 0.99 * FAR, "far": 31.0}), row(3, {"near": -0.99 * FAR, "far": 0.0})) == [2, 3]


@pytest.mark.parametrize(
    "values",
    [{}, {"near": 0.5}, {"near": 0.5, "far": 1e9}, {"near": -1.01 * FAR, "far": 20.0}, {"near": 0.5, "far": -60.0}],
    ids=str,
)
def test_missing_and_far_values_are_not(values: Values) -> None:
    assert kept(row(2, values)) == []


def test_a_value_that_infeasible_configurations_share_is_a_placeholder() -> None:
    assert kept(
        row(2, {"near": -1.0, "far": 12.0}), row(3, {"near": -1.0, "far": 13.0}), row(4, {"near": 0.3, "far": 9.0})
    ) == [4]


def test_a_repeated_configuration_may_repeat_its_values() -> None:
    assert kept(row(2, {"near": 0.2, "far": 12.0}, a=0.5), row(3, {"near": 0.2, "far": 12.0}, a=0.5)) == [2, 3]


def test_a_penalty_of_a_feasible_one_makes_no_placeholder_near() -> None:
    history = build_history(load_scenario(scenario_of()))
    for trial, near in enumerate([0.0, 1.0, 1e5]):
        history.append(row(trial, {"near": near, "far": 10.0 + trial}, state=State.COMPLETED))
    history.extend([row(3, {"near": -2e4, "far": 11.0}), row(4, {"near": 1.5, "far": 11.5})])
    tail = Tail(limit=1.0, spread=1.0, highest=1e5, is_double=True)
    found = telling(list(history), history.objectives, (tail, None))
    assert [e.suggestion.trial for e in found] == [4]


def test_the_last_ones_are_kept_of_many() -> None:
    rows = [row(k, {"near": 0.5 + k / 1e4, "far": 20 + k / 1e3}) for k in range(2, 2 + MOST + 30)]
    assert kept(*rows) == [*range(32, 2 + MOST + 30)]


def test_failures_teach_nothing_and_without_feasible_ones_nothing_is_near() -> None:
    assert kept(row(2, {"near": 0.5, "far": 20.0}, state=State.FAILED)) == []
    history = build_history(load_scenario(scenario_of()))
    history.append(row(0, {"near": 0.5, "far": 20.0}))
    assert telling(list(history), history.objectives) == []


def test_of_failures_each_objective_tells_for_itself_but_for_the_one_they_fail_by() -> None:
    history = build_history(load_scenario(scenario_of()))
    successes = [row(0, {"near": 0.0, "far": 10.0}, state=State.COMPLETED)]
    successes.append(row(1, {"near": 1.0, "far": 30.0}, state=State.COMPLETED))
    values = [(0.5, 20.0), (9.0, 21.0), (0.6, 500.0), (9.0, 500.0)]
    failed = [row(2 + k, {"near": near, "far": far}) for k, (near, far) in enumerate(values)]
    by_near = values_of_failures(failed, successes, history.objectives, 0)
    assert np.array_equal(by_near, [[np.nan, -20], [np.nan, -21], [np.nan] * 2, [np.nan] * 2], equal_nan=True)
    by_far = values_of_failures(failed, successes, history.objectives, 1)
    assert np.array_equal(by_far, [[0.5, np.nan], [np.nan] * 2, [0.6, np.nan], [np.nan] * 2], equal_nan=True)


def constrained(n: int, answer: Callable[[Values], Values] = dict, **changes: Any) -> Optimizer:
    """Return an optimizer after n evaluations, of which those with a below the edge are infeasible."""
    optimizer = build_optimizer(load_scenario(scenario_of(**changes)))
    while len(optimizer.history) < n:
        optimizer.tell([judged(suggestion, answer) for suggestion in optimizer.ask()])
    return optimizer


def judged(suggestion: Suggestion, answer: Callable[[Values], Values] = dict) -> Evaluation:
    values = two_objectives(suggestion.configuration)
    if float(suggestion.configuration["a"]) > EDGE:
        return Evaluation(suggestion=suggestion, state=State.COMPLETED, values=values)
    return Evaluation(suggestion=suggestion, state=State.INFEASIBLE, values=answer(values))


def test_model_knows_what_lies_beyond_the_edge() -> None:
    errors = []
    for learns in (True, False):
        optimizer = constrained(11, surrogate={"learn_infeasible": learns}, budget={"evaluations": 20})
        beyond = np.array([[a, 0.5] for a in np.linspace(0.05, EDGE, 6)])
        truth = [two_objectives(c)["near"] for c in optimizer.history.space.decode(beyond)]
        errors.append(np.abs(optimizer.posterior().predict(beyond).mean[:, 0] - truth).mean())
    assert errors[0] < 0.7 * errors[1]


def test_infeasible_evaluations_are_on_no_front() -> None:
    """Their values tell of the objectives; a draw of them would be a front that nobody can have."""
    optimizer = constrained(12, lambda values: {"near": values["near"] - 1, "far": values["far"] + 1})
    n = len(optimizer.history.completed)
    assert 2 <= n < 12
    assert len(telling(list(optimizer.history), optimizer.history.objectives)) > 0
    posterior, rng = optimizer.posterior(), np.random.default_rng(0)
    pending = np.array([[0.9, 0.9], [0.8, 0.1]])
    draws = posterior.fantasies(pending, 8, rng).values
    assert draws.shape[1:] == (n + 2, 2)
    believed = posterior.believe(pending)
    assert believed.fantasies(pending[:0], 8, rng).values.shape[1:] == (n + 2, 2)
    predicted = posterior.predict(optimizer.history.X()).mean
    assert draws[:, :n].mean(axis=0) == pytest.approx(predicted, abs=0.15 * float(np.ptp(predicted)))


@pytest.mark.parametrize(
    "changes", [{}, {"evaluator": {"replicates": 2}, "surrogate": {"noise_from_replicates": True}}]
)
def test_a_resumed_run_goes_on_the_same(changes: dict[str, Any]) -> None:
    changes = changes | {"budget": {"evaluations": 20}}
    whole = constrained(16, **changes)
    for stop in (7, 9, 12):
        again = resumed(scenario_of(**changes), list(whole.history)[:stop])
        while len(again.history) < 16:
            again.tell([judged(suggestion) for suggestion in again.ask()])
        assert configurations(again) == configurations(whole)


@pytest.mark.parametrize("worth", [1e9, 0.0])
def test_placeholders_change_nothing(worth: float) -> None:
    """One far from all feasible values is known at once; another says nothing alone, and is known by a second."""

    def placeholder(values: Values) -> Values:
        return dict.fromkeys(values, worth)

    runs = [constrained(12, placeholder, **changes) for changes in ({}, IGNORED)]
    assert sum(row.state is State.INFEASIBLE for row in runs[0].history) > 2
    assert configurations(runs[0]) == configurations(runs[1])
    assert telling(list(runs[0].history), runs[0].history.objectives) == []


def test_a_posterior_is_of_the_rows_that_tell_now() -> None:
    """A row that repeats the value of an earlier one takes it out, so that the number of both need not change."""
    scenario = scenario_of(budget={"evaluations": 40})
    optimizer = constrained(10, budget={"evaluations": 40})
    optimizer.posterior()
    before = telling(list(optimizer.history), optimizer.history.objectives)
    known = dict(before[-1].values)
    rows = [
        row(10, {"near": known["near"], "far": known["far"] + 0.01}, a=0.31),
        row(11, {"near": known["near"] + 0.013, "far": known["far"] - 0.01}, a=0.33),
    ]
    optimizer.history.extend(rows)
    after = telling(list(optimizer.history), optimizer.history.objectives)
    assert len(after) == len(before)
    assert after != before
    Z = np.random.default_rng(0).random((5, 2))
    again = resumed(scenario, list(optimizer.history))
    assert np.array_equal(optimizer.posterior().predict(Z).mean, again.posterior().predict(Z).mean)


def test_a_run_without_infeasible_evaluations_is_the_same() -> None:
    runs = [
        build_optimizer(load_scenario(scenario_of(**changes, budget={"evaluations": 10}))) for changes in ({}, IGNORED)
    ]
    for optimizer in runs:
        while len(optimizer.history) < 9:
            told = [
                Evaluation(suggestion=s, state=State.COMPLETED, values=two_objectives(s.configuration))
                for s in optimizer.ask()
            ]
            optimizer.tell(told)
    assert configurations(runs[0]) == configurations(runs[1])
