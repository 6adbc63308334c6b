"""Filling in what a scenario leaves out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from hypermap_lite.scenario.schemas import Schema, child_schema, items_schema, properties_of

SAMPLES_PER_PARAMETER = 2
"""Points of the default design per parameter."""

MIN_SAMPLES = 6
"""Points of the smallest default design."""

SCALARIZING: Final = "noisy_expected_improvement"
"""Acquisition function where a scalarization or its weights are given, and no type."""

EXPONENT_OF_ONE: Final = 8.0
"""Power of the probability of being feasible where there is one objective.

Close to its optimum there is next to nothing to be gained where it is feasible, and much where it hardly can be.
"""

EXPONENT_OF_SEVERAL: Final = 3.0
"""The same with several objectives: larger powers miss feasible regions, and the ends of fronts along a boundary."""

BEGINNING: Final[Mapping[str, str]] = {"local_search": "random_points", "evolutionary": "population_size"}
"""Optimizers that begin with a number of points of their own, and the option that says how many."""


def fill(schema: Schema, value: Any) -> Any:
    """Return a valid value with the schema's defaults for all keys it leaves out, in the schema's order."""
    if isinstance(value, Mapping):
        known = properties_of(schema, value)
        present = {
            key: value.get(key, sub.get("default")) for key, sub in known.items() if key in value or "default" in sub
        }
        present |= {key: child for key, child in value.items() if key not in known}
        return {key: fill(child_schema(schema, value, key), child) for key, child in present.items()}
    if isinstance(value, list):
        return [fill(items_schema(schema), item) for item in value]
    if "integer" in schema.get("type", ()) and isinstance(value, float):
        return int(value)
    return value


def fill_implied(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a document with what the user's own keys imply, before the schema's defaults are filled in.

    Who says how several objectives are scalarized wants them scalarized: the default acquisition function would not.
    """
    acquisition = document.get("acquisition")
    if not isinstance(acquisition, Mapping) or acquisition.get("type"):
        return dict(document)
    if not (acquisition.get("scalarization") or acquisition.get("weights")):
        return dict(document)
    return {**document, "acquisition": {**acquisition, "type": SCALARIZING}}


def fill_derived(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a filled document with the defaults that follow from other keys; drops what only loading needs."""
    derived = {key: value for key, value in document.items() if key not in ("preset", "extends", "versions")}
    design = dict(derived["design_of_experiment"])
    if design["type"] == "auto":
        design["type"] = "prior_sampling" if has_priors(document) else "sobol"
        if design["type"] == "sobol":
            del design["uniform_share"]
    if design["number_of_samples"] is None:
        design["number_of_samples"] = default_samples(document)
    derived["design_of_experiment"] = design
    acquisition = derived["acquisition"]
    weighting = acquisition["feasibility_weighting"]
    if "exponent" in weighting and weighting["exponent"] is None:
        exponent = EXPONENT_OF_ONE if len(document["objectives"]) == 1 else EXPONENT_OF_SEVERAL
        derived["acquisition"] = {**acquisition, "feasibility_weighting": {**weighting, "exponent": exponent}}
    surrogate = derived["surrogate"]
    if "doubt_noise" in surrogate and surrogate["doubt_noise"] is None:
        derived["surrogate"] = {**surrogate, "doubt_noise": len(document["objectives"]) == 1}
    directory = document["output"]["directory"] or f"outputs/{document['application_name']}"
    derived["output"] = {**document["output"], "directory": directory}
    return derived


def default_samples(document: Mapping[str, Any]) -> int:
    """Return the size of the design for want of one the user gave.

    It is what the optimizer begins with, if it says so, and the whole of a grid whose levels are given. The budget has
    no part in it, so that a run goes on with another budget as if it had had it from the start; a smaller budget ends
    the run within the design.
    """
    parameters = document["input_parameters"].values()
    if levels := document["design_of_experiment"].get("levels"):
        has_default = any(entry["parameter_default"] is not None for entry in parameters)
        return math.prod(_n_grid_levels(entry, levels) for entry in parameters) + has_default
    if begins_with := BEGINNING.get(document["optimizer"]["type"]):
        return int(document["optimizer"][begins_with])
    return max(SAMPLES_PER_PARAMETER * len(parameters), MIN_SAMPLES)


def _n_grid_levels(parameter: Mapping[str, Any], levels: int) -> int:
    """Return how many levels a parameter has in a grid that gives real ones so many."""
    if parameter["parameter_type"] == "real":
        return levels
    if parameter["parameter_type"] == "integer":
        return int(parameter["values"][1]) - int(parameter["values"][0]) + 1
    if parameter["parameter_type"] == "permutation":
        return math.factorial(int(parameter["values"][0]))
    return len(parameter["values"])


def has_priors(document: Mapping[str, Any]) -> bool:
    """Tell whether a document says anything about where the optimum lies."""
    own = (has_belief(parameter) for parameter in document["input_parameters"].values())
    return bool(document.get("priors")) or any(own) or any(map(has_own_belief, document["objectives"]))


def has_own_belief(objective: Mapping[str, Any]) -> bool:
    """Tell whether an objective has priors of its own that say anything."""
    return any(has_belief({"prior": prior}) for prior in (objective.get("priors") or {}).values())


def has_belief(parameter: Mapping[str, Any]) -> bool:
    """Tell whether a parameter has a prior that says anything; a uniform one does so only with a range."""
    prior: Mapping[str, Any] | None = parameter.get("prior")
    return prior is not None and is_belief(prior["type"], prior)


def is_belief(kind: str, options: Mapping[str, Any]) -> bool:
    """Tell whether a prior of this type, with these options, says anything."""
    return kind != "uniform" or not (options.get("low") is None and options.get("high") is None)
