"""Failures that are told apart: what the model sees, and what everybody else does."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.evaluation.outcome import State
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.failures import SeparateModels
from hypermap_lite.reports.posterior_front import posterior_front
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import configurations, evaluate, resumed, run, scenario_of

FAILED = {"near": 3.0, "far": -3.0}


def succeeds(place: Configuration) -> bool:
    return float(place["a"]) < 0.55


def skill(place: Configuration) -> dict[str, float]:
    """Return how long a skill takes, to be short, and how gentle it is, to be high; it fails in half of the space."""
    a, b = float(place["a"]), float(place["b"]) / 5
    if not succeeds(place):
        return dict(FAILED)
    return {"near": 1 + 0.2 * (a - 0.3) ** 2 + 0.2 * (b - 0.5) ** 2, "far": 0.2 * b - 0.3 * (a - 0.3) ** 2}


SCENARIO = scenario_of(
    objectives=[{"name": "near", "reference_point": 2}, {"name": "far", "goal": "maximize", "reference_point": -1}],
    design_of_experiment={"number_of_samples": 16},
    budget={"evaluations": 40},
)


def told(n: int, **changes: Any) -> BayesianOptimizer:
    optimizer = run(SCENARIO | changes, n, function=skill)
    assert isinstance(optimizer, BayesianOptimizer)
    return optimizer


@pytest.fixture(scope="module")
def after_24() -> BayesianOptimizer:
    return told(24)


def failed_trials(optimizer: BayesianOptimizer) -> set[int]:
    return {e.trial for e in optimizer.history if not succeeds(e.configuration)}


def test_the_model_sees_failures_as_infeasible_and_nobody_else_does(after_24: BayesianOptimizer) -> None:
    failures = failed_trials(after_24)
    assert 3 <= len(failures) <= 21
    seen = after_24._models.history
    assert [e.trial for e in seen] == [e.trial for e in after_24.history]
    assert {e.trial for e in seen if e.state is State.INFEASIBLE} == failures
    assert all(e.is_completed for e in after_24.history)
    assert after_24.set_aside() == failures
    assert len(after_24.fitted()[1]) == 24 - len(failures)


def test_what_is_expected_of_success_knows_no_cliff_and_what_is_expected_of_all_does(
    after_24: BayesianOptimizer,
) -> None:
    places: list[Configuration] = [{"a": 0.5, "b": 2.0}, {"a": 0.95, "b": 2.0}]
    X = after_24.history.space.encode(places)
    of_success, of_all = after_24.predictor().predict(X).mean, after_24.predictor_of_all().predict(X).mean
    assert of_success[0] == pytest.approx([skill(places[0])["near"], -skill(places[0])["far"]], abs=0.05)
    assert of_success[1, 0] < 1.5
    assert of_all[1] == pytest.approx([FAILED["near"], -FAILED["far"]], abs=0.5)


def test_what_failures_say_of_the_other_objective_is_learnt() -> None:
    """Where the duration fails the effort goes on as before: the limit of a known front has nothing to do with it."""

    def function(place: Configuration) -> dict[str, float]:
        return skill(place) | {"far": float(np.sin(5 * float(place["a"]))) - float(place["b"]) / 50}

    optimizer = run(SCENARIO, 30, function=function)
    assert isinstance(optimizer, BayesianOptimizer)
    assert optimizer.set_aside() == failed_trials(optimizer)
    places: list[Configuration] = [{"a": a, "b": 1.0} for a in (0.7, 0.8, 0.9)]
    predicted = optimizer.predictor().predict(optimizer.history.space.encode(places)).mean
    assert predicted[:, 1] == pytest.approx([-function(place)["far"] for place in places], abs=0.05)
    assert (predicted[:, 0] < 1.6).all()


def test_failures_are_not_on_the_posterior_front(after_24: BayesianOptimizer) -> None:
    front = posterior_front(load_scenario(SCENARIO), after_24.history, after_24)
    assert not failed_trials(after_24) & {p.trial for p in front.predictions}


@pytest.mark.parametrize(
    "changes",
    [
        {"surrogate": {"separate_failures": False}},
        {"surrogate": "random_forest"},
        {"acquisition": {"feasibility_weighting": "none"}},
        {"preset": "paper"},
    ],
)
def test_without_the_option_or_a_model_of_the_feasibility_they_stay_among_the_others(
    changes: dict[str, Any], after_24: BayesianOptimizer
) -> None:
    optimizer = resumed(SCENARIO | changes, list(after_24.history))
    assert isinstance(optimizer, BayesianOptimizer)
    assert optimizer._models.history is optimizer.history
    assert optimizer.set_aside() == set()
    assert optimizer.predictor_of_all().predict(optimizer.history.X()).mean.shape == (24, 2)


def test_the_log_says_it_once(caplog: pytest.LogCaptureFixture, after_24: BayesianOptimizer) -> None:
    optimizer = resumed(SCENARIO, list(after_24.history))
    with caplog.at_level("INFO"):
        for _ in range(3):
            optimizer.tell([evaluate(s, skill) for s in optimizer.ask(2)])
    lines = [r.message for r in caplog.records if "kind of their own" in r.message]
    assert len(lines) == 1
    assert "with near above 2." in lines[0] or "with far below -" in lines[0]
    assert "the model learns where they are" in lines[0]


def test_a_resumed_run_goes_on_as_the_uninterrupted_one() -> None:
    whole = told(34)
    for n in (15, 19, 24, 29):
        again = resumed(SCENARIO, list(whole.history)[:n])
        while len(again.history) < 34:
            again.tell([evaluate(s, skill) for s in again.ask(1)])
        assert configurations(again) == configurations(whole)


def test_what_was_known_at_a_time_is_the_same_at_any_later_one(after_24: BayesianOptimizer) -> None:
    assert isinstance(after_24._separate, SeparateModels)
    early = resumed(SCENARIO, list(after_24.history)[:16])
    assert isinstance(early, BayesianOptimizer)
    at_once, later = early._separate, after_24._separate
    assert at_once.failures() == later.failures(16)
    before, after = at_once.after(16).evidence(16), later.after(16).evidence(16)
    assert before is not None
    assert after is not None
    X = after_24.history.X()
    assert np.array_equal(before.posterior.predict(X).mean, after.posterior.predict(X).mean)
    assert before.log_probability is not None
    assert after.log_probability is not None
    assert np.array_equal(before.log_probability(X), after.log_probability(X))


def test_in_the_order_in_which_they_finished_nothing_is_different() -> None:
    scenario = SCENARIO | {"budget": {"evaluations": 40, "asynchronous": True}}
    rows = list(told(20).history)
    rows[18], rows[19] = rows[19], rows[18]
    optimizer = resumed(scenario, rows)
    assert isinstance(optimizer, BayesianOptimizer)
    assert optimizer.set_aside() == failed_trials(optimizer)
    (suggestion,) = optimizer.ask(1)
    assert suggestion.trial == 20


def test_infeasible_and_broken_evaluations_stay_what_they_are(after_24: BayesianOptimizer) -> None:
    rows = list(after_24.history)
    success = next(i for i, row in enumerate(rows) if succeeds(row.configuration))
    rows[success] = replace(rows[success], state=State.FAILED, values={})
    optimizer = resumed(SCENARIO, rows)
    assert isinstance(optimizer, BayesianOptimizer)
    assert optimizer._models.history[success].state is State.FAILED
    assert optimizer.set_aside() == failed_trials(after_24)


@pytest.mark.slow
def test_a_search_among_failures_finds_more_of_the_successes() -> None:
    """Successes differ by a tenth of what separates them from failures."""

    def best(place: Configuration) -> float:
        return float(place["a"]) ** 2 + (float(place["b"]) / 5 + 0.4) ** 2

    def function(place: Configuration) -> dict[str, float]:
        return {"y": 0.1 * best(place) if abs(float(place["b"])) < 3.5 and float(place["a"]) < 0.5 else 2.0}

    gaps: dict[bool, list[float]] = {True: [], False: []}
    for separate, found in gaps.items():
        for seed in range(4):
            scenario = scenario_of(
                objectives=[{"name": "y"}],
                seed=seed,
                surrogate={"separate_failures": separate, "compress_tails": False},
                design_of_experiment={"number_of_samples": 12},
                budget={"evaluations": 26},
            )
            optimizer = run(scenario, 26, function=function)
            found.append(min(e.values["y"] for e in optimizer.history))
    assert np.mean(np.log(gaps[True])) < np.mean(np.log(gaps[False])) - 1


@pytest.mark.parametrize("optimizer", ["bayesian", "random_search"])
@pytest.mark.parametrize("objectives", [1, 2])
def test_the_front_that_is_confirmed_is_one_of_successes(optimizer: str, objectives: int) -> None:
    scenario = SCENARIO | {
        "objectives": SCENARIO["objectives"][:objectives],
        "optimizer": optimizer,
        "budget": {"evaluations": 30, "confirm_front": 4},
    }

    def function(place: Configuration) -> dict[str, float]:
        return {o["name"]: skill(place)[o["name"]] for o in scenario["objectives"]}

    confirmed = [e for e in run(scenario, 30, function=function).history if e.suggestion.phase == "confirm"]
    assert len(confirmed) == 4
    assert all(succeeds(e.configuration) for e in confirmed)


@pytest.mark.parametrize(
    "changes",
    [
        {"budget": {"evaluations": 40, "batch_size": 3}},
        {
            "input_parameters": {
                "a": {
                    "parameter_type": "real",
                    "values": [0, 1],
                    "prior": {"type": "gaussian", "mean": 0.9, "std": 0.1},
                },
                "b": {"parameter_type": "real", "values": [-5, 5]},
            }
        },
    ],
    ids=["batches", "misleading prior"],
)
@pytest.mark.slow
def test_so_does_a_run_in_batches_or_with_a_prior(changes: dict[str, Any]) -> None:
    scenario, batch = SCENARIO | changes, changes.get("budget", {}).get("batch_size", 1)
    whole = run(scenario, 34, batch=batch, function=skill)
    assert isinstance(whole, BayesianOptimizer)
    assert whole.set_aside()
    again = resumed(scenario, list(whole.history)[:24])
    while len(again.history) < 34:
        again.tell([evaluate(s, skill) for s in again.ask(min(batch, 34 - len(again.history)))])
    assert configurations(again) == configurations(whole)


def test_a_success_that_was_luck_is_not_on_the_posterior_front(after_24: BayesianOptimizer) -> None:
    """Where it was repeated it failed, twice."""
    rows = list(after_24.history)
    deepest = max(rows, key=lambda row: float(row.configuration["a"]))
    lucky = replace(deepest, values={"near": 0.5, "far": 1.0})
    rows[rows.index(deepest)] = lucky
    for trial in (24, 25):
        again = replace(deepest.suggestion, trial=trial, phase="confirm")
        rows.append(replace(deepest, suggestion=again))
    optimizer = resumed(SCENARIO, rows)
    assert isinstance(optimizer, BayesianOptimizer)
    assert {deepest.trial, 24, 25} <= optimizer.set_aside()
    assert deepest.trial in {e.trial for e in optimizer._models.history.completed}


def test_the_log_says_when_nothing_is_told_apart_any_more(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, after_24: BayesianOptimizer
) -> None:
    optimizer = resumed(SCENARIO, list(after_24.history))
    assert isinstance(optimizer, BayesianOptimizer)
    with caplog.at_level("INFO"):
        optimizer.set_aside()
        monkeypatch.setattr(optimizer._separate, "failures", lambda n=None: None)
        optimizer.set_aside()
        optimizer.set_aside()
    lines = [r.message for r in caplog.records if "kind of their own" in r.message or "told apart" in r.message]
    assert len(lines) == 2
    assert lines[1] == "after 24 completed evaluations: no evaluations are told apart any more"
