"""``plot parameters``: the Pareto front in parallel coordinates, from the parameters to the objectives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Final

import matplotlib as mpl
import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypermap_lite.errors import UsageError
from hypermap_lite.objectives import Goal
from hypermap_lite.plotting import style
from hypermap_lite.plotting.parameter_axes import (
    chosen_axes,
    end_codes,
    name_with_scale,
    space_of,
    text_of,
    ticks,
    values_of,
)
from hypermap_lite.plotting.runs import Run, Source, by_label, legend_labels, require_drawable
from hypermap_lite.plotting.settled import load_settled, trial_of
from hypermap_lite.space import CategoricalParameter, Parameter
from hypermap_lite.typing import FloatArray, Value

GAP: Final = 0.3
"""Between the parameters' axes and the objectives', beside the usual distance of 1."""

MAX_GAP: Final = 2.5
"""Largest distance to the next axis that the names of levels get; what is longer is cut."""

SPACING: Final = 0.8
"""Distance of two axes, where the picture does not grow too wide [inch]."""

NARROWEST: Final = 7.2
WIDEST: Final = 15.0
"""Width of the picture [inch]."""

SIDES: Final = 1.0
"""Of the width, left and right of the outermost axes together, slanted names aside [inch]."""

HEIGHT: Final = 4.6
"""Of the picture, slanted names aside [inch]."""

DIGIT_WIDTH: Final = 0.09
"""Of the values at the axes, on average, with some space [inch]."""

SLANT: Final = 38
"""Of names that are wider than the distance of two axes [degrees]."""

BEYOND: Final = 0.035
"""Distance of the mark of the better end from the axis, as a fraction of its length."""

SCALE: Final = ListedColormap(mpl.colormaps["viridis"](np.linspace(0.0, 0.88, 256)))
"""Colours of the first objective; without the bright yellow, which vanishes on white."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrontRows:
    """The rows of all fronts, on axes that go from 0 to 1."""

    heights: FloatArray
    """Where each row crosses each axis, shape (rows, axes)."""

    labels: tuple[str, ...]
    """Of the run of each row."""

    numbers: tuple[tuple[object, ...], ...]
    """Label, run, evaluation, values of the parameters and of the objectives of each row."""

    ends: tuple[tuple[float, float], ...]
    """Values of the objectives at the ends of their axes."""


def plot_parameters(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
    parameters: Sequence[str] | None = None,
) -> list[Path]:
    """Draw a line per point of the fronts through all values; see `hypermap_lite.plotting.PlotFunction`.

    A parameter's axis reaches over all its values, an objective's over the fronts. The colour is the first
    objective, or the label where there are several. `reference_point` has no part here.

    `parameters` are the names of those that have an axis, in this order; by default all have.
    """
    runs = load_settled(folders, labels)
    require_drawable(runs)
    axes_shown = _common_parameters(runs, parameters)
    target = style.output_path(output, runs, "parameters")
    rows = _front_rows(runs, axes_shown)
    with style.house_style():
        names = [*map(name_with_scale, axes_shown), *(o.name for o in runs[0].objectives)]
        places = _places(axes_shown, len(runs[0].objectives))
        figure, spacing, is_slanted = _figure_for(names, places[-1])
        axes = figure.subplots()
        is_by_value = len(by_label(runs)) == 1
        _draw_lines(axes, rows, places, by_value_of=len(axes_shown) if is_by_value else None)
        for place, parameter in zip(places, axes_shown, strict=False):
            room = float(min(places[places > place]) - place) * spacing
            _draw_parameter_axis(axes, place, parameter, spacing, room)
        for j, place in enumerate(places[len(axes_shown) :]):
            _draw_objective_axis(axes, place, runs[0], j, rows.ends[j], spacing, is_scale=is_by_value and j == 0)
        _name_axes(axes, places, names, is_slanted=is_slanted)
        style.add_legend(figure, _legend(runs, is_by_value=is_by_value))
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    if not data:
        return files
    header = ["label", "run", "evaluation", *(p.name for p in axes_shown), *(o.name for o in runs[0].objectives)]
    return [*files, style.save_data(header, rows.numbers, target)]


def _places(parameters: Sequence[Parameter], n_objectives: int) -> FloatArray:
    """Return where the axes stand: a distance of 1 apart, more behind the parameters and behind the names of levels."""
    gaps = np.ones(len(parameters) + n_objectives)  # before each axis
    for j, parameter in enumerate(parameters):
        if isinstance(parameter, CategoricalParameter):
            needed = (max(map(len, parameter.values)) + 3) * DIGIT_WIDTH / SPACING
            gaps[j + 1] = min(max(1.0, needed), MAX_GAP)
    gaps[len(parameters)] += GAP
    return np.cumsum(gaps) - gaps[0]


