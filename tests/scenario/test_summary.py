"""Tests for summary.py."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.summary import summarize
from tests.scenario.bad_scenarios import GOOD


def page(**sections: Any) -> str:
    return summarize(load_scenario(copy.deepcopy(GOOD) | sections))


def test_every_parameter_has_a_line_with_bounds_scale_and_prior() -> None:
    rate = {"parameter_type": "real", "values": [1e-5, 0.1], "scale": "log", "parameter_default": 0.01}
    rate["prior"] = {"type": "gaussian", "mean": 0.001, "std": 1}
    text = page(input_parameters={"rate": rate, "mode": GOOD["input_parameters"]["mode"]})
    assert "rate  real         1e-05 to 0.1  log    0.01     gaussian(mean=0.001, std=1)" in text
    assert "mode  categorical  fast, safe    -      -        -" in text


def test_the_method_says_which_evaluations_are_chosen_how() -> None:
    text = page(budget={"evaluations": 20})
    assert "evaluations 1 to 8: sobol" in text
    assert "evaluations 9 to 20: noisy_expected_hypervolume_improvement(samples=32, screening=8) on a gauss" in text
    assert "2 objectives: all trade-offs at once; reference point inferred from the front (none given for cost," in text
    assert "no priors" in text


def test_a_scalarization_is_named_with_its_weights() -> None:
    text = page(acquisition={"scalarization": "tchebyshev"})
    assert ": noisy_expected_improvement(samples=64, screening=8) on a gaussian_process" in text
    assert "2 objectives: tchebyshev(rho=0.05) with weights from dirichlet(alpha=1)" in text


def test_the_hypervolume_of_many_objectives_is_looked_for_in_random_directions() -> None:
    text = page(objectives=[{"name": f"f{k}", "reference_point": 1} for k in range(4)])
    assert "4 objectives: noisy expected improvement in random directions; reference point as given" in text


def test_the_last_evaluations_are_said_to_confirm_the_front() -> None:
    budget = {"evaluations": 20, "confirm_front": 5}
    for optimizer in ("bayesian", "random_search"):
        text = page(budget=budget, optimizer=optimizer)
        assert "evaluations 9 to 15: " in text
        assert "evaluations 16 to 20: repeat those whose worth for the front is least certain" in text


def test_the_beta_of_pibo_counts_no_repetitions() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    assert "pibo(beta=2, floor" in page(priors=priors, budget={"evaluations": 38, "confirm_front": 10})


def test_the_beta_of_pibo_is_worked_out() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    text = page(priors=priors, budget={"evaluations": 28}, objectives=[{"name": "cost"}])
    weighted = "acquisition weighted by pibo(beta=2, floor=0.05), but for 25 % of the steps, dropped if they mislead"
    assert weighted in text
    assert "evaluations 1 to 8: prior_sampling(uniform_share=0.25)" in text
    assert "priors      mixture of\n              x 1 ± 2\n" in text
    assert "one objective" in text


def test_mixtures_read_as_sums() -> None:
    components = [{"mean": 2, "std": 1}, {"mean": 5, "std": 1, "weight": 0.5}]
    x = GOOD["input_parameters"]["x"] | {"prior": {"type": "mixture", "components": components}}
    assert "mixture(2 ± 1 + 5 ± 1 (weight 0.5))" in page(input_parameters={"x": x})


def test_unused_priors_are_said_to_be_so() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    assert "not in the acquisition" in page(priors=priors, acquisition={"prior_weighting": "none"})


def test_the_feasibility_has_a_line_and_a_part_in_the_method() -> None:
    text = page(feasible_output={"name": "fits", "true_value": "1", "false_value": "0"})
    assert "feasibility fits: 1 or 0\n" in text
    assert "acquisition weighted by the probability of being feasible, to the power 3" in text
    assert "objective values of infeasible evaluations inform the model" in text
    for surrogate in ({"learn_infeasible": False}, "random_forest"):
        assert "inform the model" not in page(feasible_output={"name": "fits"}, surrogate=surrogate)
    assert "not in the acquisition (feasibility_weighting is none)" in page(
        acquisition={"feasibility_weighting": "none"}
    )
    assert "feasib" not in page()


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "5 failures in a row (20 where their parameters explain them)"),
        ({"max_consecutive_failures": 2}, "2 failures in a row\n"),
        ({"max_consecutive_failures": 1}, "the first failure\n"),
    ],
)
def test_failures_in_a_row_have_a_line(given, line) -> None:
    command = {"type": "command", "command": ["true", "{x}"]}
    assert f"            the run ends after {line}" in page(evaluator=command | given)
    assert "failures in a row" not in page()


def test_compressed_tails_have_a_line() -> None:
    assert "values far beyond those that count, such as penalties, are compressed for the model" in page()
    for surrogate in ({"compress_tails": False}, "random_forest"):
        assert "compress" not in page(surrogate=surrogate)


def test_outliers_have_a_line() -> None:
    assert "an evaluation far worse than the others foretell is set aside until one near it is as bad" in page()
    for surrogate in ({"ignore_outliers": False}, {"noise": False}, {"noise_from_replicates": True}, "random_forest"):
        assert "set aside" not in page(surrogate=surrogate)


def test_doubted_noise_has_a_line() -> None:
    line = "what looks like noise is taken for roughness where a model without noise is likelier"
    one = [{"name": "f1"}]
    assert line in page(objectives=one)
    assert line not in page()
    for surrogate in ({"doubt_noise": False}, {"noise": False}, {"noise_from_replicates": True}, "random_forest"):
        assert line not in page(objectives=one, surrogate=surrogate)


def test_separate_failures_have_a_line() -> None:
    line = "evaluations in a bad mode of their own, such as failures, are told apart from the others"
    assert line in page()
    for surrogate in ({"separate_failures": False}, {"noise_from_replicates": True}, "random_forest"):
        assert line not in page(surrogate=surrogate)
    assert line not in page(acquisition={"feasibility_weighting": "none"})
    assert line not in page(preset="paper")


def test_separate_modes_have_a_line() -> None:
    line = "so are two kinds of which the front needs both; each then has a model of its own"
    assert line in page()
    for surrogate in ({"separate_failures": False}, {"separate_modes": False}, "random_forest"):
        assert line not in page(surrogate=surrogate)
    assert line not in page(objectives=[{"name": "f1"}])
    assert line not in page(objectives=[{"name": f"f{k}"} for k in range(4)])
    assert line not in page(acquisition="expected_improvement")
    assert line not in page(preset="paper")


def test_a_search_without_a_model_names_no_acquisition() -> None:
    text = page(optimizer="random_search")
    assert "evaluations 9 to 50: random_search" in text
    assert "expected_improvement" not in text


def test_a_budget_of_the_design_alone_names_no_model() -> None:
    assert "gaussian_process" not in page(budget={"evaluations": 5})


def test_the_evaluator_line_says_where_a_batch_is_one_call() -> None:
    assert "client_server; calls: one per batch, 60 s each" in page(
        evaluator={"type": "client_server", "timeout_seconds": 60}
    )
    batch = {"type": "python", "function": "lab:measure", "batch": True}
    assert "python lab:measure; calls: one per batch, no time limit" in page(evaluator=batch)
    assert "a function passed from Python, called once per batch" in page(evaluator={"batch": True})
    assert "exhaustive t.csv; calls: 1 per" in page(evaluator={"type": "exhaustive", "file": "t.csv"})


def test_the_evaluator_line_says_what_is_called_and_how_often() -> None:
    evaluator = {"type": "command", "command": ["./run", "{x}"], "replicates": 7, "workers": 2, "timeout_seconds": 60}
    assert "command ./run {x}; calls: 7 per configuration, 2 at a time, 60 s each" in page(evaluator=evaluator)
    assert "driven by ask and tell" in page()


def test_the_evaluator_line_says_when_replicates_race() -> None:
    evaluator = {"type": "python", "function": "m:f", "replicates": 7, "racing": {"alpha": 0.1}}
    assert "calls: 3 to 7 by racing (alpha=0.1) per configuration, 1 at a time" in page(evaluator=evaluator)


def test_the_budget_line_says_batches_and_minutes() -> None:
    assert "30 evaluations, 3 at a time, at most 2.5 min" in page(
        budget={"evaluations": 30, "batch_size": 3, "minutes": 2.5}
    )
    assert "30 evaluations, one for each worker that is free" in page(budget={"evaluations": 30, "asynchronous": True})


def test_a_density_says_what_it_rests_on() -> None:
    points = {"x": [1, 2, 3], "mode": ["fast", "safe", "safe"]}
    lines = page(priors=[{"type": "kde", "file": "run", "rows": "best", "quantile": 0.1, "points": points}])
    assert "priors      kde of 3 points, best 0.1 of the rows of run\n              over x, mode\n" in lines
    lines = page(priors=[{"type": "kde", "points": {"x": [1]}, "independent": True, "bandwidth_factor": 2}])
    assert "kde(bandwidth_factor=2, independent=True) of 1 point\n" in lines


def test_a_uniform_range_shows_its_ends() -> None:
    x = GOOD["input_parameters"]["x"] | {"prior": {"type": "uniform", "low": 2}}
    assert "uniform(low=2)" in page(input_parameters={"x": x})


def test_a_search_is_shown_with_its_options_and_its_one_trade_off() -> None:
    text = page(optimizer={"type": "local_search", "weights": [1, 2]}, budget={"evaluations": 20})
    assert "evaluations 11 to 20: local_search(random_points=10, weights=[1, 2], improvement=first)" in text
    assert "2 objectives: tchebyshev(rho=0.05) with fixed weights" in text


def test_bopro_takes_the_place_of_the_acquisition_function() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    text = page(priors=priors, acquisition={"prior_weighting": "bopro"})
    assert "bopro(model_weight=10, good_quantile=0.05, floor=0.01) takes the place of noisy_expected_hyp" in text


def test_care_that_is_not_taken_is_not_mentioned() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    text = page(priors=priors, acquisition={"prior_weighting": {"prior_free": 0, "safeguard": False}})
    assert "floor=0.05)\n" in text


def test_the_priors_of_an_objective_are_shown() -> None:
    objectives = [{"name": "cost", "priors": {"x": {"type": "gaussian", "mean": 1, "std": 2}}}]
    assert "priors      of cost: x gaussian(mean=1, std=2)\n" in page(objectives=objectives)


def test_a_grid_of_given_levels_is_as_large_as_it_is() -> None:
    parameters = {
        "r": {"parameter_type": "real", "values": [0, 1], "parameter_default": 0.3},
        "n": {"parameter_type": "integer", "values": [3, 5]},
    }
    text = page(input_parameters=parameters, design_of_experiment={"type": "grid", "levels": 4})
    assert "evaluations 1 to 13: grid" in text


def test_earlier_evaluations_and_all_output_are_named() -> None:
    text = page(earlier_evaluations="old.csv", output={"samples_file": "new.csv", "posterior_best": True})
    assert "earlier     the evaluations of old.csv come first" in text
    assert text.endswith("output      outputs/demo\n            new.csv\n            best by the surrogate")
