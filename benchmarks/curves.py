"""Curves over the evaluations: one panel per problem, one line per method, the mean over the seeds with its error."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import NullFormatter
from problems import PROBLEMS
from problems.base import FloatArray

from hypermap_lite.plotting import style

SOLID, DASHED, DOTTED = "-", (0.0, (4.0, 1.5)), (0.0, (1.0, 1.2))
LINES: Mapping[str, tuple[str, Any]] = {
    "default": (style.COLOURS[1], SOLID),
    "paper preset": (style.COLOURS[1], DASHED),
    "Sobol": (style.GREY, DOTTED),
    "random": (style.LIGHT_GREY, DOTTED),
    "Optuna TPE": (style.COLOURS[0], DASHED),
    "Optuna GP": (style.COLOURS[0], SOLID),
    "BoTorch": (style.COLOURS[2], SOLID),
    "SMAC3 forest": (style.COLOURS[3], DASHED),
    "SMAC3 GP": (style.COLOURS[3], SOLID),
    "HyperMapper forest": (style.COLOURS[4], DASHED),
    "HyperMapper GP": (style.COLOURS[4], SOLID),
}
"""Colour of the package and dashes of the algorithm."""

SPARE_COLOURS = (*style.COLOURS[2:], style.COLOURS[0])
SMALLEST_GAP = 1e-4
COLUMNS, PANEL, LEGEND_HEIGHT = 3, (3.9, 3.1), 1.2
"""Panels side by side at most, width and height of each, and height for title and legend [inch]."""


def lines_of(methods: Sequence[str], known: Mapping[str, tuple[str, Any]]) -> dict[str, tuple[str, Any]]:
    """Return colour and dashes of each method, known ones or, for variants, those that are left, in their order."""
    found = {method: known[method] for method in methods if method in known}
    spare = ((colour, dashes) for dashes in (SOLID, DASHED, DOTTED) for colour in SPARE_COLOURS)
    free = (line for line in spare if line not in found.values())
    return {method: found.get(method) or next(free) for method in methods}


def traces_of(rows: Sequence[Mapping[str, Any]], problem: str, method: str) -> FloatArray:
    """Return the traces of a case, shape (seeds, evaluations)."""
    case = [row for row in rows if (row["problem"], row["method"]) == (problem, method) and row["trace"]]
    return np.array([[float(value) for value in row["trace"].split()] for row in case])


def band(traces: FloatArray, *, is_regret: bool) -> FloatArray:
    """Return what is drawn, shape (3, n): the line and both ends of its standard error.

    Regrets are averaged as logarithms; of shares of the hypervolume, what the mean lacks to 1.
    """
    mean = traces.mean(axis=0)
    error = traces.std(axis=0, ddof=1) / math.sqrt(len(traces)) if len(traces) > 1 else np.zeros_like(mean)
    ends = np.array([mean, mean - error, mean + error])
    return 10.0**ends if is_regret else np.maximum(1 - ends, SMALLEST_GAP)


def draw(
    rows: Sequence[Mapping[str, Any]],
    problems: Sequence[str],
    methods: Sequence[str],
    *,
    title: str,
    file: Path,
    lines: Mapping[str, tuple[str, Any]] = LINES,
) -> None:
    """Draw the rows of the result table and write the picture.

    Parameters
    ----------
    rows
        With the columns problem, method and trace.
    problems, methods
        What is drawn of them: the panels, and the lines in the order of the legend.
    title, file
        Of the picture.
    lines
        Colour and dashes of methods; others get what these leave. The first method is drawn on top.
    """
    shown = [problem for problem in problems if any(row["problem"] == problem for row in rows)]
    n_columns = max(min(COLUMNS, len(shown)), 1)
    n_rows = math.ceil(len(shown) / n_columns)
    with style.house_style():
        figure = style.new_figure(PANEL[0] * n_columns, PANEL[1] * n_rows + LEGEND_HEIGHT)
        panels = figure.subplots(n_rows, n_columns, squeeze=False).ravel()
        drawn, lines = {}, lines_of(methods, lines)
        for axes, problem in zip(panels, shown, strict=False):
            is_regret = PROBLEMS[problem].reference_point is None
            for index, method in enumerate(methods):
                traces = traces_of(rows, problem, method)
                if not len(traces):
                    continue
                colour, dashes = lines[method]
                middle, low, high = band(traces, is_regret=is_regret)
                evaluations = np.arange(1, len(middle) + 1)
                axes.plot(evaluations, middle, color=colour, linestyle=dashes, linewidth=1.8, zorder=3 - index / 100)
                axes.fill_between(evaluations, low, high, color=colour, alpha=0.12, linewidth=0)
                drawn[method] = style.legend_entry(method, colour, line=dashes)
            axes.set_yscale("log")
            axes.yaxis.set_major_formatter(lambda value, _position: f"{value:g}")
            axes.yaxis.set_minor_formatter(NullFormatter())
            style.mark_design_end(axes, PROBLEMS[problem].design)
            axes.set_title(problem)
            axes.set_ylabel("regret" if is_regret else "share of hypervolume lacking")
            axes.set_xlabel("evaluations")
        for axes in panels[len(shown) :]:
            axes.set_visible(False)
        figure.suptitle(title, fontsize=13)
        style.add_legend(figure, [drawn[method] for method in methods if method in drawn])
        style.save(figure, file)
