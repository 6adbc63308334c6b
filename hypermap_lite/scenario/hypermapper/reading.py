"""Reading a HyperMapper document: its values by dotted key, checked, with HyperMapper's defaults."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.scenario.hypermapper.fork_keys import (
    KEYS,
    PARAMETER_KEYS,
    VERSION_3_CHOICES,
    VERSION_3_DEFAULTS,
)
from hypermap_lite.scenario.hypermapper.keys import NESTED, Key
from hypermap_lite.scenario.messages import show, translate
from hypermap_lite.scenario.schemas import Schema, root_schema, validator

SLIP: Final = 0.85
"""Names at least this similar are taken for a slip of the pen."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A HyperMapper document whose values have been checked one by one."""

    given: Mapping[str, Any]
    """Values that the document has, by dotted key; those of parameters aside."""

    parameters: Mapping[str, Mapping[str, Any]]
    """Entries of ``input_parameters``."""

    own: Mapping[str, Any]
    """Sections in our own form that stand in the document too."""

    unknown: tuple[str, ...]
    """Keys that nobody knows."""

    is_version_3: bool
    """Whether it was written for the branch of version 3."""

    directory: Path
    """Folder of the file."""

    def __getitem__(self, name: str) -> Any:
        """Return the value of a key, by default if need be."""
        if name in self.given:
            return self.given[name]
        if self.is_version_3 and name in VERSION_3_DEFAULTS:
            return VERSION_3_DEFAULTS[name]
        return KEYS[name].default

    def has(self, name: str) -> bool:
        """Tell whether the document has a key, or an object of this name."""
        return name in self.given or any(key.startswith(f"{name}.") for key in self.given)


def is_hypermapper(document: Mapping[str, Any]) -> bool:
    """Tell whether a document is one of HyperMapper's."""
    return "optimization_objectives" in document and "objectives" not in document


def read(document: Mapping[str, Any], directory: Path) -> Reading:
    """Read a HyperMapper document.

    Raises
    ------
    ScenarioError
        If a value is not allowed, or a key is probably misspelt.
    """
    if document.get("extends") is not None:
        hint = "Write a file of our own form that extends this one."
        raise ScenarioError("$.extends", "a HyperMapper file extends no other", hint=hint)
    values = {name: value for name, value in _flat(document) if value is not None}
    own_keys = [name for name in values if name not in KEYS and name in root_schema()["properties"]]
    unknown = tuple(name for name in values if name not in KEYS and name not in own_keys)
    for name in unknown:
        _refuse_slip(f"$.{name}", name, KEYS, values[name])
    given = {name: value for name, value in values.items() if name in KEYS}
    for name, value in given.items():
        check_value(f"$.{name}", _schema(KEYS[name]), value)
    parameters = {name: _entry(name, entry) for name, entry in given.pop("input_parameters", {}).items()}
    return Reading(
        given=given,
        parameters=parameters,
        own={name: values[name] for name in own_keys},
        unknown=unknown,
        is_version_3=_is_version_3(given, parameters),
        directory=directory,
    )


def check_value(path: str, schema: Schema, value: Any) -> None:
    """Raise a `ScenarioError` at `path` unless the value is one that the schema allows."""
    for violation in validator().evolve(schema=schema).iter_errors(value):
        raise translate(violation).below(path)


def _flat(document: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the values by dotted key, in the document's order."""
    for name, value in document.items():
        if name not in NESTED:
            yield name, value
        elif value is not None:
            check_value(f"$.{name}", {"type": "object"}, value)
            yield from ((f"{name}.{key}", inner) for key, inner in value.items())


def _schema(key: Key, name: str = "") -> Schema:
    more = VERSION_3_CHOICES.get(name or key.name, ())
    return {**key.schema, "enum": [*key.schema["enum"], *more]} if more else key.schema


def _entry(name: str, entry: Any) -> dict[str, Any]:
    """Check one entry of ``input_parameters``."""
    if not re.fullmatch(r"[0-9A-Za-z_-]+", name):
        problem, allowed = f"the name {show(name)} is not of the right form", "letters, digits, _ and -"
        raise ScenarioError("$.input_parameters", problem, allowed=allowed)
    path = f"$.input_parameters.{name}"
    check_value(path, {"type": "object"}, entry)
    kept = {key: value for key, value in entry.items() if value is not None}
    for key, value in kept.items():
        if key in PARAMETER_KEYS:
            check_value(f"{path}.{key}", PARAMETER_KEYS[key].schema, value)
        else:
            _refuse_slip(f"{path}.{key}", key, PARAMETER_KEYS, value)
    for key in ("parameter_type", "values"):
        if key not in kept:
            raise ScenarioError(path, f"the key '{key}' is missing", hint=f"Add '{key}'.")
    return kept


def _refuse_slip(path: str, name: str, known: Mapping[str, Key], value: Any) -> None:
    """Raise a `ScenarioError` if an unknown key is probably a known one, misspelt; others are only noted."""
    if difflib.get_close_matches(name, known, n=1, cutoff=SLIP):
        raise ScenarioError(path, f"unknown key, given {show(value)}", hint=nearest(name, known))


def _is_version_3(given: Mapping[str, Any], parameters: Mapping[str, Mapping[str, Any]]) -> bool:
    """Tell whether a key, or a value, is one that only version 3 has."""
    in_parameters = any(
        PARAMETER_KEYS[key].is_version_3 for p in parameters.values() for key in p if key in PARAMETER_KEYS
    )
    has_permutation = any(p["parameter_type"] == "permutation" for p in parameters.values())
    has_value = any(given.get(name) in more for name, more in VERSION_3_CHOICES.items())
    return in_parameters or has_permutation or has_value or any(KEYS[name].is_version_3 for name in given)
