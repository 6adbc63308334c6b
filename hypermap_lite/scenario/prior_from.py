"""A run, or any CSV file, in place of a scenario's priors."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hypermap_lite.scenario.merging import merge
from hypermap_lite.scenario.schemas import root_schema
from hypermap_lite.scenario.sources import Layer


def replace_priors(document: Mapping[str, Any], file: str) -> tuple[dict[str, Any], Layer, list[str]]:
    """Return a merged document with all priors replaced by the density of a file's good rows.

    The design is drawn from that density. The file is relative to the working directory.

    Returns
    -------
    tuple
        The document, the change as a layer for messages and paths, and notes on what was dropped.
    """
    given = document.get("input_parameters")
    parameters = given if isinstance(given, Mapping) else {}
    own = [name for name, entry in parameters.items() if isinstance(entry, Mapping) and entry.get("prior") is not None]
    added = {"priors": [{"type": "kde", "file": file}], "design_of_experiment": {"type": "prior_sampling"}}
    removed = {"input_parameters": {name: {"prior": None} for name in own}} if own else {}
    name = f"--prior-from {file}"
    dropped = [f"the prior{'s' * (len(own) != 1)} of {', '.join(own)}"] if own else []
    joint = document.get("priors")
    if joint and isinstance(joint, list):
        dropped.append(f"the joint prior{'s' * (len(joint) != 1)}")
    if isinstance(document.get("objectives"), list) and _without_own(document)["objectives"] != document["objectives"]:
        dropped.append("the priors of the objectives")
    notes = [f"{name} takes the place of {' and '.join(dropped)}"] if dropped else []
    merged = merge(root_schema(), document, {**added, **removed})
    return {**merged, **_without_own(document)}, Layer(name, added, Path.cwd()), notes


def _without_own(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return the objectives without priors of their own, if there are any objectives."""
    objectives = document.get("objectives")
    if not isinstance(objectives, list):
        return {}
    return {
        "objectives": [
            {key: value for key, value in entry.items() if key != "priors"} if isinstance(entry, Mapping) else entry
            for entry in objectives
        ]
    }
