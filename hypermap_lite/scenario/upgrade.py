"""A HyperMapper scenario written anew in our form, with no more in it than differs from our defaults."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hypermap_lite.scenario.defaults import fill
from hypermap_lite.scenario.hypermapper import Note
from hypermap_lite.scenario.loader import complete_document, read_scenario
from hypermap_lite.scenario.schemas import Schema, child_schema, properties_of, root_schema

WIDTH: Final = 100
"""Longest line that holds a whole object or list."""


@dataclass(frozen=True, slots=True)
class Upgrade:
    """A scenario in our form."""

    text: str
    """JSON; that of the file itself where nothing had to be translated."""

    notes: tuple[Note, ...]
    """What means something else now, or nothing."""

    is_needed: bool
    """Whether the file, or one it extends, was in HyperMapper's form."""


def upgrade(source: Path, *, overrides: Sequence[str] = (), prior_from: str | None = None) -> Upgrade:
    """Return the scenario of a file in our form; what it extends and the overrides are part of it.

    Raises
    ------
    ScenarioError
        If it cannot be loaded.
    """
    read = read_scenario(source, overrides=overrides, prior_from=prior_from)
    if not any(layer.places for layer in read.layers):
        return Upgrade(source.read_text(encoding="utf-8-sig"), (), is_needed=False)
    return Upgrade(pretty(minimal(read.document)) + "\n", read.hypermappers_notes, is_needed=True)


def minimal(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a merged document without what the defaults say anyway."""
    shorter: dict[str, Any] = _without_defaults(root_schema(), document)
    # a preset, say, may stand behind a default
    return shorter if complete_document(shorter) == complete_document(document) else dict(document)


def _without_defaults(schema: Schema, value: Any) -> Any:
    if not isinstance(value, Mapping):
        return value
    known = properties_of(schema, value)
    shorter = {}
    for key in [*(name for name in known if name in value), *(name for name in value if name not in known)]:
        child = child_schema(schema, value, key)
        inner = _without_defaults(child, value[key])
        if "default" not in child or fill(child, inner) != fill(child, child["default"]):
            shorter[key] = inner
    return shorter


def pretty(value: Any, indent: int = 0) -> str:
    """Return a value as JSON, with objects and lists on one line where they fit; the outermost one is broken up."""
    line = json.dumps(value, ensure_ascii=False)
    if not value or not isinstance(value, dict | list) or (indent and len(line) + indent <= WIDTH):
        return line
    inner = indent + 2
    if isinstance(value, dict):
        parts = [f"{json.dumps(key, ensure_ascii=False)}: {pretty(item, inner)}" for key, item in value.items()]
        opening, closing = "{", "}"
    else:
        parts = [pretty(item, inner) for item in value]
        opening, closing = "[", "]"
    body = ",\n".join(" " * inner + part for part in parts)
    return f"{opening}\n{body}\n{' ' * indent}{closing}"
