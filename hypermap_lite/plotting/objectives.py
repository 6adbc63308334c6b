"""``plot objectives``: every evaluation of each objective in turn, and the best so far."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from hypermap_lite.objectives import Goal
from hypermap_lite.plotting import style, traces
from hypermap_lite.plotting.runs import Run, Source, by_label, load_runs, require_drawable
from hypermap_lite.plotting.settled import trace
from hypermap_lite.typing import FloatArray

STATE_MARKS: Final[Mapping[str, str]] = {"failed": "x", "timeout": "1", "infeasible": "_"}
"""Marks at the bottom of a panel for evaluations without values."""


def plot_objectives(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
) -> list[Path]:
    """Draw each objective against the evaluations; see `hypermap_lite.plotting.PlotFunction`.

    The line is the best value so far: of each objective for itself, so with several objectives no single
    configuration need reach all of them. Runs that share a label become the mean of their lines with a band of one
    standard error. Evaluations without values are marked at the bottom. `reference_point` has no part here.
    """
    runs = load_runs(folders, labels)
    require_drawable(runs)
    target = style.output_path(output, runs, "objectives")
    n_objectives = len(runs[0].objectives)
    with style.house_style():
        figure = style.new_figure(7.2, 2.7 * n_objectives + 1.3)
        panels = figure.subplots(n_objectives, 1, sharex=True, squeeze=False)[:, 0]
        for j, axes in enumerate(panels):
            _draw_panel(axes, runs, j)
        figure.align_ylabels(panels)
        traces.show_evaluations(panels[-1], runs)
        for axes in panels[:-1]:
            axes.set_xlabel("")
        style.add_legend(figure, _legend(runs))
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    return [*files, style.save_data(*_numbers_behind(runs), target)] if data else files


def running_best(run: Run) -> FloatArray:
    """Return the best value so far of each objective, shape (n, m), as the user directed it; NaN before the first."""
    signs = np.array([objective.sign for objective in run.objectives])
    best: FloatArray = signs * trace(run, lambda Y: np.fmin.accumulate(Y, axis=0))
    return best


def _draw_panel(axes: Axes, runs: Sequence[Run], j: int) -> None:
    """Draw one objective of all runs."""
    objective = runs[0].objectives[j]
    traces.draw_design_ends(axes, runs)
    for index, group in enumerate(by_label(runs).values()):
        colour = style.colour(index)
        for run in group:
            if len(group) == 1:
                _draw_evaluations(axes, run, j, index, crowded=len(runs) > 1)
        traces.draw_trace(axes, [running_best(run)[:, j] for run in group], colour)
    _make_room_for_marks(axes, runs)
    arrow = "\N{UPWARDS ARROW} larger" if objective.goal is Goal.MAXIMIZE else "\N{DOWNWARDS ARROW} smaller"
    axes.set_ylabel(f"{objective.name}\n({arrow} is better)")


def _draw_evaluations(axes: Axes, run: Run, j: int, index: int, *, crowded: bool) -> None:
    """Draw the values of one run, its standard errors, and the marks of evaluations without values."""
    evaluations = np.arange(1, len(run.rows) + 1)
    shade = style.colour(index) if crowded else style.GREY
    errors = np.nan_to_num(run.standard_errors[:, j], nan=0.0)
    if errors.any() and not crowded:
        axes.errorbar(
            evaluations, run.values[:, j], yerr=errors, fmt="none", ecolor=shade, elinewidth=1, alpha=0.4, zorder=2
        )
    for chosen, shape in ((run.is_design, "s"), (~run.is_design, style.marker(index))):
        axes.plot(
            evaluations[chosen],
            run.values[chosen, j],
            linestyle="none",
            marker=shape,
            markersize=4.8,
            markerfacecolor="white" if shape == "s" else shade,
            markeredgecolor=shade,
            markeredgewidth=1.3 if shape == "s" else 0.0,
            alpha=0.3 if crowded else 0.55,
            zorder=3,
        )
    for state, shape in STATE_MARKS.items():
        at = evaluations[[s == state for s in run.states]]
        height = np.full(len(at), 0.03 + 0.04 * index)
        axes.plot(
            at,
            height,
            linestyle="none",
            marker=shape,
            markersize=7,
            markeredgewidth=1.8,
            color=shade if crowded else style.COLOURS[1],
            transform=axes.get_xaxis_transform(),
            zorder=5,
        )


def _make_room_for_marks(axes: Axes, runs: Sequence[Run]) -> None:
    """Leave a strip below the values free if there are marks to put there."""
    if not all(run.is_completed.all() for run in runs):
        low, high = axes.get_ylim()
        axes.set_ylim(low - 0.09 * (high - low), high)


def _legend(runs: Sequence[Run]) -> list[Line2D]:
    """Return the entries of the legend."""
    entries = traces.trace_legend(runs, single="best so far")
    crowded = len(runs) > 1
    runs = [group[0] for group in by_label(runs).values() if len(group) == 1]  # the others are drawn as lines alone
    if runs:
        entries.append(style.legend_entry("evaluation", style.GREY, "o", size=5.5))
    if any(run.n_design for run in runs):
        entries.append(style.legend_entry("initial design", style.GREY, "s", size=5.5, hollow=True))
    occurring = {state for run in runs for state in run.states}
    colour = style.GREY if crowded else style.COLOURS[1]
    entries += [style.legend_entry(s, colour, shape) for s, shape in STATE_MARKS.items() if s in occurring]
    return entries


def _numbers_behind(runs: Sequence[Run]) -> tuple[list[str], list[list[object]]]:
    """Return the header and rows of the data of the picture: one row per run and evaluation."""
    names = [o.name for o in runs[0].objectives]
    header = ["label", "run", "evaluation", "phase", "state", *names]
    header += [f"{name}_sem" for name in names] + [f"{name}_best" for name in names]
    rows: list[list[object]] = []
    for run in runs:
        numbers = np.hstack([run.values, run.standard_errors, running_best(run)])
        for i, (row, line) in enumerate(zip(run.rows, numbers, strict=True)):
            rows.append([run.label, str(run.place), i + 1, row.get("phase", ""), row["state"], *map(float, line)])
    return header, rows
