"""Lines over the number of evaluations: one run as it is, repetitions as their mean with a standard-error band."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullFormatter

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting import style
from hypermap_lite.plotting.runs import Run, by_label, legend_labels
from hypermap_lite.typing import FloatArray

END_OF_DESIGN: Final = "end of design"
"""What the legend calls the dashed line."""

SHORT_RANGE: Final = 10.0
"""A logarithmic axis over a smaller factor has numbers between the powers of ten as well."""


def mean_and_error(traces: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Average the traces of repetitions up to the end of the shortest.

    Parameters
    ----------
    traces
        One value per evaluation and repetition, shapes (n_i,).

    Returns
    -------
    mean
        Shape (min n_i,); NaN where a repetition has NaN.
    standard_error
        Of the mean (ddof 1), shape (min n_i,); zero for a single trace.
    """
    n = min(map(len, traces))
    stacked = np.vstack([trace[:n] for trace in traces])
    mean: FloatArray = stacked.mean(axis=0)
    if len(traces) == 1:
        return mean, np.zeros(n)
    return mean, stacked.std(axis=0, ddof=1) / math.sqrt(len(traces))


def draw_trace(axes: Axes, traces: Sequence[FloatArray], colour: str) -> None:
    """Draw the traces of one label as a step line that holds each value until the next evaluation."""
    mean, error = mean_and_error(traces)
    evaluations = np.append(np.arange(1.0, len(mean) + 1), len(mean) + 0.5)  # the last value is held for half a step
    mean, error = np.append(mean, mean[-1:]), np.append(error, error[-1:])
    axes.step(evaluations, mean, where="post", color=colour, zorder=4)
    if len(traces) > 1:
        axes.fill_between(
            evaluations, mean - error, mean + error, step="post", color=colour, alpha=0.2, linewidth=0, zorder=2
        )


def make_logarithmic(axes: Axes, traces: Sequence[FloatArray]) -> None:
    """Make the vertical axis logarithmic, from the smallest to the largest positive value of the traces.

    Raises
    ------
    UsageError
        If no value is positive.
    """
    values = np.concatenate(list(traces))
    positive = values[np.isfinite(values) & (values > 0)]
    if not len(positive):
        raise UsageError("there is no value above zero to draw on a logarithmic axis")
    axes.set_yscale("log", nonpositive="clip")
    low, high = float(positive.min()), float(positive.max())
    room = max((high / low) ** 0.05, 1.05)
    axes.set_ylim(low / room, high * room)
    axes.yaxis.set_major_formatter(lambda value, _position: f"{value:g}")
    if high / low < SHORT_RANGE:
        axes.yaxis.set_minor_formatter(lambda value, _position: f"{value:.2g}")
    else:
        axes.yaxis.set_minor_formatter(NullFormatter())


def draw_design_ends(axes: Axes, runs: Sequence[Run]) -> None:
    """Draw a dashed line at the end of the initial design, one for each length that occurs."""
    for n_design in sorted({run.n_design for run in runs} - {0}):
        style.mark_design_end(axes, n_design)


def trace_legend(runs: Sequence[Run], *, single: str) -> list[Line2D]:
    """Return the legend of lines by label, with the number of repetitions, and of the dashed line.

    Parameters
    ----------
    runs
        All runs of the picture.
    single
        What the line is called if there is only one run.
    """
    groups = by_label(runs)
    labels = [single] if len(runs) == 1 else legend_labels(runs)
    entries = [style.legend_entry(label, style.colour(i), line="-") for i, label in enumerate(labels)]
    if any(len(group) > 1 for group in groups.values()):
        entries.append(style.legend_entry("\N{PLUS-MINUS SIGN} standard error", style.LIGHT_GREY, line="-", width=8))
    if any(run.n_design for run in runs):
        entries.append(style.legend_entry(END_OF_DESIGN, style.GREY, line=style.DASHES, width=1.3))
    return entries


def show_evaluations(axes: Axes, runs: Sequence[Run]) -> None:
    """Set the horizontal axis up: evaluations from 1 to the last one of the longest run."""
    axes.set_xlim(0, max(len(run.rows) for run in runs) + 1)
    axes.xaxis.set_major_locator(MaxNLocator(nbins="auto", steps=[1, 2, 5, 10], integer=True))
    axes.set_xlabel("evaluations")


def numbers_behind(
    runs: Sequence[Run], traces: Mapping[str, Sequence[FloatArray]], name: str
) -> tuple[list[str], list[list[object]]]:
    """Return the header and rows of the data of a picture: one row per run and evaluation.

    Parameters
    ----------
    runs
        All runs of the picture.
    traces
        What was drawn of them, under their labels.
    name
        What it is called.
    """
    rows: list[list[object]] = []
    for label, group in by_label(runs).items():
        mean, error = mean_and_error(traces[label])
        for run, trace in zip(group, traces[label], strict=True):
            for i, value in enumerate(trace):
                summary = [float(mean[i]), float(error[i])] if i < len(mean) else [np.nan, np.nan]
                rows.append([label, str(run.place), i + 1, float(value), *summary])
    return ["label", "run", "evaluation", name, "mean", "standard_error"], rows
