"""Spaces with permutations, from the scenario to the history."""

from dataclasses import replace

import numpy as np
import pytest

from hypermap_lite import optimize
from hypermap_lite.assembly import build_optimizer, build_space
from hypermap_lite.errors import ScenarioError
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers import OPTIMIZERS
from hypermap_lite.plotting.parameters import plot_parameters
from hypermap_lite.scenario.lint import lint
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.scenario.summary import summarize
from hypermap_lite.typing import as_argument
from tests.optimizers.runs import resumed, run, scenario_of

ORDER = {"parameter_type": "permutation", "values": [6]}
KINDS = [kind for kind in OPTIMIZERS if kind != "cma_es"]
"""Optimizers that know more than numbers."""

MIXED = {
    "order": {"parameter_type": "permutation", "values": [5], "kernel": "kendall"},
    "a": {"parameter_type": "real", "values": [0, 1]},
    "other": {"parameter_type": "permutation", "values": [15], "kernel": "hamming"},
    "c": {"parameter_type": "categorical", "values": ["x", "y"]},
}
COSTS = np.random.default_rng(5).integers(0, 20, size=(6, 6))
"""Of each element at each place: an assignment problem."""


def assignment(configuration: dict) -> dict[str, float]:
    return {"y": float(sum(COSTS[element, place] for place, element in enumerate(configuration["order"])))}


def objectives(configuration: dict) -> dict[str, float]:
    order = configuration["order"]
    return {"near": abs(order.index(0) - 2) + configuration["a"], "far": float(configuration["other"].index(7))}


@pytest.mark.slow
@pytest.mark.parametrize("kernel", ["spearman", "hamming"])
def test_the_best_order_is_found_sooner_than_by_random_search(kernel: str) -> None:
    def bests(optimizer: str) -> list[float]:
        parameters = {"order": ORDER | {"kernel": kernel}}
        scenario = scenario_of(input_parameters=parameters, objectives=[{"name": "y"}], optimizer=optimizer)
        runs = [
            run(scenario | {"seed": seed, "budget": {"evaluations": 30}}, 30, function=assignment) for seed in (1, 2, 3)
        ]
        return [min(e.values["y"] for e in one.history) for one in runs]

    from_model, at_random = bests("bayesian"), bests("random_search")
    assert np.median(from_model) < min(at_random)


