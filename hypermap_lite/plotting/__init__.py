"""Pictures of run folders: a table of kinds, each drawn by one function from the files of the runs alone.

Matplotlib is imported only when a picture is drawn.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, Protocol, cast

from hypermap_lite.errors import UsageError, nearest


class PlotFunction(Protocol):
    """What draws one kind of picture."""

    def __call__(
        self,
        folders: Sequence[str | Path],
        output: str | Path | None = None,
        *,
        labels: Sequence[str] | None = None,
        title: str | None = None,
        reference_point: Mapping[str, float] | None = None,
        data: bool = False,
    ) -> list[Path]:
        """Draw the runs into one picture and return the files written.

        Parameters
        ----------
        folders
            Run folders, or the ``history.csv`` in them.
        output
            Where to write: a name that ends in ``.png`` or ``.pdf``, or one without ending for both. By default the
            kind's name, in the run folder if there is one run and in the working directory if there are several.
        labels
            One name per run for the legend; runs with equal names are repetitions of one experiment.
        title
            Text above the picture; by default the application's name where all runs share it.
        reference_point
            Worst value that still counts, by objective, in the user's units; by default the scenarios' own, else
            inferred from all runs together.
        data
            Write the numbers behind the picture beside it as well, as CSV.

        Raises
        ------
        UsageError
            If the runs cannot share this kind of picture, or the output cannot be written.
        RunFolderError
            If a run folder is missing, cannot be read, or has no completed evaluation.
        """


KINDS: Final[Mapping[str, str]] = {
    "pareto": "hypermap_lite.plotting.pareto:plot_pareto",
    "hypervolume": "hypermap_lite.plotting.hypervolume:plot_hypervolume",
    "objectives": "hypermap_lite.plotting.objectives:plot_objectives",
}
"""Kinds of pictures and the function, as ``module:name``, that draws each."""


def plot_function(kind: str) -> PlotFunction:
    """Return the function that draws a kind of picture.

    Raises
    ------
    UsageError
        If there is no such kind, or Matplotlib is not installed.
    """
    if kind not in KINDS:
        raise UsageError(f"unknown kind of picture '{kind}'; known: {', '.join(KINDS)}. {nearest(kind, KINDS)}".strip())
    module, _, name = KINDS[kind].partition(":")
    try:
        return cast(PlotFunction, getattr(importlib.import_module(module), name))
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "matplotlib":
            raise
        raise UsageError("pictures need Matplotlib: pip install 'hypermap-lite[plot]'") from error
