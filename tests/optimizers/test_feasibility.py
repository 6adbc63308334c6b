"""Unknown constraints in Bayesian optimization: every method with every other, and the faults that are easily made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.acquisition import ACQUISITIONS
from hypermap_lite.assembly import build_optimizer
from hypermap_lite.design.sobol import Sobol
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers import Optimizer
from hypermap_lite.optimizers.first_feasible import WINDOW, points_left
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.scenario.loader import load_scenario
from tests.optimizers.runs import configurations, evaluate, resumed, run, scenario_of
from tests.slow import slow_after

LIGHT = {"type": "local_search", "candidates": 64, "starts": 1}
GAUSSIAN = {"type": "gaussian", "mean": 0.6, "std": 0.3}


def is_feasible(suggestion: Suggestion) -> bool:
    return float(suggestion.configuration["a"]) > 0.4


def told(suggestion: Suggestion, worth: float | None = None) -> Evaluation:
    """Evaluate; an infeasible point has no values, or the same worth for all objectives."""
    if is_feasible(suggestion):
        return evaluate(suggestion)
    values = {} if worth is None else {"near": worth, "far": -worth}
    return Evaluation(suggestion=suggestion, state=State.INFEASIBLE, values=values, error="no")


def constrained(scenario: Mapping[str, Any], n: int, *, batch: int = 1, worth: float | None = None) -> Optimizer:
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        optimizer.tell([told(s, worth) for s in optimizer.ask(batch)])
    return optimizer


def mixed_space(prior: Mapping[str, Any] | None) -> dict[str, Any]:
    return {
        "a": {"parameter_type": "real", "values": [0, 1], "prior": prior},
        "n": {"parameter_type": "ordinal", "values": [1, 2, 4, 8, 16]},
        "c": {"parameter_type": "categorical", "values": ["x", "y", "z"]},
    }


def judged(suggestion: Suggestion, m: int) -> Evaluation:
    """Evaluate m objectives on the mixed space, where a third of the points is feasible."""
    c = suggestion.configuration
    a, n = float(c["a"]), float(c["n"])
    values = {"f0": a, "f1": (a - 1) ** 2 + n / 16, "f2": -n * a}
    state = State.COMPLETED if c["c"] != "y" and a + n / 16 > 0.5 and n < 16 else State.INFEASIBLE
    return Evaluation(suggestion=suggestion, state=state, values={f"f{k}": values[f"f{k}"] for k in range(m)})


@pytest.mark.parametrize(
    ("scalarization", "m", "prior"),
    slow_after(
        3,
        [
            ("linear", 1, "no_prior"),
            ("linear", 2, "prior"),
            ("tchebyshev", 3, "no_prior"),
            ("linear", 1, "prior"),
            ("linear", 2, "no_prior"),
            ("linear", 3, "no_prior"),
            ("linear", 3, "prior"),
            ("tchebyshev", 2, "no_prior"),
            ("tchebyshev", 2, "prior"),
            ("tchebyshev", 3, "prior"),
        ],
    ),
)
@pytest.mark.parametrize("acquisition", ACQUISITIONS)
@pytest.mark.parametrize("surrogate", ["gaussian_process", {"type": "random_forest", "number_of_trees": 8}], ids=str)
def test_every_combination_gives_legal_batches_and_goes_on_as_it_would_have(
    surrogate: Any, acquisition: str, scalarization: str, m: int, prior: str
) -> None:
    samples = {"samples": 8} if "improvement" in acquisition else {}
    scenario = scenario_of(
        input_parameters=mixed_space(GAUSSIAN if prior == "prior" else None),
        objectives=[{"name": f"f{k}"} for k in range(m)],
        surrogate=surrogate,
        acquisition={"type": acquisition, "scalarization": scalarization, **samples},
        maximizer=LIGHT,
        design_of_experiment={"type": "random_sampling", "number_of_samples": 6},
    )
    optimizer = build_optimizer(load_scenario(scenario))
    optimizer.tell([judged(s, m) for s in optimizer.ask(6)])
    assert 1 <= len(optimizer.history.completed) <= 5
    optimizer.tell([judged(s, m) for s in optimizer.ask(3)])
    stored = list(optimizer.history)
    batch = optimizer.ask(3)
    again = resumed(scenario, stored).ask(3)
    assert [replace(s, seconds=0) for s in again] == [replace(s, seconds=0) for s in batch]
    every = [*configurations(optimizer), *(s.configuration for s in batch)]
    assert all(optimizer.history.space.contains(c) for c in every)
    assert len({str(c) for c in every}) == 12
    assert all(np.isfinite(s.acquisition_value) for s in batch)
    assert {s.phase for s in batch} == {"model"}


@pytest.mark.parametrize("acquisition", ACQUISITIONS)
def test_without_an_infeasible_evaluation_nothing_changes(acquisition: str) -> None:
    by_default = run(scenario_of(acquisition=acquisition, maximizer=LIGHT), 9)
    off = {"type": acquisition, "feasibility_weighting": "none"}
    assert configurations(by_default) == configurations(run(scenario_of(acquisition=off, maximizer=LIGHT), 9))
    assert [e.suggestion.phase for e in by_default.history] == ["design"] * 5 + ["model"] * 4


@pytest.mark.parametrize("acquisition", ACQUISITIONS)
@pytest.mark.parametrize("worth", [-1e6, 1e6])
def test_values_of_infeasible_points_are_no_incumbents_and_train_no_model(acquisition: str, worth: float) -> None:
    scenario = scenario_of(acquisition=acquisition, maximizer=LIGHT)
    without, with_values = constrained(scenario, 9), constrained(scenario, 9, worth=worth)
    assert any(not is_feasible(e.suggestion) for e in without.history)
    assert configurations(with_values) == configurations(without)
    assert len(with_values.history.Y()) == len(with_values.history.completed) < 9
    assert np.abs(with_values.history.Y()).max() < 10


@pytest.mark.parametrize("acquisition", ACQUISITIONS)
@pytest.mark.parametrize("surrogate", slow_after(1, ["gaussian_process", "random_forest"]))
def test_no_acquisition_seeks_out_the_infeasible(acquisition: str, surrogate: str) -> None:
    scenario = scenario_of(acquisition=acquisition, surrogate=surrogate, maximizer=LIGHT)
    optimizer = constrained(scenario, 17)
    by_model = [e.is_completed for e in optimizer.history if e.suggestion.phase == "model"]
    assert np.mean(by_model) >= 0.5


def test_weighting_can_be_switched_off() -> None:
    off = scenario_of(acquisition={"feasibility_weighting": "none"}, maximizer=LIGHT)
    assert configurations(constrained(off, 9)) != configurations(constrained(scenario_of(maximizer=LIGHT), 9))


BY_CLASSIFIER = {"feasibility_weighting": {"first_feasible": "classifier"}}


def test_while_all_are_infeasible_the_classifier_goes_where_nobody_was_and_draws_nothing_at_random() -> None:
    scenario = scenario_of(design_of_experiment={"number_of_samples": 4}, acquisition=BY_CLASSIFIER)
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < 12:
        suggestions = optimizer.ask(2)
        optimizer.tell([Evaluation(suggestion=s, state=State.INFEASIBLE) for s in suggestions])
    assert [e.suggestion.phase for e in optimizer.history] == ["design"] * 4 + ["model"] * 8
    X = optimizer.history.X_all()
    distances = np.linalg.norm(X[:, None] - X[None], axis=2) + 9 * np.eye(len(X))
    assert distances[4:].min() > 0.1


def all_infeasible(scenario: Mapping[str, Any], n: int, *, batch: int = 1) -> Optimizer:
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        optimizer.tell([Evaluation(suggestion=s, state=State.INFEASIBLE) for s in optimizer.ask(batch)])
    return optimizer


@pytest.mark.parametrize("batch", [1, 3])
@pytest.mark.parametrize("dimension", [2, 6])
def test_while_all_are_infeasible_each_point_of_the_designs_sequence_has_its_turn(dimension: int, batch: int) -> None:
    parameters = {f"x{j}": {"parameter_type": "real", "values": [0, 1]} for j in range(dimension)}
    scenario = scenario_of(
        input_parameters=parameters,
        design_of_experiment={"type": "sobol", "number_of_samples": 8},
        budget={"evaluations": 48},
    )
    optimizer = all_infeasible(scenario, 48, batch=batch)
    phases = [e.suggestion.phase for e in optimizer.history]
    assert phases == ["design"] * 8 + ["model", "random"] * 20
    first = Sobol().points(
        optimizer.history.space, ProductPrior(dimension), 28, generator(scenario["seed"], Stream.DESIGN)
    )
    assert not optimizer.history.space.unseen(first, optimizer.taken_keys()).any()
    assert all((e.suggestion.acquisition_value is None) == (e.suggestion.phase != "model") for e in optimizer.history)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_no_point_of_the_sequence_has_two_turns_however_its_digits_are_rounded(scale: str) -> None:
    bounds = {"wire": [0.05, 2], "coil": [0.25, 1.3], "number": [2, 15]}
    parameters = {name: {"parameter_type": "real", "values": values, "scale": scale} for name, values in bounds.items()}
    for seed in range(3, 6):
        scenario = scenario_of(
            input_parameters=parameters,
            design_of_experiment={"type": "sobol", "number_of_samples": 8},
            budget={"evaluations": 90},
            seed=seed,
        )
        optimizer = all_infeasible(scenario, 90)
        X = optimizer.history.X_all()
        distances = np.abs(X[:, None] - X[None]).max(axis=2) + np.eye(len(X))
        assert distances.min() > 1e-6
        first = Sobol().points(optimizer.history.space, ProductPrior(3), 49, generator(seed, Stream.DESIGN))
        assert np.abs(first[:, None] - X[None]).max(axis=2).min(axis=1).max() < 1e-9


def test_a_region_at_a_bound_of_one_axis_is_found_though_the_classifier_looks_elsewhere() -> None:
    def n_until_feasible(acquisition: Mapping[str, Any]) -> int:
        parameters = {f"x{j}": {"parameter_type": "real", "values": [0, 1]} for j in range(4)}
        budget = {"evaluations": 60}
        scenario = scenario_of(input_parameters=parameters, budget=budget, acquisition=acquisition, maximizer=LIGHT)
        optimizer = build_optimizer(load_scenario(scenario))
        for n in range(50):
            (suggestion,) = optimizer.ask()
            if float(suggestion.configuration["x2"]) < 0.04:
                return n
            optimizer.tell([Evaluation(suggestion=suggestion, state=State.INFEASIBLE)])
        return 50

    assert n_until_feasible({}) < 35
    assert n_until_feasible(BY_CLASSIFIER) == 50


def test_a_prior_leads_the_search_for_the_first_feasible_point_but_for_its_free_steps() -> None:
    scenario = scenario_of(budget={"evaluations": 40})
    scenario["input_parameters"]["a"] |= {"prior": {"type": "gaussian", "mean": 0.2, "std": 0.1}}
    rows = list(all_infeasible(scenario, 30).history)
    later = [e.suggestion for e in rows if e.suggestion.phase not in {"design", "default"}]
    assert {s.phase for s in later if s.prior_weight} == {"model"}
    assert {s.phase for s in later if s.prior_weight == 0} == {"random"}
    assert np.mean([bool(s.prior_weight) for s in later]) > 0.5


def test_the_search_for_the_first_feasible_point_goes_on_after_a_resume() -> None:
    scenario = scenario_of(budget={"evaluations": 24}, seed=3)
    whole = all_infeasible(scenario, 24)
    for n in (9, 14, 19):
        (again,) = resumed(scenario, list(whole.history)[:n]).ask()
        assert replace(again, seconds=0.0) == replace(whole.history[n].suggestion, seconds=0.0)


def test_where_the_sequence_has_nothing_left_the_search_goes_on() -> None:
    scenario = scenario_of(
        input_parameters={"n": {"parameter_type": "integer", "values": [0, 30]}},
        objectives=[{"name": "near"}],
        budget={"evaluations": 31},
    )
    optimizer = all_infeasible(scenario, 31)
    assert sorted(int(e.configuration["n"]) for e in optimizer.history) == [*range(31)]
    assert "random" in [e.suggestion.phase for e in optimizer.history]


def test_where_constraints_leave_little_of_the_space_the_sequence_is_followed_as_far_as_it_takes() -> None:
    scenario = scenario_of(constraints=["a + b <= 0.2"], budget={"evaluations": 30})
    scenario["input_parameters"] = {n: {"parameter_type": "real", "values": [0, 1]} for n in "ab"}
    optimizer = all_infeasible(scenario, 30)
    phases = [e.suggestion.phase for e in optimizer.history]
    n_design = phases.count("design")
    assert phases[n_design:] == [("random" if t % 2 else "model") for t in range(n_design, 30)]
    assert len(points_left(optimizer.history.space, 3, optimizer.taken_keys())) == WINDOW


def test_the_first_feasible_point_is_found_sooner_than_by_chance() -> None:
    def n_until_feasible(seed: int) -> int:
        parameters = {name: {"parameter_type": "real", "values": [-20, 20]} for name in ("x1", "x2")}
        scenario = scenario_of(input_parameters=parameters, seed=seed, maximizer=LIGHT)
        optimizer = build_optimizer(load_scenario(scenario))
        rng = np.random.default_rng(seed)
        while len(optimizer.history) < 5:  # instead of the design: five infeasible points
            (asked,) = optimizer.ask()
            x1, x2 = rng.uniform(-20, 20, 2)
            if not chakong_haimes({"x1": x1, "x2": x2})[1]:
                optimizer.adopt(replace(asked, configuration={"x1": float(x1), "x2": float(x2)}))
                optimizer.tell([Evaluation(suggestion=optimizer.pending[0], state=State.INFEASIBLE)])
            else:
                optimizer._pending.clear()
        for n in range(1, 30):
            (suggestion,) = optimizer.ask()
            if chakong_haimes(suggestion.configuration)[1]:
                return n
            optimizer.tell([Evaluation(suggestion=suggestion, state=State.INFEASIBLE)])
        return 30

    assert np.mean([n_until_feasible(seed) for seed in range(4)]) <= 5  # six by chance, twenty in the corners


def test_a_single_feasible_point_draws_the_search_near_but_not_onto_it() -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(design_of_experiment={"number_of_samples": 8})))
    design = optimizer.ask(8)
    optimizer.tell([evaluate(s) if s.trial == 2 else Evaluation(suggestion=s, state=State.INFEASIBLE) for s in design])
    (suggestion,) = optimizer.ask()
    X, X_infeasible = optimizer.history.X(), optimizer.history.X_all()[[0, 1, 3, 4, 5, 6, 7]]
    (x,) = optimizer.history.space.encode([suggestion.configuration])
    assert 0.03 < np.linalg.norm(x - X[0]) < np.linalg.norm(x - X_infeasible, axis=1).min()


UNTAUGHT = {"feasibility_weighting": {"learn_failed": False}}
"""Failed evaluations tell nothing."""


def failing_below(bound: float, scenario: Mapping[str, Any], n: int, state: State = State.FAILED) -> Optimizer:
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        for s in optimizer.ask():
            fails = float(s.configuration["a"]) < bound
            optimizer.tell([Evaluation(suggestion=s, state=state, error="no") if fails else evaluate(s)])
    return optimizer


@pytest.mark.parametrize("state", slow_after(1, [State.FAILED, State.TIMEOUT]))
def test_failures_tell_of_feasibility_what_infeasible_evaluations_do(state: State) -> None:
    scenario = scenario_of(budget={"evaluations": 20})
    failed = failing_below(0.4, scenario, 20, state)
    infeasible = failing_below(0.4, scenario, 20, State.INFEASIBLE)
    assert configurations(failed) == configurations(infeasible)
    assert failed.history.feasibility()[1].all()
    assert failed.history.feasibility(learn_failed=True)[1].tolist() == [e.is_completed for e in failed.history]


@pytest.mark.parametrize("surrogate", slow_after(1, ["gaussian_process", "random_forest"]))
def test_the_search_does_not_come_back_to_where_evaluations_fail(surrogate: str) -> None:
    """The best of the first objective is where all fail."""
    scenario = scenario_of(budget={"evaluations": 30}, surrogate={"type": surrogate}, maximizer=LIGHT)
    failures = {}
    for name, acquisition in {"taught": {}, "untaught": UNTAUGHT}.items():
        history = failing_below(0.4, scenario | {"acquisition": acquisition}, 30).history
        failures[name] = sum(not row.is_completed for row in list(history)[5:])
    assert failures["taught"] <= 12 < failures["untaught"]


def test_failures_that_tell_nothing_are_replaced_by_draws() -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(acquisition=UNTAUGHT)))
    optimizer.tell([Evaluation(suggestion=s, state=State.FAILED) for s in optimizer.ask(5)])
    assert optimizer.history.feasibility()[1].tolist() == []
    assert optimizer.ask()[0].phase == "random"


def test_while_all_fail_the_search_goes_where_none_has() -> None:
    optimizer = build_optimizer(load_scenario(scenario_of(budget={"evaluations": 20})))
    optimizer.tell([Evaluation(suggestion=s, state=State.FAILED) for s in optimizer.ask(5)])
    for _ in range(6):
        (suggestion,) = optimizer.ask()
        assert suggestion.phase == ("random" if suggestion.trial % 2 else "model")
        x = optimizer.history.space.encode([suggestion.configuration])
        assert np.linalg.norm(optimizer.history.X_all() - x, axis=1).min() > 0.05
        optimizer.tell([Evaluation(suggestion=suggestion, state=State.FAILED)])


def test_a_resumed_run_has_learnt_from_the_same_failures() -> None:
    scenario = scenario_of(budget={"evaluations": 16})
    whole = failing_below(0.4, scenario, 16)
    (again,) = resumed(scenario, list(whole.history)[:12]).ask()
    assert replace(again, seconds=0.0) == replace(whole.history[12].suggestion, seconds=0.0)


def chakong_haimes(c: Mapping[str, Any]) -> tuple[dict[str, float], bool]:
    x1, x2 = float(c["x1"]), float(c["x2"])
    values = {"f1": 2 + (x1 - 2) ** 2 + (x2 - 1) ** 2, "f2": 9 * x1 - (x2 - 1) ** 2}
    return values, x1**2 + x2**2 <= 225 and x1 - 3 * x2 + 10 <= 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_the_front_of_chakong_and_haimes_is_found_by_feasible_evaluations(seed: int) -> None:
    scenario = scenario_of(
        input_parameters={name: {"parameter_type": "real", "values": [-20, 20]} for name in ("x1", "x2")},
        objectives=[{"name": "f1"}, {"name": "f2"}],
        design_of_experiment={"type": "random_sampling", "number_of_samples": 20},
        budget={"evaluations": 70},
        seed=seed,
    )
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < 70:
        (suggestion,) = optimizer.ask()
        values, ok = chakong_haimes(suggestion.configuration)
        state = State.COMPLETED if ok else State.INFEASIBLE
        optimizer.tell([Evaluation(suggestion=suggestion, state=state, values=values)])
    assert hypervolume(optimizer.history.Y(), np.array([260.0, 20.0])) > 0.93 * 37_865
    assert np.mean([e.is_completed for e in list(optimizer.history)[20:]]) >= 0.8
