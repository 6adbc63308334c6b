"""How priors enter HyperMapper's acquisition: piBO or BOPrO."""

from __future__ import annotations

from typing import Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.defaults import has_priors
from hypermap_lite.scenario.hypermapper.draft import Draft
from hypermap_lite.scenario.messages import show

LARGEST_FLOOR: Final = 0.5
"""Floors from here on are taken relative to themselves, since ours are below one."""


def translate_weighting(draft: Draft) -> None:
    """Translate how priors enter the acquisition."""
    reading, path = draft.reading, "acquisition.prior_weighting"
    of_bopro = ("model_posterior_weight", "model_good_quantile", "posterior_computation_lower_limit")
    of_pibo = ("prior_beta", "prior_floor", "model_weight")
    if not has_priors(draft.document):
        draft.unused(("prior_method", *of_bopro, *of_pibo), "without priors")
        return
    method = reading["prior_method"].lower()
    if reading.is_version_3 and reading["acquisition_function"] != "EI_PIBO":
        draft.set(f"{path}.method", "none", "acquisition_function")
        draft.unused(("prior_method", *of_bopro, *of_pibo), "without EI_PIBO")
    elif method == "pibo":
        draft.set(f"{path}.method", "pibo", "prior_method")
        draft.set(f"{path}.beta", _beta(draft), "prior_beta")
        draft.set(f"{path}.floor", _floor(draft), "prior_floor")
        draft.set(f"{path}.unbounded", True, "prior_method")
        draft.unused(of_bopro, "with pibo")
    elif method == "bopro":
        draft.set(f"{path}.method", "bopro", "prior_method")
        for key, ours in zip(of_bopro, ("model_weight", "good_quantile", "floor"), strict=True):
            draft.set(f"{path}.{ours}", reading[key], key)
        draft.unused(of_pibo, "with bopro")
    else:
        problem = f"there is no method {show(reading['prior_method'])}"
        raise ScenarioError("$.prior_method", problem, allowed="pibo, bopro")
    if draft.document["acquisition"]["prior_weighting"]["method"] != "none":
        draft.set(f"{path}.prior_free", 0.0, "prior_method")
        draft.set(f"{path}.safeguard", False, "prior_method")
        draft.set(f"{path}.make_up", False, "prior_method")


def _beta(draft: Draft) -> float:
    """Return the strength of piBO for an exponent of beta / n at the n-th suggestion, batches not counted."""
    reading = draft.reading
    size = draft.document["budget"].get("batch_size", 1)
    if reading.is_version_3:
        return float(reading["model_weight"] * size)
    beta = reading["prior_beta"]
    if beta < 0 and beta != -1:
        raise ScenarioError(
            "$.prior_beta", f"it is {beta:g}", allowed="a number >= 0, or -1 for a tenth of the iterations"
        )
    if size > 1:
        draft.note("prior_beta", f"times {size} here, since each suggestion of a batch counts for the decay")
    return float((reading["optimization_iterations"] / 10 if beta == -1 else beta) * size)


def _floor(draft: Draft) -> float:
    """Return the least density, relative to the largest."""
    floor: float = draft.reading["prior_floor"]
    draft.note(
        "prior_floor", "relative to the priors' largest density; HyperMapper's was added to the density as it is"
    )
    return floor if floor < LARGEST_FLOOR else floor / (1 + floor)
