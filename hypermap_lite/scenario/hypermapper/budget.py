"""HyperMapper's design and budget: how many evaluations, in which batches, and what was evaluated before."""

from __future__ import annotations

import math
from typing import Any, Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.defaults import has_priors
from hypermap_lite.scenario.hypermapper.draft import Draft, Note
from hypermap_lite.scenario.hypermapper.files import earlier_rows, n_usable, resumed_file
from hypermap_lite.scenario.hypermapper.method import family

GRID_LEVELS: Final = 10
"""Values of a real parameter on a grid."""

MAX_GRID: Final = 100_000
"""Most points of a grid."""

CLIMBS: Final = 10_000
"""Evaluations of the climbs of a local search without limit."""

BAYESIAN_KEYS: Final = (
    "evaluations_per_optimization_iteration",
    "optimization_iterations",
    "resume_optimization",
    "resume_optimization_data",
    "design_of_experiment.doe_type",
    "design_of_experiment.number_of_samples",
)
"""Keys that mean something only with a model."""


def translate_budget(draft: Draft) -> None:
    """Translate the design and the budget.

    Raises
    ------
    ScenarioError
        If nothing would be evaluated, or what a run resumes from cannot be read.
    """
    _translate_time(draft)
    kind = family(draft)
    if kind == "bayesian":
        _translate_batches(draft)
        _translate_design(draft)
        return
    draft.unused(BAYESIAN_KEYS, f"with {draft.reading['optimization_method']}")
    if kind == "local_search":
        _translate_climbs(draft)
    else:
        _translate_generations(draft)


def _translate_time(draft: Draft) -> None:
    minutes = draft.reading["time_budget"]
    if minutes == 0:
        problem, allowed = "no time is left for any evaluation", "minutes > 0, or -1 for no limit"
        raise ScenarioError("$.time_budget", problem, allowed=allowed)
    if minutes > 0:
        draft.set("budget.minutes", minutes, "time_budget")


def _translate_batches(draft: Draft) -> None:
    """Translate the size of batches, and say which of two meanings ``batch_size`` has."""
    reading, key = draft.reading, "evaluations_per_optimization_iteration"
    if reading.is_version_3 and not reading.has(key):
        key = "batch_size"
        if reading.has(key):
            draft.note(key, "evaluations at a time, as in version 3, whose other keys the file has")
    elif reading.has("batch_size"):
        text = f"it does nothing: in HyperMapper 2 it is the tournament size of evolutionary search; batches are {key}"
        draft.notes.append(Note("batch_size", text, is_dead=True))
    if reading[key] == 1:
        return
    draft.set("budget.batch_size", reading[key], key)
    if reading["hypermapper_mode.mode"] == "default":
        draft.set("evaluator.type", "none", key)
        draft.set("evaluator.batch", True, key)


def _translate_design(draft: Draft) -> None:
    reading, path = draft.reading, "design_of_experiment"
    name, samples = reading[f"{path}.doe_type"], reading[f"{path}.number_of_samples"]
    iterations = reading["optimization_iterations"] * draft.document.get("budget", {}).get("batch_size", 1)
    _set_design(draft, name, f"{path}.doe_type")
    old = _translate_resumption(draft)
    if name == "grid_search":
        samples, iterations = grid_size(draft), 0
        draft.set(f"{path}.levels", GRID_LEVELS, f"{path}.doe_type")
        draft.note(f"{path}.doe_type", f"the grid's {samples} points, and nothing after them, as before")
    if not samples and not old:
        draft.note(f"{path}.number_of_samples", "without a design the first of the other evaluations is a draw")
    evaluations = max(samples, old) + iterations
    if evaluations < 1:
        problem = "without a design and without iterations there is nothing to evaluate"
        raise ScenarioError(f"$.{path}.number_of_samples", problem, allowed="one of the two > 0")
    draft.set(f"{path}.number_of_samples", max(samples, 1), f"{path}.number_of_samples")
    draft.set("budget.evaluations", evaluations, "optimization_iterations")


