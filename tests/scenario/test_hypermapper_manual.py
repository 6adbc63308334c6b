"""The page for HyperMapper's users says what the translation does."""

from __future__ import annotations

import re
from pathlib import Path

from hypermap_lite.scenario.hypermapper import KEYS, PARAMETER_KEYS
from hypermap_lite.scenario.hypermapper.manual import COMMAND, table

PAGE = Path(__file__).parents[2] / "docs" / "hypermapper.md"


def test_the_pages_table_is_up_to_date() -> None:
    found = re.search(r"<!-- keys: begin -->\n\n(.*)\n<!-- keys: end -->", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    assert found[1] == table(), f"docs/hypermapper.md is stale; put between its marks what this prints: {COMMAND}"


def test_every_key_has_a_row() -> None:
    names = [*KEYS, *PARAMETER_KEYS]
    assert [name for name in names if f"| `{name}` |" not in table()] == []
