"""HyperMapper's methods: optimizer, model, acquisition, its maximizer, and the weighting by priors."""

from __future__ import annotations

from typing import Any, Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.defaults import has_priors
from hypermap_lite.scenario.hypermapper.draft import Draft
from hypermap_lite.scenario.hypermapper.weighting import translate_weighting

MAX_CANDIDATES: Final = 2000
"""Most configurations that the acquisition is maximized over before the local search."""

TOLERANCE: Final = 1e-2
"""Gain for which a climb goes on, relative to what the best candidate is above the median one."""

ACQUISITIONS: Final = {
    "EI": "expected_improvement",
    "EI_PIBO": "expected_improvement",
    "UCB": "upper_confidence_bound",
    "TS": "thompson_sampling",
    "qLogNEI": "noisy_expected_improvement",
    "qLogNEHVI": "noisy_expected_hypervolume_improvement",
}
"""Ours by HyperMapper's names, those of version 3 included."""

MODEL_KEYS: Final = ("models.number_of_trees", "models.max_features", "models.bootstrap", "models.min_samples_split")
CMA_KEYS: Final = ("cma_es_sigma", "cma_es_starting_points")
BOX_KEYS: Final = ("bounding_box_limits",)
EVOLUTION_KEYS: Final = (
    "evolution_population_size",
    "evolution_generations",
    "mutation_rate",
    "evolution_crossover",
    "regularize_evolution",
)
ALSO_AT_THE_ENDS: Final = {"ends": 0.1, "redraws": 8}
"""What uniform weights need to reach the ends of a front, and to spend no evaluation on what is found."""

LOCAL_SEARCH_KEYS: Final = ("local_search_evaluation_limit", "local_search_scalarization_weights")
BAYESIAN_KEYS: Final = (
    "acquisition_function",
    "weight_sampling",
    "acquisition_function_optimizer",
    "local_search_starting_points",
    "epsilon_greedy_threshold",
    "models.model",
    "noise",
    "prior_method",
    "prior_beta",
    "prior_floor",
)


def family(draft: Draft) -> str:
    """Return the optimizer: three of HyperMapper's five methods are the same."""
    method = draft.reading["optimization_method"]
    ours = {"local_search": "local_search", "evolutionary_optimization": "evolutionary"}
    return ours.get(method, "bayesian")


def translate_method(draft: Draft) -> None:
    """Translate how configurations are chosen."""
    kind, reading = family(draft), draft.reading
    key = "optimization_method"
    draft.set("optimizer.type", kind, key)
    if kind != "evolutionary":
        draft.unused(EVOLUTION_KEYS, "without evolutionary_optimization")
    if kind != "local_search":
        draft.unused(LOCAL_SEARCH_KEYS, "without the method local_search")
    if kind != "bayesian":
        draft.unused((*BAYESIAN_KEYS, *MODEL_KEYS, *CMA_KEYS, *BOX_KEYS), f"with {reading[key]}")
    if kind == "bayesian":
        if reading["epsilon_greedy_threshold"] > 0:
            draft.set("optimizer.epsilon", reading["epsilon_greedy_threshold"], "epsilon_greedy_threshold")
        _translate_model(draft)
        _translate_acquisition(draft)
        _translate_maximizer(draft)
        translate_weighting(draft)
    elif kind == "local_search":
        _translate_local_search(draft)
    else:
        _translate_evolution(draft)
    if len(reading["optimization_objectives"]) > 1 and has_priors(draft.document):
        draft.note("input_parameters", "the priors count with several objectives too; HyperMapper dropped them")


def _translate_model(draft: Draft) -> None:
    reading = draft.reading
    draft.set("surrogate.type", reading["models.model"], "models.model")
    if reading["models.model"] == "gaussian_process":
        draft.unused(MODEL_KEYS, "with gaussian_process")
        if not reading["noise"]:
            draft.set("surrogate.noise", False, "noise")
        return
    draft.unused(("noise",), "with random_forest")
    if reading["models.number_of_trees"] < 2:
        draft.note("models.number_of_trees", "here it is 2; one tree alone knows no uncertainty")
    draft.set("surrogate.number_of_trees", max(reading["models.number_of_trees"], 2), "models.number_of_trees")
    # no share of the parameters is one parameter
    share = reading["models.max_features"] or 1 / len(reading.parameters)
    draft.set("surrogate.max_features", share, "models.max_features")
    draft.set("surrogate.min_samples_leaf", 1, "models.model")
    draft.set("surrogate.min_samples_split", reading["models.min_samples_split"], "models.min_samples_split")
    draft.set("surrogate.bootstrap", reading["models.bootstrap"], "models.bootstrap")


