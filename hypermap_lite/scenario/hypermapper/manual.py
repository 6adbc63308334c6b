"""The manual's table of HyperMapper's keys, made of the table the translation goes by.

``python -m hypermap_lite.scenario.hypermapper.manual`` prints it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from typing import Any, Final

from hypermap_lite.scenario.hypermapper.fork_keys import KEYS, PARAMETER_KEYS
from hypermap_lite.scenario.hypermapper.keys import Key

COMMAND: Final = "python -m hypermap_lite.scenario.hypermapper.manual"

HEADING: Final = "| HyperMapper's key | its default | ours | what differs |\n|---|---|---|---|"


def table() -> str:
    """Return the tables of all keys, those of HyperMapper's forks last."""
    main = [key for key in KEYS.values() if not key.fork]
    forks = [key for key in KEYS.values() if key.fork]
    parts = {
        "### The file": main,
        "### A parameter": PARAMETER_KEYS.values(),
        "### Keys of forks, and of ours": forks,
    }
    return "\n\n".join(f"{heading}\n\n{_rows(keys)}" for heading, keys in parts.items()) + "\n"


def _rows(keys: Iterable[Key]) -> str:
    rows = [f"| `{key.name}` | {_default(key.default)} | {_places(key.here)} | {_cell(key.note)} |" for key in keys]
    return "\n".join([HEADING, *rows])


def _default(value: Any) -> str:
    return "" if value is None else f"`{json.dumps(value)}`"


def _places(here: str) -> str:
    return ", ".join(f"`{place}`" for place in here.split(", ")) if here else "none"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    sys.stdout.write(table())
