"""Keys that only forks of HyperMapper have, those of a parameter, and the table of all."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from hypermap_lite.scenario.hypermapper.keys import (
    ANY,
    BELIEF,
    BUDGET,
    DEAD,
    FILES,
    FLAG,
    MODEL,
    PROBLEM,
    TEXT,
    Key,
    choice,
    integer,
    number,
)


def _version_3(name: str, schema: Mapping[str, Any], here: str = "", note: str = "", default: Any = None) -> Key:
    return Key(name, default, schema, here, note or ("" if here else DEAD), fork=True, is_version_3=True)


VERSION_3: Final = (
    _version_3("GP_model", TEXT, "surrogate", "all its Gaussian processes are our one"),
    _version_3("model_weight", number(0), "acquisition.prior_weighting.beta", default=10),
    _version_3("resume_optimization_file", TEXT, "earlier_evaluations"),
    _version_3("feasible_output.feasibility_threshold", number(0, 1)),
    _version_3("design_of_experiment.allow_repetitions", FLAG, note=f"{DEAD}; no configuration is evaluated twice"),
    _version_3("models.use_all_data_to_fit_mean", FLAG),
    _version_3("models.use_all_data_to_fit_variance", FLAG),
    _version_3("models.add_linear_std", FLAG),
    _version_3("acq_batch_size", integer()),
    _version_3("allow_duplicate_samples", FLAG, note=f"{DEAD}; no configuration is evaluated twice"),
    _version_3("exploration_augmentation", number()),
    _version_3("hyperparameter_optimization_iterations", integer()),
    _version_3("multistart_hyperparameter_optimization", FLAG),
    _version_3("reoptimise_hyperparameters_interval", integer()),
    _version_3("reuse_gp_hyperparameters", FLAG),
    _version_3("lengthscale_prior", ANY),
    _version_3("outputscale_prior", ANY),
    _version_3("noise_prior", ANY),
    _version_3("local_search_from_best", FLAG),
    _version_3("local_search_step_size", number()),
    _version_3("local_search_improvement_threshold", number()),
    _version_3("log_acq_value", FLAG),
    _version_3("log_transform_output", FLAG),
    _version_3("standardize_objectives", FLAG, note=f"{DEAD}; objectives are always standardized"),
    _version_3("minimize", ANY, note=f"{DEAD}; say goal maximize of an objective in a file that extends this one"),
    _version_3("objective_value_target", ANY),
    _version_3("parameterize_lambda", FLAG),
    _version_3("predict_noiseless", FLAG),
    _version_3("use_cot", FLAG, note=f"{DEAD}; constraints are always kept"),
    _version_3("naive_cot_rs", FLAG),
)

PIBO_FORK: Final = (
    Key("bopro_mode", None, ANY, note=f"{DEAD}; see prior_method", fork=True),
    Key("resample_mean", None, ANY, note=DEAD, fork=True),
    Key("estimate_multivariate_gaussian", None, ANY, note=f"{DEAD}; see estimate_multivariate_priors", fork=True),
)

KEYS: Final[Mapping[str, Key]] = {
    key.name: key for key in (*PROBLEM, *BUDGET, *MODEL, *BELIEF, *FILES, *VERSION_3, *PIBO_FORK)
}
"""Every key of HyperMapper's scenario files, those of its parameters aside."""

_LIST = {"type": ["array", "string"]}

PARAMETER_KEYS: Final[Mapping[str, Key]] = {
    key.name: key
    for key in (
        Key(
            "parameter_type",
            None,
            choice("Parameter type", "real", "integer", "ordinal", "categorical", "permutation"),
            "parameter_type",
        ),
        Key("values", None, {"type": "array", "items": {"type": ["number", "string"]}, "minItems": 1}, "values"),
        Key("parameter_default", None, {"type": ["number", "string", "array"]}, "parameter_default"),
        Key("prior", "uniform", _LIST, "prior"),
        Key("custom_gaussian_prior_means", False, {"type": ["array", "boolean"]}, "prior"),
        Key("custom_gaussian_prior_stds", False, {"type": ["array", "boolean"]}, "prior"),
        _version_3("prior_parameters", {"type": "array", "items": {"type": "number"}}, "prior"),
        _version_3("transform", choice("Transform", "none", "log"), "scale", default="none"),
        _version_3("constraints", {"type": "array", "items": {"type": "string"}}, "constraints"),
        _version_3("dependencies", {"type": "array"}, note=f"{DEAD}; they follow from the constraints"),
        _version_3(
            "parametrization",
            choice("Parametrization", "spearman", "kendall", "hamming", "naive", "mallows", "transformed_overlap"),
            "kernel",
            default="spearman",
        ),
    )
}
"""Keys of one entry of ``input_parameters``."""

VERSION_3_DEFAULTS: Final[Mapping[str, Any]] = {
    "models.model": "gaussian_process",
    "models.number_of_trees": 200,
    "models.bootstrap": True,
    "models.min_samples_split": 2,
    "epsilon_greedy_threshold": 0,
    "local_search_random_points": 5000,
    "acquisition_function": "qLogNEI",
    "batch_size": 1,
}
"""Where version 3 has other defaults."""

VERSION_3_CHOICES: Final[Mapping[str, tuple[str, ...]]] = {
    "acquisition_function": ("EI_PIBO", "qLogNEI", "qLogNEHVI"),
    "hypermapper_mode.mode": ("stateless", "grpc"),
    "design_of_experiment.doe_type": ("embedding random sampling",),
}
"""Values that version 3 has besides."""
