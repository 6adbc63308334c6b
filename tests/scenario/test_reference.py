"""Tests for reference.py."""

from __future__ import annotations

from pathlib import Path

from hypermap_lite.scenario.reference import COMMAND, render
from hypermap_lite.scenario.schemas import all_properties, load_schemas

PAGE = Path(__file__).parents[2] / "docs" / "scenario.md"


def test_the_page_is_up_to_date() -> None:
    assert PAGE.read_text(encoding="utf-8") == render(), f"docs/scenario.md is stale; run: {COMMAND}"


def test_every_key_of_every_section_has_a_row() -> None:
    page = render()
    keys = {key for schema in load_schemas().values() for key in all_properties(schema)}
    assert [key for key in keys if f"| `{key}` |" not in page] == []


def test_every_section_has_a_heading() -> None:
    headings = {line.lstrip("# ") for line in render().splitlines() if line.startswith("##")}
    assert headings == {file.removesuffix(".schema.json") for file in load_schemas()}
