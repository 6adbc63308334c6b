"""Putting one scenario together: a file over those it extends, ``--set`` over the file.

Objects are merged key by key, lists are replaced, null takes a key back to its default. If a section changes its kind
(a ``random_forest`` over a ``gaussian_process``), it keeps only the keys that all kinds share.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.scenario.reading import parse_value, read_json
from hypermap_lite.scenario.schemas import (
    Schema,
    allows_bare_string,
    child_schema,
    has_entries,
    items_schema,
    kind_key,
    kind_of,
    root_schema,
)
from hypermap_lite.scenario.sources import Keys, Layer, path_of

MAX_INDEX_DIGITS = 9
"""A longer number in a path is no index into any list."""


def read_layers(file: Path, chain: tuple[Path, ...] = ()) -> list[Layer]:
    """Return a scenario file and all it extends, the most basic first.

    Raises
    ------
    ScenarioError
        If a file cannot be read, or extends itself in the end.
    """
    seen = [path.resolve() for path in chain]
    if file.resolve() in seen:
        loop = " -> ".join(path.name for path in (*chain[seen.index(file.resolve()) :], file))
        raise ScenarioError("$.extends", f"the files extend each other: {loop}", file=str(chain[-1]), hint="Cut one.")
    document = read_json(file)
    layers: list[Layer] = []
    for name in bases_of(document, str(file)):
        base = file.parent / name
        if not base.exists():
            hint = nearest(base.name, [other.name for other in base.parent.glob("*.json")])
            allowed = "a path relative to the folder of this file"
            raise ScenarioError("$.extends", f'there is no file "{name}"', allowed=allowed, hint=hint, file=str(file))
        layers += read_layers(base, (*chain, file))
    return [*layers, Layer(str(file), document, file.parent)]


def merge_layers(layers: Sequence[Layer]) -> dict[str, Any]:
    """Return the layers, the most basic first, as one document without ``extends``."""
    document: dict[str, Any] = {}
    for layer in layers:
        try:
            document = merge(root_schema(), document, layer.document)
        except ScenarioError as error:
            raise error.within(layer.name) from None
    document.pop("extends", None)
    return document


def merge(schema: Schema, base: Any, over: Any) -> Any:
    """Return `over` laid over `base`, both values of one schema; bare strings become objects on the way.

    Raises
    ------
    ScenarioError
        If null stands for an entry of the user's own naming, such as a parameter, that `base` does not have.
    """
    if isinstance(over, str) and allows_bare_string(schema):
        over = {kind_key(schema): over}
    if isinstance(over, list):
        return [_merge_at(f"$[{i}]", items_schema(schema), None, item) for i, item in enumerate(over)]
    if not isinstance(over, Mapping):
        return over
    merged = _shared(schema, base, over) if isinstance(base, Mapping) else {}
    for key, value in over.items():
        if value is not None:
            child = child_schema(schema, {**merged, **over}, key)
            merged[key] = _merge_at(f"$.{key}", child, merged.get(key), value)
        elif key in merged or not has_entries(schema):
            merged.pop(key, None)
        else:
            problem, allowed = "null removes an entry of a file this one extends; there is none", "an entry's content"
            raise ScenarioError(f"$.{key}", problem, allowed=allowed, hint=nearest(key, merged) or "Drop it.")
    return merged


def _merge_at(path: str, schema: Schema, base: Any, over: Any) -> Any:
    try:
        return merge(schema, base, over)
    except ScenarioError as error:
        raise error.below(path) from None


def apply_override(document: Mapping[str, Any], override: str) -> tuple[dict[str, Any], Layer]:
    """Return the document with one ``key.path=value`` set, and the override as a layer for messages.

    Raises
    ------
    ScenarioError
        If the override has no ``=``, speaks of a list item that is not there, or sets no legal JSON.
    """
    name = f"--set {override}"
    path, equals, text = override.partition("=")
    keys: Keys = tuple(int(key) if _is_index(key) else key for key in path.strip().split("."))
    if not equals or not all(str(key) for key in keys):
        raise ScenarioError(name, "this sets nothing", allowed="key.path=value, such as budget.evaluations=30")
    if keys[0] == "extends":
        raise ScenarioError(name, "only a file can extend another", hint="Write it into a file.")
    value = _value_of(text, name, keys)
    trace: Any = value
    for key in reversed(keys):
        trace = {key: trace}
    try:
        changed: dict[str, Any] = _assign(root_schema(), document, keys, value, name)
    except ScenarioError as error:
        raise error.within(name) from None
    return changed, Layer(name, trace)


def _assign(schema: Schema, current: Any, keys: Keys, value: Any, name: str, done: Keys = ()) -> Any:
    if not keys:
        return _merge_at(path_of(done), schema, current, value)
    key, rest = keys[0], keys[1:]
    if isinstance(current, list):
        if not isinstance(key, int) or key >= len(current):
            allowed = f"0 to {len(current) - 1}" if current else ""
            raise ScenarioError(path_of(done), f"the list has no item '{key}'", allowed=allowed, file=name)
        item = _assign(items_schema(schema), current[key], rest, value, name, (*done, key))
        return [*current[:key], item, *current[key + 1 :]]
    section = dict(current) if isinstance(current, Mapping) else {}
    if not rest or (value is None and str(key) not in section):
        return _merge_at(path_of(done), schema, section, {str(key): value})
    child = child_schema(schema, section, str(key))
    section[str(key)] = _assign(child, section.get(str(key)), rest, value, name, (*done, key))
    return section


def _shared(schema: Schema, base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Return what `base` hands on: all of it, or the keys shared by all kinds if the kind changes."""
    key = kind_key(schema)
    if key is None or over.get(key) in (None, kind_of(schema, base)):
        return dict(base)
    return {name: value for name, value in base.items() if name in schema["properties"] and name != key}


def bases_of(document: Mapping[str, Any], name: str) -> list[str]:
    """Return the files that a document extends, as written; `name` is what messages call it."""
    extends = document.get("extends") or []
    bases = [extends] if isinstance(extends, str) else extends
    if not isinstance(bases, list) or not all(isinstance(base, str) for base in bases):
        problem = f"{json.dumps(extends)[:60]} names no file"
        raise ScenarioError("$.extends", problem, allowed="a file name or a list of file names", file=name)
    return bases


def _is_index(key: str) -> bool:
    return key.isascii() and key.isdigit() and len(key) < MAX_INDEX_DIGITS


def _value_of(text: str, name: str, keys: Keys) -> Any:
    try:
        return parse_value(text, name, keys)
    except json.JSONDecodeError:
        return text
