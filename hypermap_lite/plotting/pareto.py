"""``plot pareto``: the evaluations in the plane of two objectives, and the front they reached."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from enum import Enum
from itertools import combinations
from pathlib import Path
from typing import Any, Final, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting import style
from hypermap_lite.plotting.posterior import PosteriorPoints, posterior_points
from hypermap_lite.plotting.reference import ReferencePoint, common_reference_point
from hypermap_lite.plotting.runs import Run, Source, by_label, legend_labels, require_drawable
from hypermap_lite.plotting.settled import load_settled, trial_of
from hypermap_lite.plotting.view import View, robust_view
from hypermap_lite.typing import BoolArray, FloatArray

MAX_OBJECTIVES: Final = 5
"""Ten panels; more cannot be read."""

PANELS_PER_ROW: Final = 3


class Detail(Enum):
    """How much of a run is drawn."""

    ALL = "the only run: all points with error bars, and the dominated region shaded"
    FRONT_ERRORS = "one of several runs: all points, error bars on the front"
    FRONT_ONLY = "one of several repetitions: the front alone, thin"


def plot_pareto(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
) -> list[Path]:
    """Draw the Pareto fronts of one or several runs; see `hypermap_lite.plotting.PlotFunction`.

    With two objectives the front is a staircase that bounds the dominated region; with three to five each pair of
    objectives has a panel. Error bars are one standard error over the replicates. All fronts and the reference point
    are in view; evaluations far from both and from most others are counted, and marked at the border. The picture of
    a single run shows its posterior front too, if there is a ``posterior_front.csv``.
    """
    runs = load_settled(folders, labels)
    n_objectives = len(runs[0].objectives)
    if not 2 <= n_objectives <= MAX_OBJECTIVES:
        raise UsageError(
            f"`plot pareto` needs 2 to {MAX_OBJECTIVES} objectives, this scenario has {n_objectives}: "
            "try `plot objectives`"
        )
    reference = common_reference_point(runs, reference_point)
    require_drawable(runs, reference.values)
    target = style.output_path(output, runs, "pareto")
    with style.house_style():
        figure = _draw_plane(runs, reference) if n_objectives == 2 else _draw_pairs(runs, reference)
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    return [*files, style.save_data(*_numbers_behind(runs), target)] if data else files


def staircase(front: FloatArray, worst: FloatArray) -> FloatArray:
    """Return the border of the region a two-objective front dominates, as corners of a line.

    Parameters
    ----------
    front
        Mutually non-dominated points to be minimized, shape (k, 2), k >= 1.
    worst
        Values at which the line starts and ends, shape (2,).

    Returns
    -------
    FloatArray
        Corners from (smallest first value, `worst[1]`) to (`worst[0]`, smallest second value), shape (2 k + 1, 2).
    """
    front = np.unique(front, axis=0)  # sorted by the first objective
    first = np.append(np.repeat(front[:, 0], 2), worst[0])
    second = np.insert(np.repeat(front[:, 1], 2), 0, worst[1])
    return np.column_stack([first, second])


def _draw_plane(runs: Sequence[Run], reference: ReferencePoint) -> Figure:
    """Draw two objectives: one panel, with the staircase of each run."""
    figure = style.new_figure(7.2, 5.6)
    axes = figure.subplots()
    is_outside = _draw_panel(axes, runs, (0, 1), reference)
    detail = _detail_for(runs)
    for index, group in enumerate(by_label(runs).values()):
        for run in group:
            _draw_front_line(axes, run, style.colour(index), detail)
    style.add_legend(figure, _legend(runs, reference, line="-", n_outside=int(is_outside.sum())))
    return figure


def _draw_pairs(runs: Sequence[Run], reference: ReferencePoint) -> Figure:
    """Draw more than two objectives: a panel per pair, with the points of the front in all objectives marked."""
    pairs = list(combinations(range(len(runs[0].objectives)), 2))
    n_rows = math.ceil(len(pairs) / PANELS_PER_ROW)
    figure = style.new_figure(13.0, 4.3 * n_rows + 0.7)
    grid = figure.subplots(n_rows, PANELS_PER_ROW, squeeze=False)
    is_outside = [_draw_panel(axes, runs, pair, reference) for axes, pair in zip(grid.flat, pairs, strict=False)]
    for axes in grid.flat[len(pairs) :]:
        axes.set_axis_off()
    for axes in grid.flat[: len(pairs)]:
        axes.locator_params(nbins=5)
    n_outside = int(np.any(is_outside, axis=0).sum())
    style.add_legend(figure, _legend(runs, reference, line="none", n_outside=n_outside))
    return figure


def _detail_for(runs: Sequence[Run]) -> Detail:
    """Return how much of each run can be drawn before it hides the others."""
    if len(runs) == 1:
        return Detail.ALL
    return Detail.FRONT_ERRORS if len(by_label(runs)) == len(runs) else Detail.FRONT_ONLY


def _draw_panel(axes: Axes, runs: Sequence[Run], pair: tuple[int, int], reference: ReferencePoint) -> BoolArray:
    """Draw the points of all runs in the plane of two objectives; tell which of all evaluations are not in view."""
    columns = list(pair)
    detail = _detail_for(runs)
    corner = reference.values[columns]
    fronts = np.vstack([run.values[run.is_front][:, columns] for run in runs])
    posterior = _posterior(runs)
    if posterior is not None:
        fronts = np.vstack([fronts, posterior.mean[:, columns]])
    rest = np.vstack([run.values[run.is_completed & ~run.is_front][:, columns] for run in runs])
    view = robust_view(np.vstack([fronts, corner]), rest[:0] if detail is Detail.FRONT_ONLY else rest)
    view.apply(axes)
    is_outside = []
    for index, group in enumerate(by_label(runs).values()):
        for run in group:
            _draw_points(axes, run, columns, index, detail)
            is_outside.append(_draw_outside(axes, run, columns, index, detail, view))
    if posterior is not None:
        posterior.draw(axes, columns)
    axes.plot(*corner, linestyle="none", marker="x", markersize=9, markeredgewidth=2.2, color="black", zorder=6)
    axes.set_xlabel(style.axis_label(runs[0].objectives[pair[0]]))
    axes.set_ylabel(style.axis_label(runs[0].objectives[pair[1]]))
    return np.concatenate(is_outside)


def _posterior(runs: Sequence[Run]) -> PosteriorPoints | None:
    """Return the posterior front of the only run; None if it has none, or there are several runs."""
    return posterior_points(runs[0]) if len(runs) == 1 else None


def _draw_outside(axes: Axes, run: Run, columns: list[int], index: int, detail: Detail, view: View) -> BoolArray:
    """Mark the evaluations of one run that are drawn, but not in view; tell which they are, shape (n,)."""
    if detail is Detail.FRONT_ONLY:
        return np.zeros(len(run.rows), dtype=bool)
    points = run.values[:, columns]
    view.draw_outside(axes, points[run.is_completed], style.GREY if detail is Detail.ALL else style.colour(index))
    return run.is_completed & ~view.contains(points)


def _draw_points(axes: Axes, run: Run, columns: list[int], index: int, detail: Detail) -> None:
    """Draw one run: dominated points faded, the design hollow, the front strong, error bars where there is room."""
    colour = style.colour(index)
    front, rest = run.is_front, run.is_completed & ~run.is_front
    if detail is Detail.FRONT_ONLY:
        _draw_markers(axes, run, front, columns, index, colour=colour, size=4.5, alpha=0.75, zorder=5)
        return
    faded = style.GREY if detail is Detail.ALL else colour
    if detail is Detail.ALL:
        _draw_error_bars(axes, run, rest, columns, colour=faded, alpha=0.25, zorder=2)
    _draw_markers(axes, run, rest, columns, index, colour=faded, size=5.0, alpha=0.38, zorder=3)
    _draw_error_bars(axes, run, front, columns, colour=style.INK, alpha=0.8, zorder=4.5)
    _draw_markers(axes, run, front, columns, index, colour=colour, size=8.0, alpha=1.0, zorder=5)


def _draw_markers(
    axes: Axes,
    run: Run,
    chosen: BoolArray,
    columns: list[int],
    index: int,
    *,
    colour: str,
    size: float,
    alpha: float,
    zorder: float,
) -> None:
    """Draw some points of a run: hollow squares for the initial design, the label's own marker for the others."""
    for is_kind, shape in ((run.is_design, "s"), (~run.is_design, style.marker(index))):
        points = run.values[chosen & is_kind][:, columns]
        is_hollow = shape == "s"
        axes.plot(
            *points.T,
            linestyle="none",
            marker=shape,
            markersize=size * 0.9 if is_hollow else size,
            markerfacecolor="white" if is_hollow else colour,
            markeredgecolor=colour if is_hollow or alpha < 1 else "white",
            markeredgewidth=0.2 * size + 0.5 if is_hollow else 0.8,
            alpha=alpha,
            zorder=zorder,
        )