def _figure_for(names: Sequence[str], n_gaps: float) -> tuple[Figure, float, bool]:
    """Return a figure with room for all axes, their distance [inch], and whether their names must be slanted."""
    longest = max(map(len, names)) * style.CHARACTER_WIDTH * 1.15  # the font of the names is larger than the legend's
    spacing = max(SPACING, (NARROWEST - SIDES) / n_gaps)
    is_slanted = longest > min(spacing, (WIDEST - SIDES) / n_gaps)
    slant = np.deg2rad(SLANT)
    left, below = (longest * np.cos(slant), longest * np.sin(slant)) if is_slanted else (0.3, 0.2)
    width = min(SIDES + left + max(SPACING * n_gaps, NARROWEST - SIDES - left), WIDEST)
    return style.new_figure(width, HEIGHT + float(below)), float(width - SIDES - left) / n_gaps, is_slanted


def _common_parameters(runs: Sequence[Run], names: Sequence[str] | None) -> list[Parameter]:
    """Return the parameters that have an axis; UsageError unless they are the same in all runs."""
    first = space_of(runs[0])
    for run in runs[1:]:
        other = space_of(run)
        for p, q in zip(first.parameters, other.parameters, strict=False):
            if replace(p, default=None) != replace(q, default=None) or len(first.names) != len(other.names):
                raise UsageError(
                    f"runs with different parameters cannot share a picture: {runs[0].folder} has "
                    f"{', '.join(f'{p.name} ({p.allowed()})' for p in first.parameters)}; {run.folder} has "
                    f"{', '.join(f'{p.name} ({p.allowed()})' for p in other.parameters)}"
                )
    return [first.parameters[j] for j in chosen_axes(first.names if names is None else names, first)]


def _front_rows(runs: Sequence[Run], parameters: Sequence[Parameter]) -> FrontRows:
    """Return the fronts' rows, label by label."""
    values: list[list[Value]] = [[] for _ in parameters]
    heads: list[tuple[object, ...]] = []
    objectives = np.vstack([run.values[run.is_front] for group in by_label(runs).values() for run in group])
    for label, group in by_label(runs).items():
        for run in group:
            chosen = np.flatnonzero(run.is_front)
            heads += [(label, str(run.place), trial_of(run, int(i)) + 1) for i in chosen]
            for column, parameter in zip(values, parameters, strict=True):
                of_run = values_of(run, parameter)
                column.extend(of_run[i] for i in chosen)
    low, high = objectives.min(axis=0), objectives.max(axis=0)
    heights = [_stretched(p.encode(column), *end_codes(p)) for p, column in zip(parameters, values, strict=True)]
    heights += [_stretched(column, *ends) for column, *ends in zip(objectives.T, low, high, strict=True)]
    return FrontRows(
        heights=np.column_stack(heights),
        labels=tuple(str(head[0]) for head in heads),
        numbers=tuple(
            (*head, *row) for head, row in zip(heads, zip(*values, *objectives.T.tolist(), strict=True), strict=True)
        ),
        ends=tuple((float(a), float(b)) for a, b in zip(low, high, strict=True)),
    )


def _stretched(values: FloatArray, low: float, high: float) -> FloatArray:
    """Return values mapped from [low, high] to [0, 1]; to the middle if that is a single value."""
    return (values - low) / (high - low) if high > low else np.full(len(values), 0.5)


def _draw_lines(axes: Axes, rows: FrontRows, places: FloatArray, *, by_value_of: int | None) -> None:
    """Draw the rows, coloured by their height on an axis or by their labels."""
    labels = list(dict.fromkeys(rows.labels))
    counts = {label: rows.labels.count(label) for label in labels}
    if by_value_of is not None:
        height = rows.heights[:, by_value_of]
        colours = SCALE(height)
        order = np.argsort(height, kind="stable")
    else:
        seen = dict.fromkeys(labels, 0)
        rank = []
        for label in rows.labels:  # mixed evenly, so that no label hides another
            seen[label] += 1
            rank.append((seen[label] - 0.5) / counts[label])
        colours = np.array([mpl.colors.to_rgba(style.colour(labels.index(label))) for label in rows.labels])
        order = np.argsort(rank, kind="stable")
    n = max(counts.values())
    lines = LineCollection(
        [np.column_stack([places, heights]) for heights in rows.heights[order]],
        colors=list(map(tuple, colours[order])),
        linewidths=1.7 if n <= 30 else 1.1,
        alpha=float(np.clip(14 / n, 0.3, 0.85)),
        zorder=3,
        capstyle="round",
    )
    axes.add_collection(lines)
    axes.set_xlim(places[0] - 0.35, places[-1] + 0.35)


def _draw_parameter_axis(axes: Axes, place: float, parameter: Parameter, spacing: float, room: float) -> None:
    """Draw the axis of one parameter, with its bounds at the ends, and its levels if they are few.

    `spacing` is the usual distance of two axes, `room` that to the next one [inch].
    """
    axes.plot([place, place], [0, 1], color=style.GREY, linewidth=1.1, zorder=2, solid_capstyle="butt")
    low, high = end_codes(parameter)
    codes, texts = ticks(parameter)
    heights = _stretched(codes, low, high)
    is_listed = parameter.n_levels is not None and len(codes) == parameter.n_levels
    if not isinstance(parameter, CategoricalParameter):
        first, last = parameter.decode(np.array([low, high]))
        _write_end(axes, place, _fitting(first, spacing), is_top=False)
        _write_end(axes, place, _fitting(last, spacing), is_top=True)
        inner = [(h, text) for h, text in zip(heights, texts, strict=True) if 1e-9 < h < 1 - 1e-9]
    else:
        inner = list(zip(heights, texts, strict=True))
    for height, text in inner:
        axes.plot(place, height, marker="_", markersize=7, color=style.GREY, zorder=2.5)
        if is_listed:
            longest = max(3, int((room - 0.2) / DIGIT_WIDTH))
            _write_level(axes, place, height, text if len(text) <= longest else text[: longest - 1] + "…")


