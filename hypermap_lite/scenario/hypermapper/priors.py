"""HyperMapper's priors on single parameters, and its kernel density estimates."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.scenario.hypermapper.draft import Draft
from hypermap_lite.scenario.messages import show
from hypermap_lite.scenario.table import read_table

SHAPES: Final = ("gaussian", "exponential", "decay")
"""Names that stand for beta densities."""

PRIORS: Final = ("uniform", *SHAPES, "custom_gaussian", "estimate")

HALF_THE_RANGE: Final = -1
"""What stands for a standard deviation of half the parameter's range."""

SMALLEST_QUANTILE: Final = 1e-9
"""Stands for a quantile of zero: the best row."""

SUM_TOLERANCE: Final = 1e-9


def translate_prior(draft: Draft, name: str, entry: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return the prior of one parameter in our form; None if it has none, or one from a file.

    Raises
    ------
    ScenarioError
        If the parameter cannot have it.
    """
    path, kind = f"$.input_parameters.{name}.prior", entry["parameter_type"]
    prior = entry.get("prior", "uniform")
    if isinstance(prior, list):
        return _listed(draft, name, entry, prior)
    if prior not in PRIORS:
        raise ScenarioError(
            path, f"unknown prior {show(prior)}", allowed=", ".join(PRIORS), hint=nearest(str(prior), PRIORS)
        )
    if prior == "uniform" or (prior == "estimate" and kind != "permutation"):
        return None
    if kind == "permutation" or (kind == "categorical" and prior in SHAPES):
        allowed = "uniform" if kind == "permutation" else "uniform, or a list with a probability per category"
        raise ScenarioError(path, f"a {kind} parameter has no {prior} prior", allowed=allowed)
    if prior == "custom_gaussian":
        return _custom_gaussian(draft, name, entry)
    if prior == "gaussian" and "prior_parameters" in entry:
        return _normal(f"$.input_parameters.{name}.prior_parameters", entry["prior_parameters"])
    return {"type": "beta", "shape": prior}


def _listed(draft: Draft, name: str, entry: Mapping[str, Any], prior: Sequence[Any]) -> dict[str, Any] | None:
    """Translate a list: densities at equally spaced values of a real parameter, else a probability per level."""
    path, kind, values = f"$.input_parameters.{name}.prior", entry["parameter_type"], entry["values"]
    for number in prior:
        if isinstance(number, bool) or not isinstance(number, int | float) or number < 0:
            raise ScenarioError(path, f"the list has {show(number)} in it", allowed="numbers >= 0")
    if not sum(prior) > 0:
        raise ScenarioError(path, f"the numbers of {show(prior)} are all zero", allowed="at least one number > 0")
    if kind == "permutation":
        raise ScenarioError(path, "a permutation parameter has no list as prior", allowed="uniform")
    if kind == "real":
        return {"type": "piecewise", "knots": list(prior)} if len(prior) > 1 else None
    n_levels = len(values) if kind != "integer" else round(max(values) - min(values)) + 1
    if len(prior) != n_levels:
        problem = f"there are {len(prior)} numbers for the {n_levels} values of the parameter"
        raise ScenarioError(path, problem, allowed=f"{n_levels} numbers >= 0")
    if abs(sum(prior) - 1) > SUM_TOLERANCE:
        draft.note(f"input_parameters.{name}.prior", f"its numbers sum to {sum(prior):g}; they are scaled to sum to 1")
    return {"type": "weights", "weights": list(prior)}


def _normal(path: str, parameters: Sequence[float]) -> dict[str, Any]:
    if len(parameters) != 2 or not parameters[1] > 0:
        raise ScenarioError(path, f"the list is {show(parameters)}", allowed="[mean, std] with std > 0")
    return {"type": "gaussian", "mean": parameters[0], "std": parameters[1]}


def _custom_gaussian(draft: Draft, name: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    path, kind = f"$.input_parameters.{name}", entry["parameter_type"]
    if kind not in ("real", "integer"):
        allowed, hint = "real and integer parameters", "Give it a list with a number per level."
        raise ScenarioError(
            f"{path}.prior", f"a {kind} parameter has no custom_gaussian prior", allowed=allowed, hint=hint
        )
    means = _numbers(draft, name, entry, "custom_gaussian_prior_means")
    stds = _numbers(draft, name, entry, "custom_gaussian_prior_stds")
    if len(stds) == 1 and stds[0] == HALF_THE_RANGE:
        stds = stds * len(means)
    if len(means) != len(stds):
        problem = f"there are {len(means)} means and {len(stds)} standard deviations"
        raise ScenarioError(f"{path}.custom_gaussian_prior_stds", problem, allowed="as many of both")
    half = (max(entry["values"]) - min(entry["values"])) / 2
    stds = [half if std == HALF_THE_RANGE else std for std in stds]
    for std in stds:
        if not std > 0:
            allowed = "a number > 0, or -1 for half the range"
            raise ScenarioError(
                f"{path}.custom_gaussian_prior_stds", f"a standard deviation is {std:g}", allowed=allowed
            )
    draft.note(f"input_parameters.{name}.prior", "cut off at the bounds and normalized, which HyperMapper's was not")
    components = [{"mean": mean, "std": std} for mean, std in zip(means, stds, strict=True)]
    if len(components) == 1:
        return {"type": "gaussian", **components[0]}
    return {"type": "mixture", "components": components}


def _numbers(draft: Draft, name: str, entry: Mapping[str, Any], key: str) -> list[float]:
    """Return a parameter's own numbers, or its share of those for all."""
    own = entry.get(key)
    if isinstance(own, list):
        if not own or not all(isinstance(number, int | float) and not isinstance(number, bool) for number in own):
            path = f"$.input_parameters.{name}.{key}"
            raise ScenarioError(path, f"the list is {show(own)}", allowed="a list of numbers, not empty")
        return list(own)
    shared, names = draft.reading[key], list(draft.reading.parameters)
    if isinstance(entry.get("custom_gaussian_prior_means"), list):
        shared = [HALF_THE_RANGE]  # means of its own, and no widths: not those of another parameter
    if len(shared) not in (1, len(names)):
        problem = f"there are {len(shared)} numbers for {len(names)} parameters"
        raise ScenarioError(f"$.{key}", problem, allowed=f"1 or {len(names)} numbers")
    return [shared[0] if len(shared) == 1 else shared[names.index(name)]]


def translate_estimates(draft: Draft) -> None:
    """Translate the priors that are estimated from a file, one density for all."""
    reading, parameters = draft.reading, draft.reading.parameters
    reals = [name for name, entry in parameters.items() if entry["parameter_type"] == "real"]
    is_joint = reading["estimate_multivariate_priors"]
    names = reals if is_joint else [name for name, entry in parameters.items() if entry.get("prior") == "estimate"]
    if not names:
        keys = ("prior_estimation_file", "prior_estimation_quantile", "bandwidth_parameter", "bandwidth_n_factor")
        draft.unused(keys, "without a prior that is estimated")
        return
    if is_joint:
        for name in names:
            if draft.document["input_parameters"][name].pop("prior", None):
                draft.note(f"input_parameters.{name}.prior", "estimate_multivariate_priors takes its place")
    elif set(names) != set(reals):
        draft.note("prior_estimation_file", 'only parameters whose prior is "estimate" get a density from it')
    prior: dict[str, Any] = {
        "type": "kde",
        "file": draft.file(reading["prior_estimation_file"]),
        "rows": "best",
        "quantile": max(reading["prior_estimation_quantile"], SMALLEST_QUANTILE),
        "independent": not is_joint,
        "parameters": names,
    }
    factor = _bandwidth_factor(draft, len(names) if is_joint else 1)
    if factor is not None:
        prior["bandwidth_factor"] = factor
    draft.set("priors", [prior], "estimate_multivariate_priors" if is_joint else "prior_estimation_file")
    for ours, key in (("file", "prior_estimation_file"), ("quantile", "prior_estimation_quantile")):
        draft.places[f"$.priors[0].{ours}"] = f"$.{key}"


def _bandwidth_factor(draft: Draft, d: int) -> float | None:
    """Return the file's bandwidth relative to Scott's rule; None where the file says nothing of it.

    HyperMapper's is (n_factor n) ** (-1 / (d + parameter)) standard deviations, Scott's n ** (-1 / (d + 4)).
    """
    reading = draft.reading
    keys = ("bandwidth_n_factor", "bandwidth_parameter")
    if not any(reading.has(key) for key in keys):
        draft.note(
            "bandwidth_n_factor", "by default, kernels have the width of Scott's rule; HyperMapper's were spikes"
        )
        return None
    n = _number_of_good_rows(draft)
    if n is None:
        return None
    factor = float((reading[keys[0]] * n) ** (-1 / (d + reading[keys[1]])) * n ** (1 / (d + 4)))
    for key in keys:
        draft.note(key, f"the kernels have {factor:.3g} times the width of Scott's rule, at least 1 % of the range")
    return factor


def _number_of_good_rows(draft: Draft) -> int | None:
    """Return how many rows a density rests on; None if the file cannot be read, of which loading will say more."""
    name = draft.reading["prior_estimation_file"]
    path = draft.find(name)
    if path is None:
        return None
    try:
        n = len(read_table(path, name).records)
    except ScenarioError:
        return None
    return max(math.ceil(draft.reading["prior_estimation_quantile"] * n), 1)
