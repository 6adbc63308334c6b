"""Reading one scenario file: strict JSON, with messages for what people do get wrong."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.scenario.sources import Keys, path_of

COMMENTS = ("//", "/*", "#")
PYTHON_WORDS = {"True": "true", "False": "false", "None": "null", "NaN": "null", "nan": "null"}


class RepeatedKeys(dict[str, Any]):
    """A JSON object that was written with a key twice."""

    repeated: str


def read_json(file: Path) -> dict[str, Any]:
    """Return the object in a JSON file.

    Raises
    ------
    ScenarioError
        If there is no such file, or it is not the UTF-8 text of one JSON object with finite numbers and distinct keys.
    """
    return parse_json(_read_text(file), str(file))


def parse_json(text: str, name: str) -> dict[str, Any]:
    """Return the object in a JSON text; `name` is what messages call it."""
    if not text.strip():
        raise ScenarioError(name, "the file is empty", allowed="a JSON object: {...}")
    try:
        document = parse_value(text, name)
    except json.JSONDecodeError as error:
        raise _broken(error, name) from None
    if not isinstance(document, dict):
        kind = "list" if isinstance(document, list) else "single value"
        raise ScenarioError("$", f"the file holds a {kind}", allowed="a JSON object: {...}", file=name)
    return document


def parse_value(text: str, name: str, keys: Keys = ()) -> Any:
    """Return the checked value in a JSON text that stands at some place of a document.

    Raises
    ------
    ScenarioError
        If it is nested too deeply, or breaks `check_values`.
    json.JSONDecodeError
        If it is not JSON.
    """
    try:
        value = json.loads(text, object_pairs_hook=_collect, parse_int=_parse_integer)
    except RecursionError:
        raise ScenarioError(name, "the JSON is nested too deeply") from None
    check_values(value, name, keys)
    return value


def check_values(value: Any, name: str, keys: Keys = ()) -> None:
    """Raise a `ScenarioError` at a number that is not finite or an object that repeats a key."""
    if isinstance(value, float) and not math.isfinite(value):
        problem = f"{value} is no JSON number, or one too large"
        raise ScenarioError(path_of(keys), problem, allowed="a finite number", file=name)
    if isinstance(value, RepeatedKeys):
        problem = f"the key '{value.repeated}' stands twice"
        raise ScenarioError(path_of(keys), problem, allowed="each key once", hint="Rename or drop one.", file=name)
    children = value.items() if isinstance(value, Mapping) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        check_values(child, name, (*keys, key))


def _read_text(file: Path) -> str:
    try:
        return file.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        others = [other.name for other in file.parent.glob("*.json")] if file.parent.is_dir() else []
        raise ScenarioError(str(file), "there is no such file", hint=nearest(file.name, others)) from None
    except IsADirectoryError:
        inside = sorted(other.name for other in file.glob("*.json"))[:3]
        hint = f"Name a file in it: {', '.join(inside)}." if inside else ""
        raise ScenarioError(str(file), "this is a folder", allowed="a scenario file (JSON)", hint=hint) from None
    except UnicodeDecodeError as error:
        problem = f"byte {error.start} (0x{error.object[error.start]:02x}) is not UTF-8"
        raise ScenarioError(str(file), problem, allowed="UTF-8 text", hint="Save the file as UTF-8.") from None
    except OSError as error:
        raise ScenarioError(str(file), f"cannot be read: {error.strerror or error}") from None


def _parse_integer(digits: str) -> int | float:
    """Return an integer; one beyond the range of floats is as infinite as it would be with a decimal point."""
    return int(digits) if math.isfinite(float(digits)) else float(digits)


def _collect(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    collected = dict(pairs)
    if len(collected) == len(pairs):
        return collected
    marked = RepeatedKeys(collected)
    keys = [key for key, _ in pairs]
    marked.repeated = next(key for i, key in enumerate(keys) if key in keys[:i])
    return marked


def _broken(error: json.JSONDecodeError, name: str) -> ScenarioError:
    error = _at_trailing_comma(error)
    line = error.doc.splitlines()[error.lineno - 1].strip() if error.doc.splitlines()[error.lineno - 1 :] else ""
    problem = f"broken JSON in line {error.lineno}, column {error.colno}: {error.msg[0].lower()}{error.msg[1:]}"
    seen = f"the line reads: {line[:60]}" if line else "the file ends here"
    return ScenarioError(f"{name}:{error.lineno}:{error.colno}", f"{problem}; {seen}", hint=_repair(error))


def _at_trailing_comma(error: json.JSONDecodeError) -> json.JSONDecodeError:
    """Point at a comma before a closing bracket, as Python does from 3.13 on; leave any other error as it is."""
    before = error.doc[: error.pos].rstrip()
    if before.endswith(",") and error.doc[error.pos :].lstrip()[:1] in ("}", "]"):
        return json.JSONDecodeError("trailing comma before the closing bracket", error.doc, len(before) - 1)
    return error


def _repair(error: json.JSONDecodeError) -> str:
    """Guess what to do about a syntax error from the text around it."""
    after = error.doc[error.pos :].lstrip()
    word = next((word for word in PYTHON_WORDS if after.startswith(word)), "")
    if after.startswith(",") and after[1:].lstrip()[:1] in ("}", "]"):
        return "Remove the comma before the closing bracket."
    if after.startswith(COMMENTS):
        return "JSON has no comments; use a description."
    if after.startswith("'"):
        return "Strings stand in double quotes."
    if word:
        return f"Write {PYTHON_WORDS[word]} instead of {word}."
    return "Put a comma before it." if "',' delimiter" in error.msg and after else ""