def _draw_objective_axis(
    axes: Axes, place: float, run: Run, j: int, ends: tuple[float, float], spacing: float, *, is_scale: bool
) -> None:
    """Draw the axis of one objective, with the ends of the fronts' range and a mark at the better one."""
    if is_scale:
        heights = np.linspace(0, 1, 129)
        pieces = [[(place, a), (place, b)] for a, b in pairwise(heights)]
        colours = SCALE((heights[1:] + heights[:-1]) / 2)
        axes.add_collection(LineCollection(pieces, colors=colours, linewidths=8, zorder=4, capstyle="butt"))
    else:
        axes.plot([place, place], [0, 1], color=style.INK, linewidth=2.0, zorder=2, solid_capstyle="butt")
    is_better_up = run.objectives[j].goal is Goal.MAXIMIZE
    axes.plot(
        place,
        1 + BEYOND if is_better_up else -BEYOND,
        marker="^" if is_better_up else "v",
        markersize=7,
        color=style.INK,
        zorder=5,
    )
    if ends[0] == ends[1]:
        _write_level(axes, place, 0.5, _fitting(ends[0], spacing))
        return
    for end, is_top in zip(ends, (False, True), strict=True):
        _write_end(axes, place, _fitting(end, spacing), is_top=is_top, is_marked=is_top == is_better_up)


def _write_end(axes: Axes, place: float, text: str, *, is_top: bool, is_marked: bool = False) -> None:
    """Write a value beyond an end of an axis, and beyond the mark there if there is one."""
    axes.annotate(
        text,
        (place, 1.0 if is_top else 0.0),
        xytext=(0, (16 if is_marked else 5) * (1 if is_top else -1)),
        textcoords="offset points",
        ha="center",
        va="bottom" if is_top else "top",
        fontsize=10,
        color=style.INK,
        zorder=6,
    )


def _write_level(axes: Axes, place: float, height: float, text: str) -> None:
    """Write a level beside an axis, readable over the lines."""
    axes.annotate(
        text,
        (place, height),
        xytext=(5, 0),
        textcoords="offset points",
        ha="left",
        va="center",
        fontsize=10,
        color=style.INK,
        zorder=6,
        path_effects=[patheffects.withStroke(linewidth=3, foreground="white")],
    )


def _fitting(value: Value, spacing: float) -> str:
    """Write a value for people with as many digits, four at most, as fit between two axes."""
    if isinstance(value, tuple):
        text, n = text_of(value), max(3, int(spacing / DIGIT_WIDTH))
        return text if len(text) <= n else text[: n - 1] + "…"
    texts = [text_of(value, digits) for digits in (4, 3, 2)]
    for decimals in (1, 0):
        mantissa, _, exponent = f"{value:.{decimals}e}".partition("e")
        texts.append(f"{mantissa}e{int(exponent)}".replace("-", "\N{MINUS SIGN}"))
    return next((text for text in texts if len(text) * DIGIT_WIDTH <= spacing), texts[-1])


def _name_axes(axes: Axes, places: FloatArray, names: Sequence[str], *, is_slanted: bool) -> None:
    """Write the names below the axes, and take away all that an ordinary plot has around it."""
    axes.set_xticks(
        places,
        names,
        rotation=SLANT if is_slanted else 0,
        ha="right" if is_slanted else "center",
        rotation_mode="anchor",
    )
    axes.tick_params(axis="x", length=0, pad=2)
    axes.set_yticks([])
    axes.set_ylim(-0.14, 1.12)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)


def _legend(runs: Sequence[Run], *, is_by_value: bool) -> list[Line2D]:
    """Return the entries of the legend."""
    if is_by_value:
        n = sum(int(run.is_front.sum()) for run in runs)
        of = f" of {len(runs)} runs" if len(runs) > 1 else ""
        text = f"Pareto front{of} ({n} point{'s' * (n != 1)}), coloured by {runs[0].objectives[0].name}"
        entries = [style.legend_entry(text, mpl.colors.to_hex(SCALE(0.5)), line="-")]
    else:
        entries = [style.legend_entry(label, style.colour(i), line="-") for i, label in enumerate(legend_labels(runs))]
    goals = {objective.goal for objective in runs[0].objectives}
    for goal, shape in ((Goal.MAXIMIZE, "^"), (Goal.MINIMIZE, "v")):
        if goal in goals:
            entries.append(style.legend_entry("better end", style.INK, shape))
            break
    return entries
