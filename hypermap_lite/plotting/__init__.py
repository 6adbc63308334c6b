"""Pictures of run folders: a table of kinds, each drawn by one function from the files of the runs alone.

Matplotlib is imported only when a picture is drawn.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final, Protocol, cast

from hypermap_lite.errors import UsageError, nearest
from hypermap_lite.plotting.runs import Source


class PlotFunction(Protocol):
    """What draws one kind of picture."""

    def __call__(
        self,
        folders: Sequence[Source],
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
            Run folders, the ``history.csv`` in them, or samples files.
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
    "attainment": "hypermap_lite.plotting.attainment:plot_attainment",
    "parameters": "hypermap_lite.plotting.parameters:plot_parameters",
    "prior": "hypermap_lite.plotting.prior:plot_prior",
    "regret": "hypermap_lite.plotting.regret:plot_regret",
    "hypervolume_gap": "hypermap_lite.plotting.hypervolume_gap:plot_hypervolume_gap",
}
"""Kinds of pictures and the function, as ``module:name``, that draws each."""

KINDS_OF_PARAMETERS: Final = ("parameters", "prior")
"""Kinds that show parameters; their functions take the names of those to show as one more keyword, ``parameters``."""


OPTIONS: Final[Mapping[str, Sequence[str]]] = {
    "optimum": ("regret",),
    "log": ("regret", "hypervolume_gap"),
    "against": ("hypervolume_gap",),
}
"""Further keywords of some kinds' functions."""


def plot_function(
    kind: str, *, parameters: Sequence[str] | None = None, options: Mapping[str, Any] | None = None
) -> PlotFunction:
    """Return the function that draws a kind of picture.

    Parameters
    ----------
    kind
        One of `KINDS`.
    parameters
        Names of the parameters it shall show, for those of `KINDS_OF_PARAMETERS`; by default the kind chooses.
    options
        Values of those of `OPTIONS` that the kind has.

    Raises
    ------
    UsageError
        If there is no such kind, it shows no parameters, lacks an option, or Matplotlib is not installed.
    """
    if kind not in KINDS:
        raise UsageError(f"unknown kind of picture '{kind}'; known: {', '.join(KINDS)}. {nearest(kind, KINDS)}".strip())
    if parameters is not None and kind not in KINDS_OF_PARAMETERS:
        raise UsageError(f"`plot {kind}` shows no parameters to choose from; {', '.join(KINDS_OF_PARAMETERS)} do")
    keywords: dict[str, Any] = {} if parameters is None else {"parameters": parameters}
    for option, value in (options or {}).items():
        if kind not in OPTIONS[option]:
            raise UsageError(f"`plot {kind}` has no option '{option}'; {', '.join(OPTIONS[option])} do")
        keywords[option] = value
    module, _, name = KINDS[kind].partition(":")
    try:
        function = getattr(importlib.import_module(module), name)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "matplotlib":
            raise
        raise UsageError("pictures need Matplotlib: pip install 'hypermap-lite[plot]'") from error
    return cast(PlotFunction, partial(function, **keywords) if keywords else function)
