"""A scenario of our own form in the making: what is in it, where HyperMapper's file says so, and what to tell."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hypermap_lite.scenario.hypermapper.fork_keys import KEYS
from hypermap_lite.scenario.hypermapper.reading import Reading


@dataclass(frozen=True, slots=True)
class Note:
    """A key that means something else here, or nothing."""

    key: str
    text: str
    """What differs; a clause that follows the key and a colon."""

    is_written: bool = True
    """Whether the file has the key; else it is about its default."""

    is_dead: bool = False
    """Whether the key does nothing here."""

    def __str__(self) -> str:
        """Return the note as a line."""
        return f"{self.key}: {self.text}"


@dataclass(slots=True)
class Draft:
    """What a translation fills in."""

    reading: Reading
    document: dict[str, Any] = field(default_factory=dict)
    """The scenario in our form."""

    places: dict[str, str] = field(default_factory=dict)
    """HyperMapper's place for each of ours that was set."""

    notes: list[Note] = field(default_factory=list)

    def set(self, path: str, value: Any, key: str) -> None:
        """Set the value at a dotted path, and remember the key it follows from."""
        *above, last = path.split(".")
        place = self.document
        for name in above:
            place = place.setdefault(name, {})
        place[last] = value
        self.places[f"$.{path}"] = f"$.{key}"

    def note(self, key: str, text: str) -> None:
        """Tell what a key means here."""
        is_written = key.startswith("input_parameters") or self.reading.has(key)
        self.notes.append(Note(key, text, is_written))

    def note_table(self) -> None:
        """Tell what the table says of the keys that the file has."""
        for name in self.reading.given:
            if name in KEYS and KEYS[name].note:
                self.notes.append(Note(name, KEYS[name].note, is_dead=KEYS[name].is_dead))

    def unused(self, keys: Iterable[str], why: str) -> None:
        """Tell that keys of the file do nothing in it, as in HyperMapper."""
        for key in keys:
            if self.reading.has(key):
                self.notes.append(Note(key, f"it does nothing {why}", is_dead=True))

    def find(self, path: str) -> Path | None:
        """Return the file that a path leads to: in the working directory, or else beside the scenario."""
        written = Path(os.path.expanduser(path))
        return next((place for place in (written, self.reading.directory / written) if place.exists()), None)

    def file(self, path: str) -> str:
        """Return a path that leads to what HyperMapper reads, which looks in the working directory only.

        Ours are looked for beside the file that names them; where that would be another file, the path is made
        absolute.
        """
        here = Path(os.path.expanduser(path)).absolute()
        beside = self.reading.directory.absolute() / path
        return str(here) if here.exists() and here.resolve() != beside.resolve() else path
