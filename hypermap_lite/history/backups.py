"""Keeping what was there before: copies of files, and whole folders under another name."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Sequence, Set
from itertools import count
from pathlib import Path

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.files import explained
from hypermap_lite.history.lock import LOCK_FILE, FolderLock


def keep_copies(paths: Sequence[Path]) -> int:
    """Copy the files that exist to ``<name>.bak-N``, with the first N that is free for all; return N."""
    number = next(n for n in count(1) if not any(_backup(path, n).exists() for path in paths))
    for path in paths:
        if path.exists():
            with explained(path):
                shutil.copy2(path, _backup(path, number))
    return number


def _backup(path: Path, number: int) -> Path:
    return path.with_name(f"{path.name}.bak-{number}")


def set_aside(path: str | Path, *, needed: Sequence[Path] = ()) -> Path | None:
    """Rename a run folder to the first free ``<name>.bak-N``; return the new path, or None if there was none.

    Parameters
    ----------
    path
        The folder.
    needed
        Places, besides the working directory, that must stay where they are.

    Raises
    ------
    RunFolderError
        If it is no run folder, holds a needed place, another process writes it, or it cannot be renamed.
    """
    folder = Path(os.path.abspath(path))  # not resolved: of a link, the link is renamed
    with explained(folder):
        names = {entry.name for entry in folder.iterdir()} if folder.exists() else set()
    if not names:
        return None
    _check_may_be_moved(folder, names, [Path.cwd(), *needed])
    target = next(_backup(folder, n) for n in count(1) if not _backup(folder, n).exists())
    with FolderLock(folder), explained(folder):
        folder.rename(target)
    return target


def _check_may_be_moved(folder: Path, names: Set[str], needed: Iterable[Path]) -> None:
    if not names & {"scenario.json", "history.csv"} and names - {LOCK_FILE, "run.log"}:
        shown = ", ".join(sorted(names)[:3])
        raise RunFolderError(
            f"{folder}: is not a run folder: it holds {shown}, but neither scenario.json nor history.csv\n"
            "  hint: Choose another folder with --output-dir; --fresh renames run folders only."
        )
    for place in needed:
        if place.resolve().is_relative_to(folder.resolve()):
            raise RunFolderError(
                f"{folder}: cannot be set aside, since {place.resolve()} is in it and in use\n"
                "  hint: Choose another folder with --output-dir, or start from elsewhere."
            )
