"""HyperMapper's scenarios of every mode and method, built to the last part."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.assembly import validate
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.upgrade import upgrade
from tests.scenario.hypermapper_scenarios import (
    CATEGORICAL,
    HAS_FILES,
    INTEGER,
    ORDINAL,
    REAL,
    needs,
    scenario,
    write_rows,
)

MIXED = {"r": {**REAL, "prior": "decay"}, "n": INTEGER, "o": ORDINAL, "c": CATEGORICAL}
TWO = ["a", "b"]


def case(name: str, *marks: pytest.MarkDecorator, **changes: Any) -> Any:
    """Return the good scenario with changes, under a name, and what it needs of us."""
    return pytest.param(changes, id=name, marks=[HAS_FILES, *marks])


CASES = [
    case("default"),
    case("mixed", input_parameters=MIXED),
    case("estimate", input_parameters={"x1": {**REAL, "prior": "estimate"}, "x2": REAL}),
    case("joint estimate", estimate_multivariate_priors=True),
    case(
        "gaussians",
        input_parameters={"r": {**REAL, "prior": "custom_gaussian", "custom_gaussian_prior_means": [0, 1]}},
        models={"model": "gaussian_process"},
    ),
    case("box", optimization_objectives=TWO, weight_sampling="bounding_box"),
    case("thompson sampling", acquisition_function="TS"),
    case(
        "modified_tchebyshev",
        needs("scalarization", kind="modified_tchebyshev"),
        optimization_objectives=TWO,
        scalarization_method="modified_tchebyshev",
        acquisition_function="UCB",
    ),
    case("bopro", needs("prior_weighting", kind="bopro"), input_parameters=MIXED, prior_method="bopro"),
    case(
        "latin hypercube",
        needs("design_of_experiment", kind="prior_latin_hypercube"),
        input_parameters=MIXED,
        design_of_experiment={"doe_type": "standard latin hypercube"},
    ),
    case(
        "k latin hypercube",
        needs("design_of_experiment", kind="k_latin_hypercube"),
        input_parameters=MIXED,
        design_of_experiment={"doe_type": "k latin hypercube"},
    ),
    case("grid", needs("design_of_experiment", "levels"), design_of_experiment={"doe_type": "grid_search"}),
    case("cma_es", needs("maximizer", kind="cma_es"), acquisition_function_optimizer="cma_es"),
    case(
        "evolution",
        needs("optimizer", kind="evolutionary"),
        optimization_method="evolutionary_optimization",
        evolution_crossover=True,
        batch_size=3,
    ),
    case(
        "local search",
        needs("optimizer", kind="local_search"),
        optimization_method="local_search",
        optimization_objectives=TWO,
        local_search_scalarization_weights=[1, 3],
    ),
    case(
        "feasibility",
        needs("scenario", "feasible_output"),
        feasible_output={"enable_feasible_predictor": True, "true_value": "1", "false_value": "0"},
    ),
    case(
        "client",
        needs("evaluator", kind="client_server"),
        hypermapper_mode={"mode": "client-server"},
        evaluations_per_optimization_iteration=3,
    ),
    case(
        "table",
        needs("evaluator", kind="exhaustive"),
        hypermapper_mode={"mode": "exhaustive", "exhaustive_search_file": "samples.csv"},
    ),
    case("batches", needs("evaluator", "batch"), evaluations_per_optimization_iteration=2),
    case(
        "resumed",
        needs("scenario", "earlier_evaluations"),
        resume_optimization=True,
        resume_optimization_data="samples.csv",
    ),
    case("reports", print_parameter_importance=True, print_posterior_best=True),
    case("version 3", needs("scenario", "constraints"), input_parameters={"p": {**REAL, "constraints": ["p >= 0"]}}),
    case(
        "permutation",
        needs("parameter", kind="permutation"),
        input_parameters={"p": {"parameter_type": "permutation", "values": [4], "parameter_default": [3, 2, 1, 0]}},
    ),
]


@pytest.mark.parametrize("changes", CASES)
def test_it_is_built_and_upgraded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, changes: dict[str, Any]) -> None:
    monkeypatch.chdir(tmp_path)
    write_rows(tmp_path, "samples.csv", 30)
    (tmp_path / "hm.json").write_text(json.dumps(scenario(**changes)))
    loaded = load_scenario(tmp_path / "hm.json")
    validate(loaded)
    (tmp_path / "new.json").write_text(upgrade(tmp_path / "hm.json").text)
    assert load_scenario(tmp_path / "new.json").canonical == loaded.canonical