def _set_design(draft: Draft, name: str, key: str) -> None:
    """Set the type of the design by HyperMapper's name of it; all draws follow the priors, or none."""
    kind = _design(draft, name)
    draft.set("design_of_experiment.type", kind, key)
    if kind == "prior_sampling":
        draft.set("design_of_experiment.uniform_share", 0.0, key)


def _design(draft: Draft, name: str) -> str:
    """Return our name of a design; draws follow the priors where there are any."""
    has_belief = has_priors(draft.document)
    if name == "embedding random sampling":
        draft.note("design_of_experiment.doe_type", "here it is random sampling that keeps the constraints")
    if name == "standard latin hypercube":
        return "prior_latin_hypercube" if has_belief else "latin_hypercube"
    if name == "k latin hypercube":
        return "k_latin_hypercube"
    if name == "grid_search":
        return "grid"
    return "prior_sampling" if has_belief else "random_sampling"


def _translate_resumption(draft: Draft) -> int:
    """Translate what a run resumes from; return its number of evaluations."""
    table = earlier_rows(draft)
    if table is None:
        draft.unused(("resume_optimization_data",), "without resume_optimization")
        return 0
    key, file = resumed_file(draft)
    draft.set("earlier_evaluations", draft.file(file), key)
    n = n_usable(table)
    text = f"{file} has {n} evaluations now; the iterations come on top, and the priors' decay goes on"
    draft.note("resume_optimization", text)
    return n


def grid_size(draft: Draft) -> int:
    """Return the number of points of the full grid, and of the default configuration if that is none of them.

    Raises
    ------
    ScenarioError
        If it is too large.
    """
    size, has_default, is_on_grid = 1, False, True
    for entry in draft.document["input_parameters"].values():
        kind, values, default = entry["parameter_type"], entry["values"], entry.get("parameter_default")
        has_default |= default is not None
        if kind == "real":
            size *= GRID_LEVELS
            is_on_grid &= default is not None and _is_level(default, *values)
        elif kind == "integer":
            size *= round(max(values) - min(values)) + 1
        else:
            size *= math.factorial(values[0]) if kind == "permutation" else len(values)
    if size > MAX_GRID:
        allowed = f"a grid of at most {MAX_GRID} points"
        raise ScenarioError("$.design_of_experiment.doe_type", f"the grid has {size} points", allowed=allowed)
    return size + (has_default and not is_on_grid)


def _is_level(value: Any, low: float, high: float) -> bool:
    position = (value - low) / (high - low) * (GRID_LEVELS - 1)
    return math.isclose(position, round(position), abs_tol=1e-9)


def _translate_climbs(draft: Draft) -> None:
    """Translate the budget of a local search: random points, then climbs."""
    reading = draft.reading
    points, limit = 2 * reading["local_search_random_points"], reading["local_search_evaluation_limit"]
    evaluations = points + CLIMBS if limit < 1 else limit
    _set_design(draft, "random sampling", "optimization_method")
    for place in ("design_of_experiment.number_of_samples", "optimizer.random_points"):
        draft.set(place, min(points, evaluations), "local_search_random_points")
    draft.set("budget.evaluations", evaluations, "local_search_evaluation_limit")
    draft.note("local_search_random_points", f"{points} evaluations of the black box, before the climbs, as before")
    if limit < 1:
        draft.note("local_search_evaluation_limit", f"no limit is one of {evaluations} evaluations here")


def _translate_generations(draft: Draft) -> None:
    """Translate the budget of evolutionary search: a population, then one evaluation per generation."""
    reading = draft.reading
    population = reading["evolution_population_size"]
    _set_design(draft, "random sampling", "optimization_method")
    draft.set("design_of_experiment.number_of_samples", population, "evolution_population_size")
    evaluations = population + reading["evolution_generations"]
    draft.set("budget.evaluations", evaluations, "evolution_generations")
