"""Where each part of a scenario was written: the files and overrides it was put together from."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.schemas import KIND_KEYS

Keys: TypeAlias = tuple[str | int, ...]
"""A place in a JSON document: object keys and list indices from the top."""


@dataclass(frozen=True, slots=True)
class Layer:
    """One file, or one option of the command line, of those that were merged."""

    name: str
    """What messages call it; empty for a scenario given as a Python mapping."""

    document: Mapping[Any, Any]
    """Its content as written."""

    directory: Path | None = None
    """Folder that paths in it are relative to: that of the file; None for a Python mapping and for ``--set``."""

    places: Mapping[str, str] = field(default_factory=dict)
    """Where the file itself says what stands at a place of `document`, for a file in HyperMapper's form."""


def layer_of(path: str, layers: Sequence[Layer]) -> Layer | None:
    """Return the layer that wrote the value at a path, or the nearest value above it; else the last file."""
    keys = keys_of(path)
    for depth in range(len(keys), 0, -1):
        for layer in reversed(layers):
            if _has(layer.document, keys[:depth]):
                return layer
    return next((layer for layer in reversed(layers) if not layer.name.startswith("--")), None)


def origin_of(path: str, layers: Sequence[Layer]) -> str:
    """Return the name of the layer that wrote the value at a path, or the nearest value above it."""
    layer = layer_of(path, layers)
    return "" if layer is None else layer.name


def located(error: ScenarioError, layers: Sequence[Layer]) -> ScenarioError:
    """Return an error with the name of the layer that wrote the value at its path, and the place as written there."""
    layer = layer_of(error.path, layers)
    if layer is None:
        return error
    keys = keys_of(error.path)
    for depth in range(len(keys), 0, -1):
        written = layer.places.get(path_of(keys[:depth]))
        if written is not None:
            if not error.path.startswith(written):
                problem = f"{error.problem} (here it is {error.path})"
                error = ScenarioError(written, problem, allowed=error.allowed, hint=error.hint, file=error.file)
            break
    return error.within(layer.name)


def folders_of(path: str, layers: Sequence[Layer], directory: Path) -> tuple[Path, ...]:
    """Return where files named at a path are looked for: beside the layer that says it, then in a directory."""
    layer = layer_of(path, layers)
    first = directory if layer is None or layer.directory is None else layer.directory
    return tuple(dict.fromkeys((first.resolve(), directory.resolve())))


def keys_of(path: str) -> Keys:
    """Return the keys of a path: ``$.objectives[0].goal`` is ``("objectives", 0, "goal")``."""
    return tuple(int(index) if index else key for key, index in re.findall(r"\.([^.\[]+)|\[(\d+)\]", path))


def path_of(keys: Sequence[str | int]) -> str:
    """Return the path of some keys, the inverse of `keys_of`."""
    return "$" + "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys)


def _has(document: Any, keys: Keys) -> bool:
    for key in keys:
        inside = (
            key in document
            if isinstance(document, Mapping)
            else isinstance(document, list) and key in range(len(document))
        )
        if not inside:
            return key in KIND_KEYS and isinstance(document, str)  # short for an object of that kind
        document = document[key]
    return True
