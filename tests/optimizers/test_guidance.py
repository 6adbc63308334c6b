"""Tests for guidance.py: which prior takes part in a suggestion, as runs show it."""

import logging
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.evaluation.outcome import RANDOM
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.runs import configurations, evaluate, fail, resumed, run, scenario_of


def valley(configuration: Any) -> dict[str, float]:
    """Return a function that is best at a = 0.2, b = 0."""
    return {"near": (configuration["a"] - 0.2) ** 2 + configuration["b"] ** 2 / 25}


def believing(a: float, **weighting: Any) -> dict[str, Any]:
    """Return a scenario with one objective and a belief of some strength over both parameters."""
    parameters = {
        "a": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": a, "std": 0.03}},
        "b": {"parameter_type": "real", "values": [-5, 5], "prior": {"type": "gaussian", "mean": 0, "std": 0.5}},
    }
    return scenario_of(
        input_parameters=parameters,
        objectives=[{"name": "near"}],
        acquisition={"prior_weighting": weighting},
        design_of_experiment={"number_of_samples": 8},
        budget={"evaluations": 30},
    )


def suggestions(optimizer: Any) -> list[Any]:
    return [evaluation.suggestion for evaluation in optimizer.history]


def test_prior_free_steps_are_a_share_of_the_model_based_ones_and_have_no_weight() -> None:
    optimizer = run(believing(0.25, prior_free=0.3, safeguard=False), 28, function=valley)
    weights = [s.prior_weight for s in suggestions(optimizer)[8:]]
    assert 2 <= weights.count(0.0) <= 12
    assert {s.phase for s in suggestions(optimizer)[8:]} == {"model"}
    beta = 0.1 * (30 - 8)
    guided = [w for w in weights if w]
    assert guided == pytest.approx([beta / n for n in range(1, len(guided) + 1)])


def test_a_share_of_one_is_a_search_by_the_acquisition_alone() -> None:
    changes = {"prior_free": 1.0, "safeguard": False}
    free = run(believing(0.9, **changes), 12, function=valley)
    without = run(believing(0.9, beta=0.0, prior_free=0.0, safeguard=False), 12, function=valley)
    assert configurations(free) == configurations(without)


def test_steps_with_the_prior_are_those_of_a_run_that_has_no_others() -> None:
    some = run(believing(0.9, prior_free=0.5, safeguard=False), 20, function=valley)
    free = [s.prior_weight == 0 for s in suggestions(some)]
    first = free.index(True, 8)
    all_guided = run(believing(0.9, prior_free=0.0, safeguard=False), first, function=valley)
    assert configurations(some)[:first] == configurations(all_guided)


def test_a_misleading_prior_is_halved_twice_and_dropped_and_the_history_says_so() -> None:
    optimizer = run(believing(0.95), 20, function=valley)
    trust = [s.prior_trust for s in suggestions(optimizer)]
    assert trust[:8] == [None] * 8
    assert trust[8] == 0.5
    assert list(dict.fromkeys(trust[8:])) == [0.5, 0.25, 0.0]
    assert trust[8:] == sorted(trust[8:], reverse=True)
    assert all(s.prior_weight == 0 for s in suggestions(optimizer) if s.prior_trust == 0)
    halved = next(s for s in suggestions(optimizer)[8:] if s.prior_weight)
    assert halved.prior_weight == pytest.approx(halved.prior_trust * 2.2)


def make_up_draws(chosen: list[Any]) -> list[Any]:
    """Return the uniform draws that follow the end of the trust in a prior."""
    return [s for s in chosen if (s.phase, s.prior_weight, s.prior_trust) == (RANDOM, 0.0, 0.0)]


@pytest.mark.parametrize(("share", "expected"), [(0.25, 6), (0.0, 8)])
def test_draws_all_over_the_space_make_up_for_those_from_a_dropped_prior(share: float, expected: int) -> None:
    scenario = believing(0.95)
    scenario["design_of_experiment"] |= {"type": "prior_sampling", "uniform_share": share}
    scenario["budget"] = {"evaluations": 50}
    chosen = suggestions(run(scenario, 40, function=valley))
    first = next((i for i, s in enumerate(chosen) if s.prior_trust == 0), len(chosen))
    if share:
        assert chosen[first : first + expected] == make_up_draws(chosen)
        assert np.ptp([s.configuration["a"] for s in make_up_draws(chosen)]) > 0.4
    assert len(make_up_draws(chosen)) == expected
    assert RANDOM not in {s.phase for s in chosen[:first]}


