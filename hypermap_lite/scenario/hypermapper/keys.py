"""HyperMapper's keys: default, what is allowed, which of ours each becomes, and what differs.

The table is the one place that lists them: files are read and checked by it, and the manual's table is held against it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

DEAD: Final = "it does nothing here"
"""Note on a key without any effect."""


@dataclass(frozen=True, slots=True)
class Key:
    """One key of HyperMapper's scenario files; a dot leads into a nested object."""

    name: str
    default: Any
    """HyperMapper's default; None if there is none."""

    schema: Mapping[str, Any]
    """What is allowed, as JSON Schema."""

    here: str = ""
    """Our key, or keys, that it becomes; empty if it does nothing."""

    note: str = ""
    """What differs, shown where a file has the key; a clause that follows the key and a colon."""

    fork: bool = False
    """Whether only forks of HyperMapper have it: the one of piBO, or the branch of version 3."""

    is_version_3: bool = field(default=False)
    """Whether it tells that a file was written for the branch of version 3, which has other defaults."""

    @property
    def is_dead(self) -> bool:
        """Whether it does nothing."""
        return not self.here


def integer(least: int | None = None) -> dict[str, Any]:
    """Return the schema of an integer, not below a number."""
    return {"type": "integer"} | ({} if least is None else {"minimum": least})


def number(least: float | None = None, most: float | None = None) -> dict[str, Any]:
    """Return the schema of a number within bounds."""
    limits = {"minimum": least, "maximum": most}
    return {"type": "number"} | {name: limit for name, limit in limits.items() if limit is not None}


def between(low: float, high: float) -> dict[str, Any]:
    """Return the schema of a number between two others."""
    return {"type": "number", "exclusiveMinimum": low, "exclusiveMaximum": high}


def choice(title: str, *names: object) -> dict[str, Any]:
    """Return the schema of one of some values; `title` is what a message calls it."""
    return {"title": title, "enum": list(names)}


def numbers() -> dict[str, Any]:
    """Return the schema of a list of numbers that is not empty."""
    return {"type": "array", "items": {"type": "number"}, "minItems": 1}


FLAG: Final[Mapping[str, Any]] = {"type": "boolean"}
TEXT: Final[Mapping[str, Any]] = {"type": "string"}
NAMES: Final[Mapping[str, Any]] = {"type": "array", "items": {"type": "string"}, "minItems": 1, "uniqueItems": True}
OBJECT: Final[Mapping[str, Any]] = {"type": "object"}
ANY: Final[Mapping[str, Any]] = {}

METHODS: Final = (
    "bayesian_optimization",
    "random_scalarizations",
    "prior_guided_optimization",
    "local_search",
    "evolutionary_optimization",
)

NESTED: Final = ("hypermapper_mode", "models", "design_of_experiment", "feasible_output", "output_image")
"""Objects whose keys are listed with a dot."""

PROBLEM: Final = (
    Key("application_name", "application", TEXT, "application_name, output"),
    Key("optimization_objectives", None, NAMES, "objectives"),
    Key("input_parameters", None, {"type": "object", "minProperties": 1}, "input_parameters"),
    Key("feasible_output.name", "Valid", TEXT, "feasible_output.name"),
    Key("feasible_output.true_value", "True", TEXT, "feasible_output.true_value"),
    Key("feasible_output.false_value", "False", TEXT, "feasible_output.false_value"),
    Key("feasible_output.enable_feasible_predictor", False, FLAG, "feasible_output"),
    Key(
        "feasible_output.enable_feasible_predictor_grid_search_on_recall_and_precision",
        False,
        FLAG,
        note=f"{DEAD}; the feasibility model needs no grid search",
    ),
    Key("feasible_output.feasible_predictor_grid_search_validation_file", "", TEXT, note=DEAD),
    Key("hypermapper_mode.mode", "default", choice("Mode", "default", "client-server", "exhaustive"), "evaluator.type"),
    Key("hypermapper_mode.exhaustive_search_file", None, TEXT, "evaluator.file"),
    Key(
        "timestamp",
        "Timestamp",
        TEXT,
        note="the column is always called Timestamp, and holds milliseconds since the start",
    ),
)