@pytest.mark.parametrize(
    "changes",
    [
        *(pytest.param({"optimizer": kind}, id=kind) for kind in KINDS),
        pytest.param({"acquisition": "upper_confidence_bound", "maximizer": "local_search"}, id="local_search"),
        pytest.param({"surrogate": "random_forest"}, id="random_forest", marks=pytest.mark.slow),
        pytest.param({"acquisition": "thompson_sampling"}, id="thompson_sampling", marks=pytest.mark.slow),
        pytest.param(
            {"constraints": ["position(order, 0) < position(order, 4)", "a < 0.5"]},
            id="constraints",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_resumed_run_over_permutations_goes_on_as_the_uninterrupted_one(changes: dict) -> None:
    scenario = scenario_of(input_parameters=MIXED, **changes)
    whole = run(scenario, 9, batch=2, function=objectives)
    space = build_space(load_scenario(scenario))
    assert all(space.contains(e.configuration) for e in whole.history)
    assert all(isinstance(e.configuration["order"], tuple) for e in whole.history)
    again = resumed(scenario, list(whole.history)[:6])
    expected = [e.suggestion for e in whole.history][6:8]
    assert [replace(s, seconds=0) for s in again.ask(2)] == [replace(s, seconds=0) for s in expected]


@pytest.mark.parametrize("kind", KINDS)
def test_all_orders_of_a_small_space_are_tried_once(kind: str) -> None:
    parameters = {"order": {"parameter_type": "permutation", "values": [3]}}
    scenario = scenario_of(input_parameters=parameters, objectives=[{"name": "y"}], optimizer=kind)
    optimizer = run(scenario, 20, batch=2, function=lambda c: {"y": float(c["order"][0])})
    assert len({e.configuration["order"] for e in optimizer.history}) == len(optimizer.history) == 6
    assert optimizer.ask() == []


def test_a_stored_run_is_gone_on_with_and_drawn(tmp_path) -> None:
    small = {"number_of_samples": 3}
    scenario = scenario_of(input_parameters=MIXED, budget={"evaluations": 4}, design_of_experiment=small)
    first = optimize(scenario, objectives, output_directory=tmp_path)
    text = (tmp_path / "history.csv").read_text().splitlines()[1]
    assert text.startswith(as_argument(first.evaluations[0].configuration["order"]) + ",")
    second = optimize(scenario | {"budget": {"evaluations": 6}}, objectives, output_directory=tmp_path)
    whole = optimize(scenario | {"budget": {"evaluations": 6}}, objectives, output_directory=tmp_path / "whole")
    assert [e.configuration for e in second.evaluations] == [e.configuration for e in whole.evaluations]
    pytest.importorskip("matplotlib")
    assert plot_parameters([tmp_path], tmp_path / "parameters.png")


def test_a_density_over_orders_is_their_smoothed_frequencies(tmp_path) -> None:
    file = tmp_path / "good.csv"
    file.write_text("order,near,far\n4 3 2 1 0,1,1\n4 3 2 1 0,1,1\n0 1 2 3 4,1,1\n")
    parameters = {name: MIXED[name] for name in ("order", "a")}
    prior = {"type": "kde", "file": str(file), "rows": "all", "parameters": ["order"]}
    scenario = load_scenario(scenario_of(input_parameters=parameters, priors=[prior]))
    assert scenario.joint_priors[0].options["points"] == {"order": [[4, 3, 2, 1, 0], [4, 3, 2, 1, 0], [0, 1, 2, 3, 4]]}
    assert load_scenario(scenario.canonical) == scenario
    orders = [s.configuration["order"] for s in build_optimizer(scenario).ask(5)]
    assert (4, 3, 2, 1, 0) in orders


def test_rows_with_other_orders_are_refused(tmp_path) -> None:
    file = tmp_path / "good.csv"
    file.write_text("order\n4 3 2 1\n")
    prior = {"type": "kde", "file": str(file), "rows": "all"}
    with pytest.raises(ScenarioError, match="for 'order': the numbers below 6 in any order"):
        load_scenario(scenario_of(input_parameters={"order": ORDER}, priors=[prior]))


@pytest.mark.parametrize(
    "prior",
    [
        {"type": "gaussian", "mean": 2, "std": 1},
        {"type": "weights", "weights": [1, 2]},
        {"type": "beta", "shape": "decay"},
        {"type": "uniform", "low": 1},
    ],
    ids=lambda prior: prior["type"],
)
def test_an_order_has_no_prior_but_the_uniform_one(prior: dict) -> None:
    scenario = scenario_of(input_parameters={"order": ORDER | {"prior": prior}})
    with pytest.raises(ScenarioError, match=r"\$.input_parameters.order.prior: 'order' is a permutation"):
        load_scenario(scenario)
    load_scenario(scenario_of(input_parameters={"order": ORDER | {"prior": "uniform"}}))


def test_a_default_order_is_tried_first() -> None:
    parameters = {"order": ORDER | {"parameter_default": [5, 4, 3, 2, 1, 0]}}
    scenario = load_scenario(scenario_of(input_parameters=parameters))
    assert build_optimizer(scenario).ask()[0].configuration == {"order": (5, 4, 3, 2, 1, 0)}
    assert "5 4 3 2 1 0" in summarize(scenario)
    bad = load_scenario(scenario_of(input_parameters={"order": ORDER | {"parameter_default": [1, 2, 3]}}))
    with pytest.raises(ScenarioError, match="is not a legal value\n  allowed: the integers from 0 to 5 in any order"):
        build_space(bad)


def test_check_describes_orders_and_counts_them() -> None:
    parameters = {"order": {"parameter_type": "permutation", "values": [3], "kernel": "kendall"}}
    scenario = load_scenario(scenario_of(input_parameters=parameters, objectives=[{"name": "y"}]))
    assert "orders of 0 to 2 (kendall)" in summarize(scenario)
    assert "there are only 6 configurations" in "\n".join(lint(scenario))


@pytest.mark.parametrize(("values", "message"), [([1], "too small"), ([16], "too large"), ([2, 3], "2 items")])
def test_sizes_are_limited(values: list[int], message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        load_scenario(scenario_of(input_parameters={"order": ORDER | {"values": values}}))


@pytest.mark.parametrize("constraint", ["order[0] != 1", "other[0] != 1 and c == 'x'"])
def test_a_run_within_constraints_goes_on_when_everything_was_infeasible(constraint: str) -> None:
    scenario = scenario_of(input_parameters=MIXED, constraints=[constraint])
    optimizer = build_optimizer(load_scenario(scenario))
    for _ in range(7):
        optimizer.tell([Evaluation(suggestion=s, state=State.INFEASIBLE) for s in optimizer.ask()])
    assert [e.suggestion.phase for e in optimizer.history] == ["design"] * 5 + ["random", "model"]
    assert all(optimizer.history.space.contains(e.configuration) for e in optimizer.history)


@pytest.mark.parametrize("kernel", ["spearman", "kendall", "hamming"])
def test_what_is_feasible_is_learned_from_orders_that_are_alike(kernel: str) -> None:
    parameters = {"order": {"parameter_type": "permutation", "values": [8], "kernel": kernel}}
    changes = {"design_of_experiment": {"number_of_samples": 30}, "budget": {"evaluations": 40}}
    optimizer = build_optimizer(load_scenario(scenario_of(input_parameters=parameters, **changes)))

    def is_feasible(order: tuple) -> bool:
        return order.index(0) < 4

    def judged(suggestion: Suggestion) -> Evaluation:
        order = suggestion.configuration["order"]
        state = State.COMPLETED if is_feasible(order) else State.INFEASIBLE
        return Evaluation(suggestion=suggestion, state=state, values={"near": 1.0, "far": float(order[-1])})

    optimizer.tell([judged(s) for s in optimizer.ask(30)])
    posterior = optimizer._models.feasibility()
    space = optimizer.history.space
    X = space.sample_uniform(400, np.random.default_rng(1))
    truth = np.array([is_feasible(c["order"]) for c in space.decode(X)])
    log_probability = posterior.log_probability(X)
    assert log_probability[truth].mean() > log_probability[~truth].mean() + 0.1