def _draw_error_bars(
    axes: Axes, run: Run, chosen: BoolArray, columns: list[int], *, colour: str, alpha: float, zorder: float
) -> None:
    """Draw one standard error to each side of the chosen points; nothing where it is not known."""
    errors = run.standard_errors[chosen][:, columns]
    if not np.isfinite(errors).any():
        return
    x, y = run.values[chosen][:, columns].T
    x_error, y_error = np.nan_to_num(errors, nan=0.0).T
    look = {"fmt": "none", "ecolor": colour, "elinewidth": 1.1, "alpha": alpha, "zorder": zorder}
    axes.errorbar(x, y, xerr=x_error, yerr=y_error, **cast(Any, look))


def _draw_front_line(axes: Axes, run: Run, colour: str, detail: Detail) -> None:
    """Draw the staircase of a two-objective front up to the worse sides of the view."""
    signs = np.array([objective.sign for objective in run.objectives])
    limits = signs * np.array([axes.get_xlim(), axes.get_ylim()]).T  # (low and high, objective)
    worst = limits.max(axis=0)
    corners = staircase(run.Y[run.is_front], worst)
    width, alpha = (1.2, 0.55) if detail is Detail.FRONT_ONLY else (2.0, 1.0)
    axes.plot(*(signs * corners).T, color=colour, linewidth=width, alpha=alpha, zorder=4, solid_joinstyle="miter")
    if detail is Detail.ALL:
        region = signs * np.vstack([corners, worst])
        axes.fill(*region.T, color=colour, alpha=0.07, linewidth=0, zorder=1)


