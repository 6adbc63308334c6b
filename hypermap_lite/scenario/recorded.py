"""The scenarios of run folders that an older version wrote."""

from __future__ import annotations

import copy
import json
from collections.abc import Mapping
from typing import Any

from hypermap_lite.history.added_later import ADDED_LATER
from hypermap_lite.scenario.schemas import child_schema, properties_of, root_schema


def with_old_defaults(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return the scenario of a run folder with options it lacks as they were before there was a choice.

    Such a scenario says with its `versions` that it held every option of its time. So what it lacks came later, and
    its default today need not be what the run did. Any other document is returned as it is.
    """
    recorded = copy.deepcopy(dict(document))
    versions = recorded.get("versions")
    if isinstance(versions, Mapping) and any(versions.values()):
        for place, value in ADDED_LATER.items():
            _set_missing(recorded, place.removeprefix("$.").split("."), json.loads(value))
    return recorded


def _set_missing(document: dict[str, Any], path: list[str], value: Any) -> None:
    """Set a value where its section has such a key in its variant, and lacks it; a whole section may be missing."""
    schema, section = root_schema(), document
    for name in path[:-1]:
        inner = section.setdefault(name, {}) if name in properties_of(schema, section) else None
        if not isinstance(inner, dict):
            return
        schema, section = child_schema(schema, section, name), inner
    if path[-1] in properties_of(schema, section):
        section.setdefault(path[-1], value)
