"""The scenario reference, written from the schemas.

``python -m hypermap_lite.scenario.reference > docs/scenario.md`` renews it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

from hypermap_lite.scenario.messages import describe
from hypermap_lite.scenario.schemas import (
    Schema,
    allows_bare_string,
    kind_key,
    load_schemas,
    resolve,
    root_schema,
    study_schema,
)

COMMAND: Final = "python -m hypermap_lite.scenario.reference > docs/scenario.md"
"""What renews the page."""

LINE_LENGTH: Final = 110
"""Characters of an example that stands on one line."""

INTRODUCTION: Final = """\
# Scenario reference

<!-- Written from scenario_schemas/ by: {command} -->

A scenario is one JSON file. `python -m hypermap_lite check scenario.json` says whether it is valid, what it amounts to
with every default filled in (`--json` for the whole of it), and what in it is probably not meant.

**Short forms.** A section that is chosen by its type may be a bare string: `"surrogate": "random_forest"` is
`"surrogate": {{"type": "random_forest"}}`. null always means the default.

**`extends`.** A scenario may state only what differs from another: `"extends": "base.json"`, or a list of files of
which later ones win. Objects are merged key by key, lists are replaced, and null takes a key back to its default (or
removes a parameter). Parameters keep the order of the base; new ones follow. A section that changes its type keeps only
the keys that all its types share: over `{{"type": "python", "function": "a:b", "replicates": 7}}`, a `command`
evaluator keeps `replicates` and forgets `function`.

**`--set`.** On the command line, `--set budget.evaluations=30` changes one value on top of the file. The value is JSON,
or else a string; list items go by number: `--set objectives.0.goal=maximize`.

**Studies.** Another kind of file, a [study](#study), names scenarios to be compared; `python -m hypermap_lite study
FILE` runs them.

**Trust.** A scenario can name any Python function or program to call: run only those you trust.
"""


def render() -> str:
    """Return the reference as Markdown."""
    parts = [INTRODUCTION.format(command=COMMAND), *_section("scenario", root_schema(), "##")]
    for name, schema in _sections(root_schema()):
        parts += _section(name, schema, "##" if name in root_schema()["properties"] else "###")
    parts += _section("study", study_schema(), "##")
    for name, schema in _sections(study_schema()):
        parts += _section(name, schema, "###")
    return "\n".join(parts).rstrip() + "\n"


def _sections(root: Schema) -> Iterator[tuple[str, Schema]]:
    """Yield the sections of a document in the order in which the schemas first refer to them, depth first."""
    seen: set[str] = set()

    def visit(schema: Any) -> Iterator[tuple[str, Schema]]:
        if isinstance(schema, Mapping):
            file = schema.get("$ref", "")
            if file in load_schemas() and file not in seen:
                seen.add(file)
                yield file.removesuffix(".schema.json"), load_schemas()[file]
                yield from visit(load_schemas()[file])
        children: Iterable[Any] = schema.values() if isinstance(schema, Mapping) else schema
        for child in children:
            if isinstance(child, Mapping | list):
                yield from visit(child)

    yield from visit(root)


def _section(name: str, schema: Schema, level: str) -> Iterator[str]:
    yield f"{level} {name}\n\n{schema['description']}\n"
    if "properties" in schema:
        yield _table(schema["properties"], schema.get("required", ()))
    for branch in schema.get("allOf", ()):
        test = branch["if"]["properties"][kind_key(schema)]
        kinds = ", ".join(f"`{kind}`" for kind in test.get("enum", [test.get("const")]))
        yield f"With {kind_key(schema)} {kinds}:\n"
        yield _table(branch["then"]["properties"], branch["then"].get("required", ()))
    examples = "\n".join(_as_json(example) for example in schema.get("examples", ()))
    yield f"```json\n{examples}\n```\n" if examples else ""


def _table(properties: Mapping[str, Schema], required: Iterable[str]) -> str:
    rows = ["| key | allowed | default | meaning |", "|---|---|---|---|"]
    for key, reference in properties.items():
        schema = resolve(reference)
        default = "**required**" if key in required else _default_of(schema)
        rows.append(f"| `{key}` | {_allowed(reference)} | {default} | {_cell(schema['description'])} |")
    return "\n".join(rows) + "\n"


def _allowed(reference: Schema) -> str:
    if "$ref" in reference:
        name = reference["$ref"].removesuffix(".schema.json")
        return f"[{name}](#{name})" + (" or a type" if allows_bare_string(resolve(reference)) else "")
    item = reference.get("items", {}).get("$ref")
    if item:
        name = item.removesuffix(".schema.json")
        return f"a list of [{name}](#{name})"
    return _cell(describe(reference))


def _default_of(schema: Schema) -> str:
    if "default" not in schema:
        return ""
    return "see there" if schema["default"] == {} else f"`{json.dumps(schema['default'])}`"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


def _as_json(example: Any) -> str:
    """Return an example on one line, or with its keys on a line each."""
    text = json.dumps(example)
    if len(text) <= LINE_LENGTH or not isinstance(example, Mapping):
        return text
    return "{\n" + ",\n".join(f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in example.items()) + "\n}"


if __name__ == "__main__":
    sys.stdout.write(render())