def _legend(runs: Sequence[Run], reference: ReferencePoint, *, line: str, n_outside: int) -> list[Line2D]:
    """Return the entries of the legend: the labels first, then what the marks mean."""
    detail = _detail_for(runs)
    labels = legend_labels(runs)
    if detail is Detail.ALL:
        labels = [f"Pareto front ({int(runs[0].is_front.sum())} points)"]
    size = 5.0 if detail is Detail.FRONT_ONLY else 8.0
    entries = [
        style.legend_entry(label, style.colour(i), style.marker(i), line=line, size=size)
        for i, label in enumerate(labels)
    ]
    shows_all = detail is not Detail.FRONT_ONLY
    if shows_all and any((run.is_completed & ~run.is_front).any() for run in runs):
        entries.append(style.legend_entry("dominated", style.GREY, "o", alpha=0.45))
    if any((run.is_design & (run.is_completed if shows_all else run.is_front)).any() for run in runs):
        entries.append(style.legend_entry("initial design", style.GREY, "s", hollow=True))
    if shows_all and any(np.isfinite(run.standard_errors).any() for run in runs):
        entries.append(style.legend_entry("\N{PLUS-MINUS SIGN} standard error", style.INK, "|", size=11))
    posterior = _posterior(runs)
    if posterior is not None:
        entries.insert(1, posterior.legend_entry())
    if n_outside:
        entries.append(style.legend_entry(f"{n_outside} outside", style.GREY, "v"))
    kind = "reference point (inferred)" if reference.is_inferred else "reference point"
    entries.append(style.legend_entry(kind, "black", "x", size=8))
    return entries


def _numbers_behind(runs: Sequence[Run]) -> tuple[list[str], list[list[object]]]:
    """Return the header and rows of the data of the picture: one row per completed evaluation."""
    names = [o.name for o in runs[0].objectives]
    header = ["label", "run", "evaluation", "phase", "on_front", *names, *(f"{name}_sem" for name in names)]
    rows = [
        [
            run.label,
            str(run.place),
            trial_of(run, int(i)) + 1,
            run.rows[i].get("phase", ""),
            bool(front[i]),
            *map(float, numbers[i]),
        ]
        for run in runs
        for front, numbers in [(run.is_front, np.hstack([run.values, run.standard_errors]))]
        for i in np.flatnonzero(run.is_completed)
    ]
    return header, rows
