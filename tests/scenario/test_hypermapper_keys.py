"""Every key of HyperMapper's files: its default, another value, what both become, and what is said of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.hypermapper import KEYS, translate
from hypermap_lite.scenario.messages import check_document
from hypermap_lite.scenario.schemas import root_schema
from tests.scenario.hypermapper_scenarios import CATEGORICAL, GOOD, MISSING, at, note_on, of_dotted, parameter

TWO = {"optimization_objectives": ["a", "b"]}
EVOLUTION = {"optimization_method": "evolutionary_optimization"}
LOCAL = {"optimization_method": "local_search"}
BELIEF = {"input_parameters": {"x": {"parameter_type": "real", "values": [0, 1], "prior": "decay"}}}
CUSTOM = {"input_parameters": {"x": {"parameter_type": "real", "values": [0, 4], "prior": "custom_gaussian"}}}
ESTIMATE = {"input_parameters": {"x": {"parameter_type": "real", "values": [0, 1], "prior": "estimate"}}}
FEASIBLE = {"feasible_output.enable_feasible_predictor": True}
BOX = {**TWO, "weight_sampling": "bounding_box"}
CMA = {"acquisition_function_optimizer": "cma_es"}
WEIGHTING = "acquisition.prior_weighting"
ALWAYS_GUIDED = {"prior_free": 0.0, "safeguard": False, "make_up": False}
PRIOR_OF_X = "input_parameters.x.prior"


@dataclass(frozen=True)
class Case:
    """One key, another value than its default, and what becomes of both."""

    key: str
    value: Any
    effect: Mapping[str, Any] = field(default_factory=dict)
    """Our values by dotted path with that value."""

    by_default: Mapping[str, Any] = field(default_factory=dict)
    """The same without the key."""

    beside: Mapping[str, Any] = field(default_factory=dict)
    """What else is in both documents."""

    note: str = ""
    """What the note on the key has in it; no note if empty."""


def dead(key: str, value: Any, note: str = "it does nothing") -> Case:
    """Return the case of a key that changes nothing."""
    return Case(key, value, note=note)


CASES = [
    Case("application_name", "try 1", {"application_name": "try_1"}, {"application_name": "demo"}, note="'try_1'"),
    Case("optimization_objectives", ["a", "b"], {"objectives": [{"name": "a"}, {"name": "b"}]}),
    Case("input_parameters", {"c": CATEGORICAL}, {"input_parameters.c": CATEGORICAL, "input_parameters.x1": MISSING}),
    Case("feasible_output.name", "Ok", {"feasible_output.name": "Ok"}, {"feasible_output.name": "Valid"}, FEASIBLE),
    Case(
        "feasible_output.true_value",
        "1",
        {"feasible_output.true_value": "1"},
        {"feasible_output.true_value": "true"},
        FEASIBLE,
    ),
    Case(
        "feasible_output.false_value",
        "0",
        {"feasible_output.false_value": "0"},
        {"feasible_output.false_value": "false"},
        FEASIBLE,
    ),
    Case(
        "feasible_output.enable_feasible_predictor",
        True,
        {"feasible_output": {"name": "Valid", "true_value": "true", "false_value": "false"}},
        {"feasible_output": MISSING},
    ),
    dead("feasible_output.enable_feasible_predictor_grid_search_on_recall_and_precision", True),
    dead("feasible_output.feasible_predictor_grid_search_validation_file", "v.csv"),
    Case("hypermapper_mode.mode", "client-server", {"evaluator": {"type": "client_server"}}, {"evaluator": MISSING}),
    Case(
        "hypermapper_mode.exhaustive_search_file",
        "table.csv",
        {"evaluator": {"type": "exhaustive", "file": "table.csv"}},
        beside={"hypermapper_mode.mode": "exhaustive"},
    ),
    dead("timestamp", "Time", "always called Timestamp"),
    Case("optimization_method", "local_search", {"optimizer.type": "local_search"}, {"optimizer.type": "bayesian"}),
    Case("optimization_iterations", 7, {"budget.evaluations": 17}, {"budget.evaluations": 60}),
    Case(
        "evaluations_per_optimization_iteration",
        3,
        {
            "budget": {"batch_size": 3, "evaluations": 160},
            "evaluator": {"type": "none", "batch": True},
        },
        {"budget": {"evaluations": 60}, "evaluator": MISSING},
    ),
    Case(
        "time_budget", 2.5, {"budget.minutes": 2.5}, {"budget.minutes": MISSING}, note="also counts during the design"
    ),
    Case(
        "design_of_experiment.doe_type",
        "standard latin hypercube",
        {"design_of_experiment.type": "latin_hypercube"},
        {"design_of_experiment.type": "random_sampling"},
    ),
    Case(
        "design_of_experiment.number_of_samples",
        4,
        {"design_of_experiment.number_of_samples": 4, "budget.evaluations": 54},
        {"design_of_experiment.number_of_samples": 10, "budget.evaluations": 60},
    ),
    Case("resume_optimization", False, {"earlier_evaluations": MISSING}, {"earlier_evaluations": MISSING}),
    dead("resume_optimization_data", "old.csv", "without resume_optimization"),
    dead("number_of_cpus", 4),
    dead("number_of_repetitions", 3),
    dead("max_number_of_predictions", 20000),
    Case("seed", 5, {"seed": 5}, {"seed": MISSING}),
    Case(
        "models.model",
        "gaussian_process",
        {"surrogate": {"type": "gaussian_process"}},
        {
            "surrogate": {
                "type": "random_forest",
                "number_of_trees": 10,
                "max_features": 0.5,
                "min_samples_leaf": 1,
                "min_samples_split": 5,
                "bootstrap": False,
            }
        },
    ),
    Case("models.number_of_trees", 30, {"surrogate.number_of_trees": 30}, {"surrogate.number_of_trees": 10}),
    Case("models.max_features", 1, {"surrogate.max_features": 1}, {"surrogate.max_features": 0.5}),
    Case("models.bootstrap", True, {"surrogate.bootstrap": True}, {"surrogate.bootstrap": False}),
    Case("models.min_samples_split", 2, {"surrogate.min_samples_split": 2}, {"surrogate.min_samples_split": 5}),
    Case(
        "noise",
        False,
        {"surrogate": {"type": "gaussian_process", "noise": False}},
        {"surrogate": {"type": "gaussian_process"}},
        {"models.model": "gaussian_process"},
    ),
    dead("normalize_inputs", True),
    Case(
        "acquisition_function",
        "UCB",
        {"acquisition": {"type": "upper_confidence_bound", "beta": "logarithmic"}},
        {"acquisition": {"type": "expected_improvement"}},
    ),
    Case(
        "scalarization_method",
        "modified_tchebyshev",
        {"acquisition.scalarization.type": "modified_tchebyshev"},
        {"acquisition.scalarization.type": "tchebyshev"},
        TWO,
        note="sign wrong",
    ),
    dead("scalarization_key", "other"),
    Case(
        "weight_sampling",
        "bounding_box",
        {"acquisition.weights": {"type": "bounding_box", "limits": {"a": [0, 1], "b": [0, 1]}}},
        {"acquisition.weights": {"type": "dirichlet", "ends": 0.1, "redraws": 8}},
        TWO,
    ),
    Case(
        "bounding_box_limits",
        [0, 10, 8, 2],
        {"acquisition.weights.limits": {"a": [0, 10], "b": [2, 8]}},
        {"acquisition.weights.limits": {"a": [0, 1], "b": [0, 1]}},
        BOX,
    ),
    Case(
        "acquisition_function_optimizer",
        "cma_es",
        {"maximizer": {"type": "cma_es", "sigma": 0.2, "starts": 1}},
        {"maximizer": {"type": "local_search", "candidates": 2000, "starts": 10, "tolerance": 0.01}},
    ),
    Case("local_search_starting_points", 3, {"maximizer.starts": 3}, {"maximizer.starts": 10}),
    Case("local_search_random_points", 500, {"maximizer.candidates": 500}, {"maximizer.candidates": 2000}),
    Case(
        "local_search_evaluation_limit",
        300,
        {"budget.evaluations": 300, "optimizer.random_points": 300},
        {"budget.evaluations": 30000, "optimizer.random_points": 20000},
        LOCAL,
    ),
    Case(
        "local_search_scalarization_weights",
        [1, 3],
        {"optimizer.weights": [1, 3]},
        {"optimizer.weights": MISSING},
        {**LOCAL, **TWO},
        note="divided by their sum",
    ),
    Case("cma_es_sigma", 0.3, {"maximizer.sigma": 0.3}, {"maximizer.sigma": 0.2}, CMA),
    Case("cma_es_starting_points", 4, {"maximizer.starts": 4}, {"maximizer.starts": 1}, CMA),
    dead("cma_es_random_points", 50),
    Case("epsilon_greedy_threshold", 0, {"optimizer.epsilon": MISSING}, {"optimizer.epsilon": 0.1}),
    Case(
        "evolution_population_size",
        20,
        {"optimizer.population_size": 20, "budget.evaluations": 170},
        {"optimizer.population_size": 50, "budget.evaluations": 200},
        EVOLUTION,
    ),
    Case("evolution_generations", 30, {"budget.evaluations": 80}, {"budget.evaluations": 200}, EVOLUTION),
    Case(
        "mutation_rate",
        2,
        {"optimizer.mutation_rate": 2},
        {"optimizer.mutation_rate": 1},
        EVOLUTION,
        note="in HyperMapper it was always one",
    ),
    Case("evolution_crossover", True, {"optimizer.crossover": True}, {"optimizer.crossover": False}, EVOLUTION),
    Case("regularize_evolution", True, {"optimizer.regularized": True}, {"optimizer.regularized": False}, EVOLUTION),
    Case("batch_size", 5, {"optimizer.tournament_size": 5}, {"optimizer.tournament_size": 2}, EVOLUTION),
    Case(
        "prior_method",
        "bopro",
        {WEIGHTING: {"method": "bopro", "model_weight": 10, "good_quantile": 0.05, "floor": 1e-8, **ALWAYS_GUIDED}},
        {WEIGHTING: {"method": "pibo", "beta": 5.0, "floor": 1e-6, "unbounded": True, **ALWAYS_GUIDED}},
        BELIEF,
    ),
    Case("prior_beta", 3, {f"{WEIGHTING}.beta": 3.0}, {f"{WEIGHTING}.beta": 5.0}, BELIEF),
    Case("prior_floor", 0.01, {f"{WEIGHTING}.floor": 0.01}, {f"{WEIGHTING}.floor": 1e-6}, BELIEF, note="relative to"),
    Case(
        "model_posterior_weight",
        4,
        {f"{WEIGHTING}.model_weight": 4},
        {f"{WEIGHTING}.model_weight": 10},
        {**BELIEF, "prior_method": "bopro"},
    ),
    Case(
        "model_good_quantile",
        0.2,
        {f"{WEIGHTING}.good_quantile": 0.2},
        {f"{WEIGHTING}.good_quantile": 0.05},
        {**BELIEF, "prior_method": "bopro"},
    ),
    Case(
        "posterior_computation_lower_limit",
        1e-3,
        {f"{WEIGHTING}.floor": 1e-3},
        {f"{WEIGHTING}.floor": 1e-8},
        {**BELIEF, "prior_method": "bopro"},
    ),
    dead("prior_limit_estimation_points", 50),
    Case(
        "prior_estimation_file",
        "good.csv",
        {
            "priors": [
                {
                    **(
                        KDE := {
                            "type": "kde",
                            "rows": "best",
                            "quantile": 0.1,
                            "independent": True,
                            "parameters": ["x"],
                        }
                    ),
                    "file": "good.csv",
                }
            ]
        },
        {"priors": [{**KDE, "file": "samples.csv"}]},
        ESTIMATE,
    ),
    Case(
        "prior_estimation_quantile", 0.3, {"priors": [{**KDE, "file": "samples.csv", "quantile": 0.3}]}, beside=ESTIMATE
    ),
    Case(
        "estimate_multivariate_priors",
        True,
        {"priors": [{**KDE, "file": "samples.csv", "independent": False, "parameters": ["x1", "x2"]}]},
        {"priors": MISSING},
    ),
    dead("bandwidth_parameter", 4, "without a prior that is estimated"),
    dead("bandwidth_n_factor", 1, "without a prior that is estimated"),
    Case(
        "custom_gaussian_prior_means",
        [3],
        {PRIOR_OF_X: {"type": "gaussian", "mean": 3, "std": 2.0}},
        {PRIOR_OF_X: {"type": "gaussian", "mean": 0, "std": 2.0}},
        CUSTOM,
    ),
    Case(
        "custom_gaussian_prior_stds",
        [0.5],
        {PRIOR_OF_X: {"type": "gaussian", "mean": 0, "std": 0.5}},
        {PRIOR_OF_X: {"type": "gaussian", "mean": 0, "std": 2.0}},
        CUSTOM,
    ),
    Case(
        "run_directory",
        "results",
        {
            "output.directory": "results/demo_run",
            "output.samples_file": "results/demo_output_samples.csv",
            "output.pareto_file": "results/demo_output_pareto.csv",
        },
        {
            "output.directory": "demo_run",
            "output.samples_file": "demo_output_samples.csv",
            "output.pareto_file": "demo_output_pareto.csv",
        },
        note="results/demo_run",
    ),
    Case("output_data_file", "mine.csv", {"output.samples_file": "mine.csv"}),
    Case("output_pareto_file", "front.csv", {"output.pareto_file": "front.csv"}, note="written by the run itself"),
    Case(
        "print_parameter_importance",
        True,
        {"output.parameter_importance": True},
        {"output.parameter_importance": MISSING},
        note="at the end",
    ),
    Case("print_posterior_best", True, {"output.posterior_best": True}, {"output.posterior_best": MISSING}),
    dead("print_best", True),
    dead("log_file", "my.log", "run.log"),
    dead("verbose_logging", True),
    dead("profiling", True),
    dead("profiling_file", "p.csv"),
    dead("append_profiles", True),
    dead("output_image.output_image_pdf_file", "front.pdf"),
    dead("output_image.optimization_objectives_labels_image_pdf", ["a", "b"]),
    dead("output_image.image_xlog", True),
    dead("output_image.image_ylog", True),
    dead("output_image.objective_1_max", 100),
    dead("output_image.objective_2_max", 100),
    dead("bopro_mode", "all"),
    dead("resample_mean", True),
    dead("estimate_multivariate_gaussian", True),
]
WITH_DEFAULT = [case for case in CASES if case.by_default]
WRITTEN_OUT = [
    case
    for case in CASES
    if KEYS[case.key].default is not None
    and case.beside is not FEASIBLE
    and case.key not in ("application_name", "seed")
]
"""Cases whose default can stand in the file; an object feasible_output brings other defaults than none."""

VERSION_2 = [name for name, key in KEYS.items() if not key.is_version_3]


def test_every_key_has_a_case() -> None:
    assert [case.key for case in CASES] == VERSION_2


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.key)
def test_a_value_takes_effect(case: Case) -> None:
    document = translate(of_dotted({**case.beside, case.key: case.value})).document
    assert {path: at(document, path) for path in case.effect} == case.effect


@pytest.mark.parametrize("case", WITH_DEFAULT, ids=lambda case: case.key)
def test_the_default_is_hypermappers(case: Case) -> None:
    document = translate(of_dotted(case.beside)).document
    assert {path: at(document, path) for path in case.by_default} == case.by_default


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.key)
def test_what_is_said_of_a_key(case: Case) -> None:
    said = note_on(translate(of_dotted({**case.beside, case.key: case.value})), case.key)
    assert case.note in said
    assert bool(said) == bool(case.note)


@pytest.mark.parametrize("case", WRITTEN_OUT, ids=lambda case: case.key)
def test_the_default_written_out_is_the_default_left_out(case: Case) -> None:
    written = translate(of_dotted({**case.beside, case.key: KEYS[case.key].default})).document
    assert written == translate(of_dotted(case.beside)).document


@pytest.mark.parametrize("case", [case for case in CASES if KEYS[case.key].is_dead], ids=lambda case: case.key)
def test_a_key_without_effect_changes_nothing_and_is_named_in_one_line(case: Case) -> None:
    translation = translate(of_dotted({**case.beside, case.key: case.value}))
    assert translation.document == translate(of_dotted(case.beside)).document
    assert translation.brief() == (f"{case.key}: nothing follows from this key here",)


@pytest.mark.parametrize("name", [name for name in KEYS if "." not in name and KEYS[name].schema])
def test_a_value_of_the_wrong_type_is_named_with_hypermappers_key(name: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        translate(of_dotted({name: {"a": 1} if name != "input_parameters" else 3}))
    assert caught.value.path == f"$.{name}"
    assert caught.value.allowed


@pytest.mark.parametrize("name", [name for name, key in KEYS.items() if key.is_version_3])
def test_keys_of_version_3_bring_its_defaults(name: str) -> None:
    values = {"string": "gpy", "number": 0.5, "integer": 3, "boolean": True}
    value = "RBF" if not KEYS[name].schema else values[str(KEYS[name].schema["type"])]
    document = translate(of_dotted({name: value}))
    assert document.document["surrogate"] == {"type": "gaussian_process"}
    assert note_on(document, name) or name in ("model_weight", "resume_optimization_file")


def test_the_places_of_the_table_exist_in_our_schemas() -> None:
    known = {*root_schema()["properties"], "output"}
    coming = {"feasible_output", "earlier_evaluations", "constraints"}
    heads = {place.split(".")[0].split("[")[0] for key in KEYS.values() if key.here for place in key.here.split(", ")}
    assert heads <= known | coming


def test_what_is_written_in_our_form_already_holds_a_scenario() -> None:
    document = dict(translate(dict(GOOD)).document)
    document["output"] = {"directory": document["output"]["directory"]}
    check_document(document)


def test_parameters_keep_their_order_and_types() -> None:
    assert parameter(CATEGORICAL) == CATEGORICAL