def test_no_draws_make_up_late_in_a_run_or_where_they_are_not_wanted() -> None:
    late = believing(0.95)
    late["budget"] = {"evaluations": 20}
    assert not make_up_draws(suggestions(run(late, 20, function=valley)))
    assert not make_up_draws(suggestions(run(believing(0.95, make_up=False), 30, function=valley)))
    sobol = believing(0.95)
    sobol["design_of_experiment"] |= {"type": "sobol"}
    assert not make_up_draws(suggestions(run(sobol, 30, function=valley)))


def test_draws_from_the_prior_make_up_for_nothing() -> None:
    scenario = believing(0.95)
    scenario["budget"] = {"evaluations": 60}
    scenario["acquisition"] |= {"feasibility_weighting": {"learn_failed": False}}
    optimizer = build_optimizer(load_scenario(scenario))
    for _ in range(11):  # as long as all fail, configurations are drawn from the prior
        optimizer.tell([fail(s) for s in optimizer.ask()])
    while len(optimizer.history) < 40:
        optimizer.tell([evaluate(s, valley) for s in optimizer.ask()])
    chosen = suggestions(optimizer)
    assert [s.phase for s in chosen[8:11]] == [RANDOM] * 3
    assert len(make_up_draws(chosen)) == 6


def test_a_good_prior_is_kept() -> None:
    optimizer = run(believing(0.22), 25, function=valley)
    assert {s.prior_trust for s in suggestions(optimizer)[8:]} == {1.0}


def test_without_a_safeguard_nothing_is_checked() -> None:
    optimizer = run(believing(0.95, safeguard=False), 12, function=valley)
    assert {s.prior_trust for s in suggestions(optimizer)} == {None}


