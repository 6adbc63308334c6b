"""Tests for lint.py."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.lint import lint, mass_inside
from hypermap_lite.scenario.model import ParameterSpec

CLEAN: dict[str, Any] = {
    "input_parameters": {
        "x": {"parameter_type": "real", "values": [0, 10]},
        "mode": {"parameter_type": "categorical", "values": ["a", "b"]},
    },
    "objectives": [{"name": "cost", "reference_point": 3}, {"name": "gain", "reference_point": 1}],
}


def warnings(**sections: Any) -> list[str]:
    return lint(load_scenario(copy.deepcopy(CLEAN) | sections))


def warnings_for(name: str, **entry: Any) -> list[str]:
    return warnings(input_parameters=CLEAN["input_parameters"] | {name: entry})


def mixture(means: list[float]) -> dict[str, Any]:
    return {"type": "mixture", "components": [{"mean": mean, "std": 1} for mean in means]}


def test_a_clean_scenario_gives_no_warning() -> None:
    assert warnings() == []


@pytest.mark.parametrize("kind", ["categorical", "ordinal"])
def test_consecutive_integers_are_better_declared_integer(kind: str) -> None:
    values = ["3", "1", "2"] if kind == "categorical" else [3, 1, 2]
    (warning,) = warnings_for("n", parameter_type=kind, values=values)
    assert warning.startswith("$.input_parameters.n: the levels are consecutive integers")
    assert '"integer" with values [1, 3]' in warning


def test_categories_that_are_numbers_are_better_declared_ordinal() -> None:
    (warning,) = warnings_for("n", parameter_type="categorical", values=["16", "32", "64"])
    assert '"ordinal"' in warning


def test_ordinals_with_gaps_are_fine() -> None:
    assert warnings_for("n", parameter_type="ordinal", values=[16, 32, 64]) == []


@pytest.mark.parametrize(
    ("prior", "share"),
    [
        pytest.param({"type": "gaussian", "mean": -2, "std": 1}, "97.7 %", id="gaussian"),
        pytest.param({"type": "gaussian", "mean": 1e6, "std": 1}, "more than 99.9 %", id="far_away"),
        pytest.param(mixture([-2, 12]), "97.7 %", id="mixture"),
    ],
)
def test_a_prior_outside_the_bounds_says_how_much(prior: dict[str, Any], share: str) -> None:
    (warning,) = warnings_for("x", parameter_type="real", values=[0, 10], prior=prior)
    assert warning.startswith(f"$.input_parameters.x.prior: {share} of its mass lies outside")


@pytest.mark.parametrize(
    "prior",
    [
        pytest.param({"type": "gaussian", "mean": -1, "std": 1}, id="tail_inside"),
        pytest.param(mixture([-9, 5]), id="one_component_inside"),
        pytest.param({"type": "beta", "shape": "decay"}, id="never_outside"),
    ],
)
def test_a_prior_with_mass_inside_is_fine(prior: dict[str, Any]) -> None:
    assert warnings_for("x", parameter_type="real", values=[0, 10], prior=prior) == []


def test_a_joint_prior_outside_the_bounds_is_named() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": -5}, "std": {"x": 1}}]}]
    (warning,) = warnings(priors=priors)
    assert warning.startswith("$.priors[0]: more than 99.9 %")


@pytest.mark.parametrize(
    ("options", "says"),
    [
        pytest.param({"points": {"x": [5]}}, "10 % of each range.", id="one"),
        pytest.param({"points": {"x": [5, 5]}}, "10 % of each range.", id="one-twice"),
        pytest.param({"points": {"x": [5, 6]}, "point_weights": [2, 0]}, "10 % of each range.", id="one-that-counts"),
        pytest.param({"points": {"x": [5], "mode": ["a"]}}, "it says nothing about levels.", id="one-with-a-level"),
    ],
)
def test_a_density_over_a_single_point_is_named(options: dict[str, Any], says: str) -> None:
    (warning,) = warnings(priors=[{"type": "kde", **options}])
    assert warning.startswith("$.priors[0]: it rests on a single point")
    assert warning.endswith(says)


def test_a_density_over_several_points_is_fine() -> None:
    assert warnings(priors=[{"type": "kde", "points": {"x": [5, 6], "mode": ["a", "a"]}}]) == []


@pytest.mark.parametrize(
    ("kind", "scale", "values", "mean", "std", "expected"),
    [
        pytest.param("real", "linear", (0.0, 1.0), 0.5, 0.5, 0.6827, id="one_sigma"),
        pytest.param("real", "linear", (0.0, 1.0), 0.0, 1e-3, 0.5, id="half"),
        pytest.param("real", "log", (0.01, 1.0), 0.1, 1.0, 0.6827, id="decades"),
        pytest.param("integer", "linear", (1, 1), 1, 0.5, 0.6827, id="half_a_step_beyond_an_integer"),
        pytest.param("real", "linear", (0.0, 1.0), -40.0, 1.0, 0.0, id="far_away"),
    ],
)
def test_mass_inside_is_that_of_the_normal_distribution(
    kind: str, scale: str, values: tuple[float, float], mean: float, std: float, expected: float
) -> None:
    parameter = ParameterSpec(name="x", parameter_type=kind, values=values, scale=scale)
    assert mass_inside(parameter, mean, std) == pytest.approx(expected, abs=1e-4)


def test_missing_reference_points_are_named_with_two_objectives() -> None:
    (warning,) = warnings(objectives=[{"name": "cost"}, {"name": "gain", "reference_point": 1}])
    assert warning.startswith("$.objectives[0]: 'cost' has no reference_point")
    assert warnings(objectives=[{"name": "cost"}]) == []


def test_a_budget_of_the_design_alone_fits_no_model() -> None:
    (warning,) = warnings(budget={"evaluations": 6})
    assert "no model is ever fitted" in warning
    assert warnings(budget={"evaluations": 6}, optimizer="random_search") == []


@pytest.mark.parametrize(("size", "is_odd"), [(12, False), (13, True)])
def test_a_batch_larger_than_the_budget_is_named(size: int, is_odd: bool) -> None:
    found = warnings(budget={"evaluations": 12, "batch_size": size})
    assert any(w.startswith("$.budget.batch_size: a batch is more than the 12") for w in found) == is_odd


def test_a_space_smaller_than_the_budget_is_named() -> None:
    n = {"parameter_type": "integer", "values": [1, 4]}
    (warning,) = warnings(input_parameters={"n": n, "mode": CLEAN["input_parameters"]["mode"]})
    assert "only 8 configurations" in warning


def test_decades_on_a_linear_scale_are_named() -> None:
    (warning,) = warnings_for("rate", parameter_type="real", values=[1e-5, 1])
    assert "5.0 decades" in warning
    assert warnings_for("rate", parameter_type="real", values=[1e-5, 1], scale="log") == []


def test_a_maximizer_that_gives_way_is_named() -> None:
    (warning,) = warnings(maximizer="cma_es", input_parameters={"n": {"parameter_type": "integer", "values": [0, 999]}})
    assert warning == "$.maximizer.type: 'n' is not real; local_search takes the place of cma_es."


def test_a_search_that_never_begins_is_named() -> None:
    (warning,) = warnings(optimizer="evolutionary", budget={"evaluations": 12})
    assert warning == "$.budget.evaluations: population_size takes all 12 evaluations; evolutionary never begins."


def test_priors_that_nothing_uses_are_named() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 5}, "std": {"x": 1}}]}]
    (warning,) = warnings(priors=priors, design_of_experiment="sobol", optimizer="random_search")
    assert "the priors change nothing" in warning
    assert warnings(priors=priors, design_of_experiment="sobol") == []


def test_commands_are_looked_at() -> None:
    (warning,) = warnings(evaluator={"type": "command", "command": ["echo", "{x:.3f}", "{mode}"]})
    assert warning.startswith("$.evaluator.command: no placeholder passes on 'x'")


@pytest.mark.parametrize(
    ("sections", "says"),
    [
        pytest.param({"budget": {"evaluations": 8}}, "only 2 evaluations can confirm", id="design"),
        pytest.param({"surrogate": {"noise": False}}, "repeating them brings nothing", id="exact surrogate"),
        pytest.param({"evaluator": {"type": "exhaustive", "file": "t.csv"}}, "a table answers the same", id="table"),
    ],
)
def test_confirmations_that_bring_nothing_are_named(sections: dict[str, Any], says: str) -> None:
    budget = {"evaluations": 30, "confirm_front": 4, **sections.get("budget", {})}
    (warning,) = [text for text in warnings(**{**sections, "budget": budget}) if "confirm_front" in text]
    assert says in warning


def test_a_confirmation_with_room_is_fine() -> None:
    assert warnings(budget={"evaluations": 30, "confirm_front": 4}) == []


def test_workers_beyond_the_calls_between_two_looks_are_named() -> None:
    evaluator = {"type": "python", "function": "m:f", "replicates": 7, "racing": {}, "workers": 4}
    (warning,) = warnings(evaluator=evaluator)
    assert "only 3 calls can run at once (batch_size x the replicates between two looks of the race)" in warning


def test_workers_that_never_get_a_call_are_named() -> None:
    (warning,) = warnings(evaluator={"workers": 4, "replicates": 3})
    assert "only 3 calls" in warning
    assert warnings(evaluator={"workers": 4}, budget={"asynchronous": True}) == []


@pytest.mark.parametrize(
    ("evaluator", "why"),
    [
        ({"type": "client_server"}, "a batch is one call"),
        ({"type": "python", "function": "a:b", "batch": True}, "a batch is one call"),
        ({"batch": True}, "a batch is one call"),
        ({"type": "exhaustive", "file": "t.csv"}, "a table is looked up at once"),
    ],
)
def test_workers_without_work_are_named(evaluator: dict[str, Any], why: str) -> None:
    budget = {"batch_size": 4}
    expected = [f"$.evaluator.workers: they are not used: {why}."]
    assert warnings(budget=budget, evaluator=evaluator | {"workers": 2}) == expected
    assert warnings(budget=budget, evaluator=evaluator) == []


POOLED = {"type": "gaussian_process", "noise_from_replicates": True}


@pytest.mark.parametrize(
    ("sections", "expected"),
    [
        ({}, ["$.surrogate.noise_from_replicates: it does nothing: there is one replicate"]),
        ({"budget": {"confirm_front": 4}}, []),
        ({"evaluator": {"replicates": 3}}, []),
        ({"earlier_evaluations": "former.csv"}, []),
        (
            {"evaluator": {"replicates": 3}, "surrogate": {**POOLED, "noise": False}},
            ["$.surrogate.noise_from_replicates: it does nothing: the surrogate takes evaluations to be exact"],
        ),
    ],
)
def test_noise_from_replicates_without_any_is_named(sections: dict[str, Any], expected: list[str]) -> None:
    found = warnings(**{"surrogate": POOLED, **sections})
    assert [text.split(" of each")[0].split(" (")[0] for text in found] == expected


@pytest.mark.parametrize(
    ("workers", "budget", "path"),
    [
        (1, {"asynchronous": True}, "$.budget.asynchronous: it brings nothing"),
        (1, {"batch_size": 4}, None),
        (4, {"asynchronous": True}, None),
        (1, {}, "$.optimizer.separation: it does nothing"),
    ],
)
def test_options_of_parallel_runs_are_named_where_nothing_is(
    workers: int, budget: dict[str, Any], path: str | None
) -> None:
    optimizer = {"type": "bayesian", "separation": 0.05}
    found = warnings(evaluator={"workers": workers}, budget=budget, optimizer=optimizer)
    assert [text.split(":")[0] for text in found] == ([] if path is None else [path.split(":")[0]])
    assert path is None or found[0].startswith(path)