BUDGET: Final = (
    Key("optimization_method", "bayesian_optimization", choice("Method", *METHODS), "optimizer.type"),
    Key("optimization_iterations", 50, integer(0), "budget.evaluations"),
    Key("evaluations_per_optimization_iteration", 1, integer(1), "budget.batch_size"),
    Key(
        "time_budget",
        -1,
        number(-1),
        "budget.minutes",
        "it also counts during the design, and with every method; what runs is finished",
    ),
    Key(
        "design_of_experiment.doe_type",
        "random sampling",
        choice("Design", "random sampling", "standard latin hypercube", "k latin hypercube", "grid_search"),
        "design_of_experiment.type",
    ),
    Key("design_of_experiment.number_of_samples", 10, integer(0), "design_of_experiment.number_of_samples"),
    Key("resume_optimization", False, FLAG, "earlier_evaluations"),
    Key("resume_optimization_data", "output_samples.csv", TEXT, "earlier_evaluations"),
    Key("number_of_cpus", 0, integer(), note=f"{DEAD}; suggestions need no processes"),
    Key("number_of_repetitions", 1, integer(1), note=f"{DEAD}, and did nothing before; see evaluator.replicates"),
    Key("max_number_of_predictions", 1000000, integer(), note=f"{DEAD}, and did nothing before"),
    Key("seed", 0, integer(0), "seed", fork=True),
)

MODEL: Final = (
    Key("models.model", "random_forest", choice("Model", "random_forest", "gaussian_process"), "surrogate.type"),
    Key("models.number_of_trees", 10, integer(1), "surrogate.number_of_trees"),
    Key("models.max_features", 0.5, number(0, 1), "surrogate.max_features"),
    Key("models.bootstrap", False, FLAG, "surrogate.bootstrap"),
    Key("models.min_samples_split", 5, integer(2), "surrogate.min_samples_split"),
    Key("noise", True, FLAG, "surrogate.noise"),
    Key("normalize_inputs", False, FLAG, note=f"{DEAD}; every parameter is scaled to the unit interval"),
    Key("acquisition_function", "EI", choice("Acquisition function", "EI", "UCB", "TS"), "acquisition.type"),
    Key(
        "scalarization_method",
        "tchebyshev",
        choice("Scalarization", "linear", "tchebyshev", "modified_tchebyshev"),
        "acquisition.scalarization",
    ),
    Key("scalarization_key", "scalarization", TEXT, note=f"{DEAD}; values other than its default were fatal"),
    Key("weight_sampling", "flat", choice("Weight sampling", "flat", "bounding_box"), "acquisition.weights.type"),
    Key("bounding_box_limits", [0, 1], numbers(), "acquisition.weights.limits"),
    Key(
        "acquisition_function_optimizer",
        "local_search",
        choice("Acquisition function optimizer", "local_search", "cma_es"),
        "maximizer.type",
    ),
    Key("local_search_starting_points", 10, integer(1), "maximizer.starts"),
    Key("local_search_random_points", 10000, integer(1), "maximizer.candidates"),
    Key("local_search_evaluation_limit", -1, integer(-1), "budget.evaluations"),
    Key("local_search_scalarization_weights", [1], numbers(), "optimizer.weights"),
    Key("cma_es_sigma", 0.2, {"type": "number", "exclusiveMinimum": 0}, "maximizer.sigma"),
    Key("cma_es_starting_points", 1, integer(1), "maximizer.starts"),
    Key("cma_es_random_points", 10000, integer(), note=f"{DEAD}, and did nothing before"),
    Key("epsilon_greedy_threshold", 0.1, number(0, 1), "optimizer.epsilon"),
    Key("evolution_population_size", 50, integer(2), "optimizer.population_size"),
    Key("evolution_generations", 150, integer(0), "budget.evaluations"),
    Key("mutation_rate", 1, integer(1), "optimizer.mutation_rate"),
    Key("evolution_crossover", False, FLAG, "optimizer.crossover"),
    Key("regularize_evolution", False, FLAG, "optimizer.regularized"),
    Key("batch_size", 2, integer(1), "optimizer.tournament_size"),
)