def _translate_acquisition(draft: Draft) -> None:
    reading, name = draft.reading, draft.reading["acquisition_function"]
    draft.set("acquisition.type", ACQUISITIONS[name], "acquisition_function")
    if name == "UCB":
        draft.set("acquisition.beta", "logarithmic", "acquisition_function")
    if name == "TS":
        draft.note(
            "acquisition_function", "a draw from the model, with either model; HyperMapper's was its mean, or EI"
        )
    if len(reading["optimization_objectives"]) == 1 or name == "qLogNEHVI":
        reason = "with one objective" if len(reading["optimization_objectives"]) == 1 else "with qLogNEHVI"
        draft.unused(("scalarization_method", "weight_sampling", *BOX_KEYS), reason)
        return
    if reading["scalarization_method"] == "modified_tchebyshev":
        draft.note("scalarization_method", "with expected improvement, HyperMapper had its sign wrong")
    draft.set("acquisition.scalarization.type", reading["scalarization_method"], "scalarization_method")
    if reading["weight_sampling"] == "flat":
        draft.unused(BOX_KEYS, "with flat weights")
        draft.set("acquisition.weights", {"type": "dirichlet", **ALSO_AT_THE_ENDS}, "weight_sampling")
        draft.note(
            "weight_sampling", "one draw in ten looks at one objective alone; trade-offs that are found are passed over"
        )
        return
    draft.set("acquisition.weights.type", "bounding_box", "weight_sampling")
    draft.set("acquisition.weights.limits", _limits(draft), "bounding_box_limits")


def _limits(draft: Draft) -> dict[str, list[float]]:
    """Return [low, high] per objective; one pair is for all, and reversed pairs are swapped."""
    names, numbers = draft.reading["optimization_objectives"], draft.reading["bounding_box_limits"]
    if len(numbers) not in (2, 2 * len(names)):
        problem, allowed = f"there are {len(numbers)} numbers", f"2, or 2 per objective: {2 * len(names)}"
        raise ScenarioError("$.bounding_box_limits", problem, allowed=allowed)
    pairs = [sorted(numbers[i : i + 2]) for i in range(0, len(numbers), 2)]
    return dict(zip(names, pairs * (len(names) if len(pairs) == 1 else 1), strict=True))


def _translate_maximizer(draft: Draft) -> None:
    reading, key = draft.reading, "acquisition_function_optimizer"
    are_real = all(entry["parameter_type"] == "real" for entry in reading.parameters.values())
    if reading[key] == "cma_es" and are_real:
        draft.set("maximizer.type", "cma_es", key)
        draft.set("maximizer.sigma", reading["cma_es_sigma"], "cma_es_sigma")
        draft.set("maximizer.starts", reading["cma_es_starting_points"], "cma_es_starting_points")
        draft.unused(("local_search_starting_points", "local_search_random_points"), "with cma_es")
        return
    if reading[key] == "cma_es":
        draft.note(key, "here it is local_search: cma_es needs real parameters only")
    draft.unused(CMA_KEYS, "without cma_es")
    points = reading["local_search_random_points"]
    draft.set("maximizer.type", "local_search", key)
    draft.set("maximizer.candidates", min(points, MAX_CANDIDATES), "local_search_random_points")
    draft.set("maximizer.starts", reading["local_search_starting_points"], "local_search_starting_points")
    draft.set("maximizer.tolerance", TOLERANCE, key)
    if points > MAX_CANDIDATES:
        draft.note("local_search_random_points", f"{MAX_CANDIDATES} evenly spread candidates, and some from the priors")


def _translate_local_search(draft: Draft) -> None:
    reading = draft.reading
    weights: list[Any] = reading["local_search_scalarization_weights"]
    names = reading["optimization_objectives"]
    draft.set("optimizer.improvement", "best", "optimization_method")
    if len(names) > 1:
        draft.set("acquisition.scalarization.type", reading["scalarization_method"], "scalarization_method")
    else:
        draft.unused(("scalarization_method",), "with one objective")
    if weights == [1]:
        return
    if len(weights) != len(names):
        problem = f"there are {len(weights)} weights for {len(names)} objectives"
        raise ScenarioError("$.local_search_scalarization_weights", problem, allowed=f"{len(names)} numbers")
    draft.set("optimizer.weights", weights, "local_search_scalarization_weights")
    if len(names) > 1:
        draft.note("local_search_scalarization_weights", "divided by their sum; HyperMapper's division went wrong")


def _translate_evolution(draft: Draft) -> None:
    reading = draft.reading
    if len(reading["optimization_objectives"]) > 1:
        problem, key = "evolutionary_optimization has one objective", "$.optimization_objectives"
        raise ScenarioError(key, problem, allowed="a list of 1 name", hint="Use bayesian_optimization for several.")
    draft.unused(("scalarization_method",), "with one objective")
    names = {
        "evolution_population_size": "population_size",
        "batch_size": "tournament_size",
        "mutation_rate": "mutation_rate",
        "evolution_crossover": "crossover",
        "regularize_evolution": "regularized",
    }
    for key, ours in names.items():
        draft.set(f"optimizer.{ours}", reading[key], key)
    if reading["mutation_rate"] > 1:
        draft.note("mutation_rate", "so many parameters change; in HyperMapper it was always one")
