"""Turning violations of the schemas into messages for people."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.scenario.schemas import (
    KIND_KEYS,
    ROOT,
    STUDY,
    Schema,
    all_properties,
    allows_any_key,
    child_schema,
    items_schema,
    kind_key,
    kind_of,
    load_schemas,
    properties_of,
    resolve,
    root_schema,
    validator,
)
from hypermap_lite.scenario.sources import Keys, path_of

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError

SHOWN_LENGTH = 60
"""Characters of a value that a message shows."""

NAMES = {
    "object": "an object",
    "array": "a list",
    "string": "a string",
    "number": "a number",
    "integer": "an integer",
    "boolean": "true or false",
    "null": "null",
}


def check_document(document: Mapping[str, Any], schema: str = ROOT) -> None:
    """Raise a `ScenarioError` at the most telling violation of the schemas, those of a scenario unless told otherwise.

    An unknown kind comes first, since a section's other keys follow from it; then unknown keys, since one of them often
    explains a missing one; then the rest in the order of the file.
    """
    _check_kind(document, schema)
    violations = [
        v
        for v in validator(schema).iter_errors(document)
        if v.validator not in ("additionalProperties", "unevaluatedProperties")
    ]
    for violation in violations:
        if violation.validator == "enum" and violation.absolute_path[-1] in KIND_KEYS:
            raise translate(violation)
    for unknown in unknown_keys(load_schemas()[schema], document):
        raise unknown
    if violations:
        raise translate(min(violations, key=lambda v: v.validator == "required"))


def _check_kind(document: Mapping[str, Any], schema: str) -> None:
    """Raise a `ScenarioError` if a study is taken for a scenario, or the other way round."""
    is_study = "variants" in document and "input_parameters" not in document
    if schema == ROOT and is_study:
        hint = "Run it by: python -m hypermap_lite study FILE"
        raise ScenarioError("$", "this is a study, not a scenario", allowed="a scenario", hint=hint)
    if schema == STUDY and "variants" not in document and {"input_parameters", "extends"} & set(document):
        hint = "Run it by: python -m hypermap_lite FILE, or name it in a study's variants."
        raise ScenarioError("$", "this is a scenario, not a study", allowed="a study", hint=hint)


def unknown_keys(schema: Schema, value: Any, keys: Keys = ()) -> Iterator[ScenarioError]:
    """Yield an error for each key that the schema does not know."""
    if isinstance(value, list):
        for i, item in enumerate(value):
            yield from unknown_keys(items_schema(schema), item, (*keys, i))
    if not isinstance(value, Mapping):
        return
    is_open = kind_key(schema) is not None and kind_of(schema, value) is None
    known = all_properties(schema) if is_open else properties_of(schema, value)
    for key, child in value.items():
        if key not in known and not allows_any_key(schema):
            hint = nearest(key, known) or _home_of(key, schema)
            problem = f"unknown key, given {show(child)}"
            yield ScenarioError(path_of((*keys, key)), problem, allowed=enumerate_names(known), hint=hint)
        yield from unknown_keys(child_schema(schema, value, key), child, (*keys, key))


def translate(violation: ValidationError) -> ScenarioError:
    """Return jsonschema's finding in our words."""
    path, schema = path_of(list(violation.absolute_path)), violation.schema
    value: Any = violation.instance
    assert isinstance(schema, Mapping)
    allowed, hint = describe(schema), ""
    match violation.validator:
        case "required":
            return _missing_key(path, value, violation.validator_value, schema)
        case "enum":
            problem = f"unknown {str(schema.get('title', 'value')).lower()} {show(value)}"
            hint = nearest(value, [v for v in schema["enum"] if v]) if isinstance(value, str) else ""
        case "type":
            problem = f"{show(value)} is {_name_of(value)}"
            hint = _conversion(value, schema)
        case "minimum" | "exclusiveMinimum":
            problem = f"{show(value)} is too small"
        case "maximum" | "exclusiveMaximum":
            problem = f"{show(value)} is too large"
        case "minItems" | "maxItems":
            problem = f"the list {show(value)} has {len(value)} item{'s' if len(value) != 1 else ''}"
        case "uniqueItems":
            problem = f"{show(_repeated(value))} stands twice"
            hint = "Drop one."
        case "pattern":
            problem = f"{show(value)} is not of the right form"
        case _:
            problem = f"{show(value)} is empty"
    return ScenarioError(path, problem, allowed=allowed, hint=hint)


