"""From a document of HyperMapper's to one of ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.hypermapper.budget import translate_budget
from hypermap_lite.scenario.hypermapper.draft import Draft, Note
from hypermap_lite.scenario.hypermapper.files import translate_black_box, translate_names, translate_output
from hypermap_lite.scenario.hypermapper.fork_keys import KEYS
from hypermap_lite.scenario.hypermapper.method import translate_method
from hypermap_lite.scenario.hypermapper.parameters import translate_parameters
from hypermap_lite.scenario.hypermapper.priors import translate_estimates
from hypermap_lite.scenario.hypermapper.reading import read
from hypermap_lite.scenario.merging import merge
from hypermap_lite.scenario.schemas import root_schema


@dataclass(frozen=True, slots=True)
class Translation:
    """A HyperMapper scenario in our form."""

    document: Mapping[str, Any]
    """The scenario; what equals our defaults is there too."""

    places: Mapping[str, str]
    """Place in HyperMapper's document by place in ours."""

    notes: tuple[Note, ...]
    """What means something else here, or nothing."""

    def brief(self) -> tuple[str, ...]:
        """Return the notes on what the file says: keys of which the same is said, or which do nothing, share a line."""
        written = [note for note in self.notes if note.is_written]
        keys: dict[str, list[str]] = {}
        for note in written:
            if not note.is_dead:
                keys.setdefault(note.text, []).append(note.key)
        lines = [f"{', '.join(names)}: {text}" for text, names in keys.items()]
        dead = list(dict.fromkeys(note.key for note in written if note.is_dead))
        if dead:
            lines.append(
                f"{', '.join(dead)}: nothing follows from {'these keys' if len(dead) > 1 else 'this key'} here"
            )
        return tuple(lines)


def translate(document: Mapping[str, Any], directory: Path = Path()) -> Translation:
    """Translate a HyperMapper document.

    Parameters
    ----------
    document
        Its content.
    directory
        Folder of the file.

    Raises
    ------
    ScenarioError
        If something in it is not right; the place is that in HyperMapper's document.
    """
    draft = Draft(read(document, directory))
    if draft.reading.is_version_3:
        draft.notes.append(
            Note("version 3", "the file has keys or values of HyperMapper's branch 3; its defaults apply")
        )
    translate_names(draft)
    translate_parameters(draft)
    translate_estimates(draft)
    translate_black_box(draft)
    translate_budget(draft)
    translate_method(draft)
    translate_output(draft)
    draft.note_table()
    for name in draft.reading.unknown:
        draft.notes.append(Note(name, "unknown; it does nothing", is_dead=True))
    return Translation(_with_own(draft), draft.places, tuple(_one_per_key(draft.notes)))


def _with_own(draft: Draft) -> Mapping[str, Any]:
    """Return the document with the sections laid over it that the file has in our form."""
    merged: dict[str, Any] = merge(root_schema(), draft.document, draft.reading.own)
    evaluator = merged.get("evaluator", {})
    if draft.document.get("evaluator", {}).get("batch") and evaluator.get("type") == "python":
        merged["evaluator"] = {"batch": True, **evaluator}
    return merged


def _one_per_key(notes: Sequence[Note]) -> list[Note]:
    """Return the notes in their order, those on one key as one."""
    joined: dict[str, Note] = {}
    for note in notes:
        old = joined.get(note.key)
        text = note.text if old is None else f"{old.text}; {note.text}"
        is_dead = note.is_dead and (old is None or old.is_dead)
        joined[note.key] = Note(note.key, text, note.is_written, is_dead)
    return list(joined.values())


def hypermappers_key(error: ScenarioError) -> ScenarioError:
    """Return the same error, with a hint if an unknown key of one of our files is one of HyperMapper's."""
    name = error.path.removeprefix("$.")
    if not error.problem.startswith("unknown key") or name not in KEYS:
        return error
    here = KEYS[name].here
    hint = f"It is HyperMapper's key for {here}." if here else "It is HyperMapper's key, and does nothing here."
    return ScenarioError(error.path, error.problem, allowed=error.allowed, hint=hint, file=error.file)
