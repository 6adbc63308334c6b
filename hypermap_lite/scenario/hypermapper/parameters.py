"""HyperMapper's input parameters: types, levels, defaults, scales, and version 3's constraints."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, Final

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.hypermapper.draft import Draft, Note
from hypermap_lite.scenario.hypermapper.fork_keys import PARAMETER_KEYS
from hypermap_lite.scenario.hypermapper.priors import translate_prior
from hypermap_lite.scenario.messages import show

KERNELS: Final = ("spearman", "kendall", "hamming")
"""Kernels of permutations that we have."""


def translate_parameters(draft: Draft) -> None:
    """Translate ``input_parameters``, their constraints included."""
    if not draft.reading.parameters:
        allowed = "an object with at least one entry"
        raise ScenarioError("$", "the key 'input_parameters' is missing", allowed=allowed, hint="Add it.")
    constraints: dict[str, None] = {}
    for name, entry in draft.reading.parameters.items():
        draft.set(f"input_parameters.{name}", _entry(draft, name, entry), f"input_parameters.{name}")
        constraints |= dict.fromkeys(map(_with_words, entry.get("constraints", ())))
        _note_dead(draft, name, entry)
    if constraints:
        first = next(name for name, entry in draft.reading.parameters.items() if entry.get("constraints"))
        draft.set("constraints", list(constraints), f"input_parameters.{first}.constraints")


def _with_words(constraint: str) -> str:
    """Return an expression of NumExpr's with our words for its logical operators."""
    spelt = re.sub(r"\s*&\s*", " and ", re.sub(r"\s*\|\s*", " or ", constraint))
    return re.sub(r"~\s*", "not ", spelt)


def _entry(draft: Draft, name: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    kind, values = entry["parameter_type"], entry["values"]
    translated: dict[str, Any] = {"parameter_type": kind, "values": _values(draft, name, kind, values)}
    if kind == "permutation":
        translated |= _kernel(draft, name, entry)
    if entry.get("transform") == "log":
        if kind in ("real", "integer"):
            translated["scale"] = "log"
        else:
            draft.note(f"input_parameters.{name}.transform", f"it does nothing with the type {kind}")
    default = _default(draft, name, kind, translated["values"], entry.get("parameter_default"))
    if default is not None:
        translated["parameter_default"] = default
    prior = translate_prior(draft, name, entry)
    if prior is not None:
        translated["prior"] = prior
    if isinstance(entry.get("prior"), list) and kind == "ordinal":
        translated["values"] = sorted(values)
        if list(values) != translated["values"]:
            draft.note(
                f"input_parameters.{name}.prior", "its numbers are those of the levels in rising order, as before"
            )
    return translated


def _values(draft: Draft, name: str, kind: str, values: Sequence[Any]) -> list[Any]:
    path = f"$.input_parameters.{name}.values"
    if kind == "categorical":
        if not all(isinstance(value, str) for value in values):
            draft.note(f"input_parameters.{name}.values", "categories are texts here; numbers are written as such")
        return [value if isinstance(value, str) else show(value) for value in values]
    for value in values:
        if isinstance(value, str):
            raise ScenarioError(path, f"{show(value)} is a string", allowed=f"numbers, with the type {kind}")
    if kind in ("real", "integer") and len(values) != 2:
        problem = f"the list {show(values)} has {len(values)} item{'s' * (len(values) != 1)}"
        raise ScenarioError(path, problem, allowed=f"[low, high], with the type {kind}")
    return list(values)


def _default(draft: Draft, name: str, kind: str, values: Sequence[Any], default: Any) -> Any:
    """Return the default value; None if there is none, or none that can be kept."""
    key = f"input_parameters.{name}.parameter_default"
    if kind == "permutation":
        return _order(draft, key, default)
    if isinstance(default, list):
        if len(default) != 1:
            draft.note(key, "only the first of its values is evaluated")
        default = default[0] if default else None
    if default is None:
        return None
    if kind == "categorical":
        default = default if isinstance(default, str) else show(default)
    elif isinstance(default, str):
        raise ScenarioError(f"$.{key}", f"{show(default)} is a string", allowed="a number")
    if kind in ("real", "integer") and not min(values) <= default <= max(values):
        draft.note(key, f"{show(default)} lies outside the bounds {show(values)}, so it is not evaluated")
        return None
    if kind in ("ordinal", "categorical") and default not in values:
        levels = ", ".join(map(str, values))
        raise ScenarioError(f"$.{key}", f"{show(default)} is none of the levels", allowed=levels)
    return default


def _order(draft: Draft, key: str, default: Any) -> list[int] | None:
    """Return the default of a permutation, which is one list of its elements, or a list of such lists."""
    if isinstance(default, list) and default and isinstance(default[0], list):
        if len(default) > 1:
            draft.note(key, "only the first of its values is evaluated")
        default = default[0]
    if isinstance(default, str):
        default = [int(element) for element in re.findall(r"\d+", default)]
    return default if isinstance(default, list) else None


def _kernel(draft: Draft, name: str, entry: Mapping[str, Any]) -> dict[str, str]:
    kernel = entry.get("parametrization", PARAMETER_KEYS["parametrization"].default)
    if kernel in KERNELS:
        return {"kernel": kernel}
    draft.note(f"input_parameters.{name}.parametrization", f"there is no {kernel} kernel; here it is spearman")
    return {"kernel": "spearman"}


def _note_dead(draft: Draft, name: str, entry: Mapping[str, Any]) -> None:
    for key in entry:
        known = PARAMETER_KEYS.get(key)
        text = "unknown; it does nothing" if known is None else known.note
        if text:
            draft.notes.append(Note(f"input_parameters.{name}.{key}", text, is_dead=True))
