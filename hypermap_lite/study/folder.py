"""A study's folder on the disk: which runs in it are finished, and what they are called."""

from __future__ import annotations

import json
from pathlib import Path

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.csv_format import read_records


def is_study(folder: Path) -> bool:
    """Tell whether a folder is that of a study."""
    return (folder / "study.json").is_file() and (folder / "runs").is_dir()


def labelled_runs(folder: Path) -> list[tuple[str, Path]]:
    """Return label and folder of each finished run of a study, as it was last summarized, variant by variant.

    Raises
    ------
    RunFolderError
        If the study has no finished run, or its ``study.json`` cannot be read.
    """
    file = folder / "study.json"
    try:
        study = json.loads(file.read_text(encoding="utf-8"))
        variants, first = study["variants"], study["first_seed"]
        seeds = range(first, first + study["repetitions"])
        found = [
            (entry.get("label") or name.replace("_", " "), run)
            for name, entry in variants.items()
            for run in sorted((folder / "runs" / name).glob("[0-9]*"), key=lambda run: int(run.name))
            if int(run.name) in seeds and is_finished(run, entry["evaluations"])
        ]
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        raise RunFolderError(f"{file}: cannot be read as a study: {error!r}") from error
    if not found:
        raise RunFolderError(f"{folder}: no run of this study is finished yet")
    return found


def count_rows(run: Path) -> int:
    """Return how many configurations a run has evaluated."""
    return max(len(read_records(run / "history.csv")) - 1, 0)


def is_finished(run: Path, n_evaluations: int) -> bool:
    """Tell whether a run has made its evaluations, and has a front to show for it."""
    return count_rows(run) >= n_evaluations and len(read_records(run / "pareto.csv")) > 1
