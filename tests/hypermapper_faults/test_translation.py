"""Faults of HyperMapper around its scenario files and priors; each test fails on the faulty behaviour."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hypermap_lite import Optimizer
from hypermap_lite.assembly import build_prior, build_space
from hypermap_lite.priors import Density
from hypermap_lite.scenario import Scenario, load_scenario
from tests.scenario.hypermapper_scenarios import INTEGER, REAL, translated, write_rows

QUICK = {"models": {"model": "gaussian_process"}, "epsilon_greedy_threshold": 0}


def loaded(**changes: Any) -> Scenario:
    """Load a HyperMapper scenario, with results where ours go."""
    document = translated(**changes)
    document["output"] = {"directory": document["output"]["directory"]}
    return load_scenario(document)


def density_of(entry: dict[str, Any]) -> Density:
    """Return the density of the only parameter of a scenario."""
    scenario = loaded(input_parameters={"p": entry})
    ((_, factor),) = build_prior(scenario, build_space(scenario)).factors
    return factor.density


def suggestions(scenario: Scenario, n: int) -> list[dict[str, Any]]:
    """Run a scenario on an easy function, and return what was suggested."""
    optimizer = Optimizer(scenario.canonical)
    for _ in range(n):
        (suggestion,) = optimizer.ask(1)
        value = sum((float(x) - 1) ** 2 for x in suggestion.configuration.values())
        optimizer.tell(suggestion, {objective.name: value for objective in scenario.objectives})
    return [dict(evaluation.suggestion.configuration) for evaluation in optimizer.history]


def test_feasibility_values_do_not_silently_change_their_case() -> None:
    whole = {"enable_feasible_predictor": True, "name": "Valid", "true_value": "True", "false_value": "False"}
    assert translated(feasible_output=whole)["feasible_output"] == {
        "name": "Valid",
        "true_value": "True",
        "false_value": "False",
    }
    # HyperMapper's own default is kept, for its clients answer so, and it is said
    assert translated(feasible_output={"enable_feasible_predictor": True})["feasible_output"]["true_value"] == "true"


def test_no_integer_lies_above_the_maximum() -> None:
    parameter = build_space(loaded(input_parameters={"p": INTEGER})).parameters[0]
    assert parameter.decode(np.array([0.0, 0.5, 1.0]))[::2] == [0, 15]
    values = parameter.decode(np.linspace(0, 1, 1001))
    assert min(values) == 0
    assert max(values) == 15


@pytest.mark.parametrize("shape", ["gaussian", "decay", "exponential"])
def test_an_integers_density_is_that_of_its_draws(shape: str) -> None:
    density = density_of({"parameter_type": "integer", "values": [0, 3], "prior": shape})
    masses = np.exp(density.log_density((np.arange(4) + 0.5) / 4)) / 4
    drawn = np.histogram(density.sample(40_000, np.random.default_rng(0)), bins=4, range=(0, 1))[0] / 40_000
    assert masses == pytest.approx(drawn, abs=0.01)
    assert np.all((masses > 0) & np.isfinite(masses))  # neither zero nor infinite at the ends


def test_a_list_prior_draws_a_value_of_its_own_for_each_candidate() -> None:
    drawn = density_of({**REAL, "prior": [1, 2, 3, 2, 1]}).sample(500, np.random.default_rng(0))
    assert len(set(drawn)) == 500


def test_a_list_prior_integrates_to_one() -> None:
    u = np.linspace(0, 1, 10_001)
    density = np.exp(density_of({**REAL, "values": [0, 10], "prior": [1, 2, 3, 2, 1]}).log_density(u))
    assert np.trapezoid(density, u) == pytest.approx(1, abs=1e-6)


def test_a_gaussian_with_its_mean_on_the_bound_integrates_to_one() -> None:
    own = {"custom_gaussian_prior_means": [-5], "custom_gaussian_prior_stds": [1]}
    u = np.linspace(0, 1, 20_001)
    density = np.exp(density_of({**REAL, "prior": "custom_gaussian", **own}).log_density(u))
    assert np.trapezoid(density, u) == pytest.approx(1, abs=1e-3)  # HyperMapper's: a half


def test_an_estimated_prior_is_no_row_of_spikes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_rows(tmp_path, "samples.csv", 30)  # three good rows: x1 is 0, 0.1 and 0.2 of -5 to 10
    entries = {name: {**REAL, "values": [0, 0.4], "prior": "estimate"} for name in ("x1",)}
    scenario = loaded(input_parameters=entries)
    prior = build_prior(scenario, build_space(scenario))
    between = np.exp(prior.log_density(np.array([[0.125], [0.375]])))
    assert np.all(between > 0.3)  # HyperMapper's bandwidth, a thirtieth of the points' distance, leaves nothing there


def test_the_name_of_the_scalarization_column_is_no_trap() -> None:
    assert translated(scalarization_key="cost_of_it_all") == translated()


def test_a_run_without_a_design_begins() -> None:
    scenario = loaded(design_of_experiment={"number_of_samples": 0}, optimization_iterations=4, **QUICK)
    assert scenario.budget.evaluations == 4
    assert len(suggestions(scenario, 4)) == 4


def test_priors_count_with_several_objectives() -> None:
    own = {"custom_gaussian_prior_means": [8], "custom_gaussian_prior_stds": [0.2]}
    scenario = loaded(
        optimization_objectives=["a", "b"], input_parameters={"p": {**REAL, "prior": "custom_gaussian", **own}}, **QUICK
    )
    assert scenario.acquisition.prior_weighting is not None
    assert all(7 < float(configuration["p"]) < 9 for configuration in suggestions(scenario, 5))


def test_pibo_takes_a_mixture() -> None:
    own = {"custom_gaussian_prior_means": [0, 5], "custom_gaussian_prior_stds": [0.5, 0.5]}
    scenario = loaded(
        input_parameters={"p": {**REAL, "prior": "custom_gaussian", **own}},
        design_of_experiment={"number_of_samples": 3},
        optimization_iterations=3,
        **QUICK,
    )
    assert len(suggestions(scenario, 6)) == 6


def test_a_custom_gaussian_on_an_integer_is_possible() -> None:
    density = density_of({**INTEGER, "prior": "custom_gaussian", "custom_gaussian_prior_means": [15]})
    assert density.mode() == pytest.approx(31 / 32)