def describe(schema: Schema) -> str:
    """Say in words which values a schema allows: ``an integer >= 1``."""
    if "enum" in schema:
        return enumerate_names(["null" if value is None else str(value) for value in schema["enum"]])
    if "$comment" in schema:
        return str(schema["$comment"])
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    return " or ".join(_describe_type(name, schema) for name in types) or "any value"


def enumerate_names(names: Mapping[str, Any] | list[str] | tuple[str, ...], limit: int = 20) -> str:
    """Return names as a list for a message, cut off if there are many."""
    listed = list(names)
    more = f", ... ({len(listed) - limit} more)" if len(listed) > limit else ""
    return ", ".join(listed[:limit]) + more


def show(value: Any) -> str:
    """Return a value as JSON, cut to a length that fits a message."""
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= SHOWN_LENGTH else text[: SHOWN_LENGTH - 4] + " ..."


def _describe_type(name: str, schema: Schema) -> str:
    words = NAMES[name]
    if name in ("number", "integer"):
        return words + _describe_range(schema)
    if name == "string" and schema.get("minLength"):
        return "a string that is not empty"
    if name == "object" and "properties" in schema:
        return f"an object with {enumerate_names(schema['properties'])}"
    if name == "object" and schema.get("minProperties"):
        return "an object with at least one entry"
    if name == "array" and "items" in schema:
        return _describe_list(schema)
    return words


def _describe_range(schema: Schema) -> str:
    signs = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<=", "exclusiveMaximum": "<"}
    limits = [f"{sign} {schema[key]}" for key, sign in signs.items() if key in schema]
    return f" {' and '.join(limits)}" if limits else ""


def _describe_list(schema: Schema) -> str:
    item = resolve(schema["items"])
    kind = item.get("type")
    plural = f"{kind}s" if isinstance(kind, str) else "items"
    plural = ("different " if schema.get("uniqueItems") else "") + plural + _describe_range(item)
    least, most = schema.get("minItems", 0), schema.get("maxItems")
    if least and least == most:
        return f"a list of {least} {plural}"
    return (
        f"a list of at least {least} {plural}"
        if least > 1
        else f"a list of {plural}" + (", not empty" if least else "")
    )


def _missing_key(path: str, value: Mapping[str, Any], required: Any, schema: Schema) -> ScenarioError:
    key = next(key for key in required if key not in value)
    child = resolve(schema.get("properties", {}).get(key, {}))
    allowed = describe(child)
    if child.get("examples") and "$comment" not in child:
        allowed += f", such as {show(child['examples'][0])}"
    return ScenarioError(path, f"the key '{key}' is missing", allowed=allowed, hint=f"Add '{key}'.")


def _home_of(key: str, schema: Schema) -> str:
    """Say where a misplaced key belongs, or nothing."""
    for branch in schema.get("allOf", ()):
        if key in branch["then"].get("properties", {}):
            kind = kind_key(schema)
            test = branch["if"]["properties"][kind]
            return f"'{key}' goes with {kind} {' or '.join(test.get('enum', [test.get('const')]))}."
    for name, section in root_schema()["properties"].items():
        if schema is root_schema() and key in {*all_properties(resolve(section))} - {*KIND_KEYS, "description"}:
            return f"It belongs to '{name}'."
    return ""


def _name_of(value: Any) -> str:
    if isinstance(value, bool):
        return "a truth value"
    if isinstance(value, int | float):
        return "a number" if float(value).is_integer() else "not whole"
    if value is None:
        return "null"
    return "a string" if isinstance(value, str) else "a list" if isinstance(value, list) else "an object"


def _conversion(value: Any, schema: Schema) -> str:
    """Say how a value of the wrong type is written right, where that is plain."""
    types = schema.get("type", ())
    if "string" in types and isinstance(value, int | float):
        return f'Write "{str(value).lower() if isinstance(value, bool) else value}".'
    if ("number" in types or "integer" in types) and isinstance(value, str) and _is_number(value):
        return f"Write {value} without quotes."
    if "array" in types and not isinstance(value, list | dict):
        return f"Write [{show(value)}]."
    if "object" in types and isinstance(value, str) and len(schema.get("required", ())) == 1:
        return f"Write {show({schema['required'][0]: value})}."
    return ""


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _repeated(values: list[Any]) -> Any:
    return next(value for i, value in enumerate(values) if value in values[:i])
