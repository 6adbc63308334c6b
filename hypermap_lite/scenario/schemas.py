"""The JSON Schemas of the scenario file, and what the loader asks of them.

The schemas keep to a few forms, so that reading them takes a page: a section is an object with ``properties``;
variants stand in ``allOf`` as ``if``/``then`` on one key, the *kind* (``type``, ``method``, ``parameter_type``); a
section that is chosen by name alone may be a bare string, short for the object with that kind.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator

Schema: TypeAlias = Mapping[str, Any]

ROOT = "scenario.schema.json"
STUDY = "study.schema.json"
KIND_KEYS = ("type", "method", "parameter_type")


@cache
def load_schemas() -> Mapping[str, Schema]:
    """Return all schemas, keyed by file name."""
    files = [f for f in resources.files("scenario_schemas").iterdir() if f.name.endswith(".schema.json")]
    return {f.name: json.loads(f.read_text(encoding="utf-8")) for f in sorted(files, key=lambda f: f.name)}


def root_schema() -> Schema:
    """Return the schema of the whole scenario."""
    return load_schemas()[ROOT]


def study_schema() -> Schema:
    """Return the schema of a study's file."""
    return load_schemas()[STUDY]


@cache
def validator(file: str = ROOT) -> Draft202012Validator:
    """Return a validator of whole scenarios, or of the documents of another schema, that needs no network."""
    from jsonschema import Draft202012Validator
    from referencing import Registry, Resource

    contents = [Resource.from_contents(schema) for schema in load_schemas().values()]
    registry: Registry[Any] = Registry().with_resources([(str(c.id()), c) for c in contents])
    return Draft202012Validator(load_schemas()[file], registry=registry)


def resolve(schema: Schema) -> Schema:
    """Follow a reference to another file, if the schema is one."""
    return load_schemas()[schema["$ref"]] if "$ref" in schema else schema


def kind_key(schema: Schema) -> str | None:
    """Return the key that chooses the variant of a section, or None if it has no variants."""
    properties = schema.get("properties", {})
    return next((key for key in KIND_KEYS if "enum" in properties.get(key, {})), None)


def kind_of(schema: Schema, value: Mapping[str, Any]) -> Any:
    """Return the variant a section has chosen, by default if need be."""
    key = kind_key(schema)
    return None if key is None else value.get(key, schema["properties"][key].get("default"))


def properties_of(schema: Schema, value: Mapping[str, Any]) -> dict[str, Schema]:
    """Return the keys a section may have given its variant, with their schemas resolved."""
    known = dict(schema.get("properties", {}))
    for branch in schema.get("allOf", ()):
        if _applies(branch["if"], value):
            known |= branch["then"].get("properties", {})
    return {key: resolve(sub) for key, sub in known.items()}


def child_schema(schema: Schema, value: Mapping[str, Any], key: str) -> Schema:
    """Return the schema of one key of a section; an empty one, which allows anything, if the key is unknown."""
    known = properties_of(schema, value)
    extra = schema.get("additionalProperties")
    return known.get(key) or (resolve(extra) if isinstance(extra, Mapping) else {})


def items_schema(schema: Schema) -> Schema:
    """Return the schema of a list's items."""
    return resolve(schema.get("items", {}))


def allows_any_key(schema: Schema) -> bool:
    """Tell whether an object of this schema has keys of the user's choice, such as parameter names."""
    return "properties" not in schema


def has_entries(schema: Schema) -> bool:
    """Tell whether an object of this schema holds entries that the user names, all of one schema."""
    return isinstance(schema.get("additionalProperties"), Mapping)


def all_properties(schema: Schema) -> dict[str, Schema]:
    """Return the keys a section may have in any of its variants."""
    known = dict(schema.get("properties", {}))
    for branch in schema.get("allOf", ()):
        known |= branch["then"].get("properties", {})
    return {key: resolve(sub) for key, sub in known.items()}


def allows_bare_string(schema: Schema) -> bool:
    """Tell whether a bare string is short for an object of this kind."""
    return kind_key(schema) is not None and {"object", "string"} <= set(schema.get("type", ()))


def _applies(condition: Schema, value: Mapping[str, Any]) -> bool:
    for key, test in condition["properties"].items():
        if key not in value:
            return key not in condition.get("required", ())
        if value[key] not in test.get("enum", [test.get("const")]):
            return False
    return True
