"""Samples files on the command line: CSV files without a run folder, such as HyperMapper's."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hypermap_lite.errors import UsageError

if TYPE_CHECKING:
    from hypermap_lite.plotting.runs import Source


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that say what the columns of a samples file mean."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--scenario", metavar="FILE", help="scenario of a RUN that is a CSV file without a run folder")
    group.add_argument(
        "--objectives",
        metavar="A,B",
        help="objectives of such a CSV file instead, all minimized but those written as NAME:maximize",
    )


def meaning_of(args: argparse.Namespace) -> Mapping[str, Any] | None:
    """Return the scenario of the samples files, or as much of it as the options say; None if they say nothing.

    Raises
    ------
    UsageError
        If an objective is not of the form NAME, NAME:minimize or NAME:maximize.
    ScenarioError
        If the scenario file is not valid.
    """
    if args.scenario is not None:
        from hypermap_lite.scenario import load_scenario

        return load_scenario(args.scenario).canonical
    if args.objectives is None:
        return None
    objectives = []
    for text in args.objectives.split(","):
        name, _, goal = text.strip().partition(":")
        if not name or goal not in ("", "minimize", "maximize"):
            raise UsageError(f"--objectives {args.objectives}: expected names, as in cost,speed:maximize")
        objectives.append({"name": name, "goal": goal or "minimize"})
    return {"objectives": objectives}


def as_sources(
    paths: Sequence[Path], labels: Sequence[str] | None, meaning: Mapping[str, Any] | None
) -> tuple[list[Source], list[str] | None]:
    """Return what the paths stand for, with their labels.

    Parameters
    ----------
    paths
        Run folders and CSV files.
    labels
        One per path, or None.
    meaning
        Scenario of the samples files; if None there are none. Else each CSV file is one, and a folder that is no run
        folder stands for all CSV files in it but fronts (``...pareto.csv``), as repetitions of one label.
    """
    from hypermap_lite.plotting.runs import SamplesFile

    if meaning is None:
        return list(paths), None if labels is None else list(labels)
    sources: list[Source] = []
    names: list[str] = []
    is_labelled = labels is not None
    for i, path in enumerate(paths):
        files = [path]
        if path.is_dir() and not (path / "history.csv").exists():
            files = sorted(file for file in path.glob("*.csv") if not file.stem.endswith("pareto"))
            is_labelled = is_labelled or len(files) > 1
        if not files:
            raise UsageError(f"{path}: neither a run folder nor a folder with CSV files")
        sources += [f if f.is_dir() else SamplesFile(path=f, scenario=meaning) for f in files]
        names += [path.stem if labels is None else labels[i]] * len(files)
    return sources, names if is_labelled else None
