"""Small scenarios in HyperMapper's form, and what translating them gives."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.scenario.hypermapper import Translation, translate
from hypermap_lite.scenario.schemas import all_properties, load_schemas

REAL = {"parameter_type": "real", "values": [-5, 10]}
INTEGER = {"parameter_type": "integer", "values": [0, 15]}
ORDINAL = {"parameter_type": "ordinal", "values": [1, 2, 4, 8]}
CATEGORICAL = {"parameter_type": "categorical", "values": ["red", "green", "blue"]}

GOOD: Mapping[str, Any] = {
    "application_name": "demo",
    "optimization_objectives": ["cost"],
    "input_parameters": {"x1": REAL, "x2": {"parameter_type": "real", "values": [0, 15]}},
}
"""The least that HyperMapper runs."""

MISSING = object()
"""Stands for the absence of a key."""


def scenario(**changes: Any) -> dict[str, Any]:
    """Return the good scenario with some keys set; a double underscore leads into a nested object."""
    document = copy.deepcopy(dict(GOOD))
    for name, value in changes.items():
        outer, _, inner = name.partition("__")
        if inner:
            document.setdefault(outer, {})[inner] = value
        else:
            document[outer] = value
    return document


def of_dotted(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the good scenario with some dotted keys set."""
    return scenario(**{name.replace(".", "__"): value for name, value in changes.items()})


def translated(**changes: Any) -> dict[str, Any]:
    """Return the good scenario, with some keys set, in our form."""
    return dict(translate(scenario(**changes)).document)


def parameter(entry: Mapping[str, Any], **changes: Any) -> dict[str, Any]:
    """Return an entry of ``input_parameters``, with some keys set, in our form."""
    return dict(translated(input_parameters={"p": {**entry, **changes}})["input_parameters"]["p"])


def note_on(translation: Translation, key: str) -> str:
    """Return what is said of a key; nothing if nothing is."""
    return next((note.text for note in translation.notes if note.key == key), "")


def at(document: Any, path: str) -> Any:
    """Return the value at a dotted path, or `MISSING`."""
    for key in path.split("."):
        if not isinstance(document, Mapping) or key not in document:
            return MISSING
        document = document[key]
    return document


def write_rows(folder: Path, name: str, n: int) -> None:
    """Write n evaluations of the good scenario as HyperMapper does."""
    rows = [f"{0.1 * i!r},{0.2 * i!r},{i}.0,{10 * i}" for i in range(n)]
    (folder / name).write_text("\r\n".join(["x1,x2,cost,Timestamp", *rows, ""]))


def needs(section: str, *keys: str, kind: str = "") -> pytest.MarkDecorator:
    """Skip a test as long as our schemas lack some keys of a section, or one of its kinds."""
    schema = load_schemas()[f"{section}.schema.json"]
    kinds = [name for sub in schema["properties"].values() for name in sub.get("enum", ())]
    missing = [key for key in keys if key not in all_properties(schema)] + [kind] * bool(kind and kind not in kinds)
    return pytest.mark.skipif(bool(missing), reason=f"our {section} has no {', '.join(missing)} yet")


HAS_FILES = needs("output", "samples_file", "pareto_file")
"""Every translated scenario names HyperMapper's CSVs."""