def test_what_is_decided_is_said_once(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    optimizer = run(believing(0.95), 20, function=valley)
    said = [(r.levelname, r.getMessage()) for r in caplog.records if "prior" in r.getMessage()]
    assert [level for level, _ in said] == ["INFO", "INFO", "WARNING"]
    assert said[0][1].startswith("after 8 evaluations the prior is in doubt: its region has given less than the rest")
    assert said[2][1].endswith("the run goes on without it")
    caplog.clear()
    resumed(believing(0.95), list(optimizer.history)).ask()
    assert not [r for r in caplog.records if "prior" in r.getMessage()]


@pytest.mark.parametrize("a", [0.22, 0.95])
def test_a_resumed_run_trusts_as_the_uninterrupted_one(a: float) -> None:
    whole = run(believing(a), 17, function=valley)
    for stop in (8, 9, 10, 11, 12, 13, 16):
        (again,) = resumed(believing(a), list(whole.history)[:stop]).ask()
        expected = whole.history[stop].suggestion
        assert replace(again, seconds=0) == replace(expected, seconds=0)


@pytest.mark.parametrize("n_done", [8, 11, 14])
def test_a_batch_shares_the_trust_in_what_was_completed_before_it(n_done: int) -> None:
    whole = run(believing(0.95), 8, function=valley)
    while len(whole.history) < 17:
        whole.tell([evaluate(s, valley) for s in whole.ask(3)])
    batch = resumed(believing(0.95), list(whole.history)[:n_done]).ask(3)
    assert len({s.prior_trust for s in batch}) == 1
    expected = [row.suggestion for row in list(whole.history)[n_done : n_done + 3]]
    assert [replace(s, seconds=0) for s in batch] == [replace(s, seconds=0) for s in expected]


def test_a_history_that_was_read_without_trust_leads_to_the_same() -> None:
    whole = run(believing(0.95), 14, function=valley)
    bare = [
        replace(row, suggestion=replace(row.suggestion, prior_trust=None, prior_weight=None)) for row in whole.history
    ]
    (again,) = resumed(believing(0.95), bare[:13]).ask()
    assert again.prior_trust == whole.history[13].suggestion.prior_trust


def test_a_region_in_which_everything_is_infeasible_is_dropped() -> None:
    scenario = believing(0.95) | {"feasible_output": {"name": "fits"}}
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < 18:
        (suggestion,) = optimizer.ask()
        row = evaluate(suggestion, valley)
        if suggestion.configuration["a"] > 0.7:
            row = replace(fail(suggestion), state=type(row.state).INFEASIBLE)
        optimizer.tell([row])
    assert suggestions(optimizer)[-1].prior_trust == 0


def test_one_completed_evaluation_is_no_evidence() -> None:
    optimizer = build_optimizer(load_scenario(believing(0.95)))
    for _ in range(10):
        (suggestion,) = optimizer.ask()
        optimizer.tell([evaluate(suggestion, valley) if suggestion.trial == 0 else fail(suggestion)])
    (suggestion,) = optimizer.ask()
    assert suggestion.prior_trust is None or suggestion.prior_trust == 1.0


def two_beliefs(near: float, far: float, **changes: Any) -> dict[str, Any]:
    """Return a scenario in which each objective has a belief of its own on the first parameter."""
    objectives = [
        {"name": "near", "priors": {"a": {"type": "gaussian", "mean": near, "std": 0.03}}},
        {"name": "far", "goal": "maximize", "priors": {"a": {"type": "gaussian", "mean": far, "std": 0.03}}},
    ]
    return scenario_of(
        objectives=objectives, design_of_experiment={"number_of_samples": 8}, budget={"evaluations": 30}, **changes
    )


def test_design_and_guided_steps_follow_the_objectives_in_turn_and_say_whom() -> None:
    optimizer = run(two_beliefs(0.2, 0.8), 20)
    design = suggestions(optimizer)[:8]
    assert [s.prior_of for s in design] == ["near", "far", "near", "", "near", "far", "near", ""]
    assert [s.prior_weight for s in design] == [1, 1, 1, 0, 1, 1, 1, 0]
    places = [s.configuration["a"] for s in design if s.prior_of]
    assert places == pytest.approx([{"near": 0.2, "far": 0.8}[s.prior_of] for s in design if s.prior_of], abs=0.12)
    assert {s.prior_of for s in suggestions(optimizer)[8:]} == {"near", "far"}


def test_an_objective_without_a_belief_of_its_own_has_the_common_one() -> None:
    b = {"parameter_type": "real", "values": [-5, 5], "prior": {"type": "gaussian", "mean": 1, "std": 0.1}}
    scenario = two_beliefs(0.2, 0.8, input_parameters={"a": {"parameter_type": "real", "values": [0, 1]}, "b": b})
    scenario["objectives"][1].pop("priors")
    design = suggestions(run(scenario, 8))
    assert [s.prior_of for s in design][:3] == ["near", "far", "near"]
    assert [s.configuration["b"] for s in design if s.prior_weight] == pytest.approx([1] * 6, abs=0.5)
    assert np.ptp([s.configuration["a"] for s in design if s.prior_of == "far"]) > 0.2


def test_trust_is_kept_per_objective_and_steps_follow_whom_is_trusted() -> None:
    optimizer = run(two_beliefs(0.2, 0.01), 28)
    rows = suggestions(optimizer)[8:]
    trust = {name: [s.prior_trust for s in rows if s.prior_of == name] for name in ("near", "far")}
    assert set(trust["near"]) == {1.0}
    assert 0.0 not in trust["far"]
    assert trust["far"][-1] < 1.0
    assert {s.prior_of for s in rows[-5:]} == {"near"}


def test_a_resumed_run_follows_the_same_objectives() -> None:
    whole = run(two_beliefs(0.2, 0.01), 16)
    for stop in (5, 8, 11, 15):
        (again,) = resumed(two_beliefs(0.2, 0.01), list(whole.history)[:stop]).ask()
        assert replace(again, seconds=0) == replace(whole.history[stop].suggestion, seconds=0)


def test_the_paper_preset_takes_no_care() -> None:
    scenario = believing(0.95, method="pibo") | {"preset": "paper"}
    optimizer = run(scenario, 12, function=valley)
    assert {s.prior_trust for s in suggestions(optimizer)} == {None}
    assert [s.prior_weight for s in suggestions(optimizer)][:8] == [None] * 8
    assert all(s.prior_weight > 0 for s in suggestions(optimizer)[8:])