BELIEF: Final = (
    Key("prior_method", "pibo", TEXT, "acquisition.prior_weighting.method"),
    Key("prior_beta", -1, number(), "acquisition.prior_weighting.beta"),
    Key("prior_floor", 1e-6, number(0), "acquisition.prior_weighting.floor"),
    Key(
        "model_posterior_weight",
        10,
        {"type": "number", "exclusiveMinimum": 0},
        "acquisition.prior_weighting.model_weight",
    ),
    Key("model_good_quantile", 0.05, between(0, 1), "acquisition.prior_weighting.good_quantile"),
    Key("posterior_computation_lower_limit", 1e-8, between(0, 0.5), "acquisition.prior_weighting.floor"),
    Key(
        "prior_limit_estimation_points",
        10000,
        integer(),
        note=f"{DEAD}; the prior's largest density is known, not estimated",
    ),
    Key("prior_estimation_file", "samples.csv", TEXT, "priors[].file"),
    Key("prior_estimation_quantile", 0.1, number(0, 1), "priors[].quantile"),
    Key("estimate_multivariate_priors", False, FLAG, "priors[].independent"),
    Key("bandwidth_parameter", 0, integer(0), "priors[].bandwidth_factor"),
    Key("bandwidth_n_factor", 100, integer(1), "priors[].bandwidth_factor"),
    Key("custom_gaussian_prior_means", [0], numbers(), "input_parameters.*.prior"),
    Key("custom_gaussian_prior_stds", [-1], numbers(), "input_parameters.*.prior"),
)

FILES: Final = (
    Key("run_directory", ".", TEXT, "output"),
    Key("output_data_file", "output_samples.csv", TEXT, "output.samples_file"),
    Key(
        "output_pareto_file",
        "output_pareto.csv",
        TEXT,
        "output.pareto_file",
        "it is written by the run itself, with all objectives",
    ),
    Key("print_parameter_importance", False, FLAG, "output.parameter_importance", "printed once, at the end"),
    Key("print_posterior_best", False, FLAG, "output.posterior_best"),
    Key(
        "print_best",
        "auto",
        choice("Choice", "auto", True, False),
        note=f"{DEAD}; a run ends with its best point or front (client-server: on stderr), and from Python returns it",
    ),
    Key("log_file", "hypermapper_logfile.log", TEXT, note=f"{DEAD}; the log is run.log in the run folder"),
    Key("verbose_logging", False, FLAG, note=DEAD),
    Key("profiling", False, FLAG, note=f"{DEAD}; history.csv has the seconds of each suggestion and evaluation"),
    Key("profiling_file", "profiles/profile.csv", TEXT, note=DEAD),
    Key("append_profiles", False, FLAG, note=DEAD),
    Key(
        "output_image.output_image_pdf_file",
        "output_pareto.pdf",
        TEXT,
        note=f"{DEAD}; `python -m hypermap_lite plot pareto` draws fronts",
    ),
    Key("output_image.optimization_objectives_labels_image_pdf", None, {"type": "array"}, note=DEAD),
    Key("output_image.image_xlog", False, FLAG, note=DEAD),
    Key("output_image.image_ylog", False, FLAG, note=DEAD),
    Key("output_image.objective_1_max", None, number(), note=DEAD),
    Key("output_image.objective_2_max", None, number(), note=DEAD),
)
