"""``plot attainment``: the fronts that repetitions typically reach, in the plane of two objectives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from hypermap_lite.errors import UsageError
from hypermap_lite.objectives import to_minimization
from hypermap_lite.pareto import attainment_surface
from hypermap_lite.plotting import style
from hypermap_lite.plotting.pareto import staircase
from hypermap_lite.plotting.reference import ReferencePoint, common_reference_point
from hypermap_lite.plotting.runs import Run, Source, by_label, require_drawable
from hypermap_lite.plotting.settled import load_settled
from hypermap_lite.plotting.view import View, robust_view
from hypermap_lite.typing import FloatArray

FRACTIONS: Final = (0.25, 0.5, 0.75)
"""Parts of a label's runs that attain the better border of the band, the line, and the worse border."""

LINES: Final = ("-", (0.0, (4.0, 1.2)), (0.0, (1.5, 1.0)), (0.0, (5.0, 1.2, 1.2, 1.2)))
"""One dash pattern per label beside its colour, so that prints in grey stay readable [line widths]."""


def plot_attainment(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
) -> list[Path]:
    """Draw the median attainment surface of each label; see `hypermap_lite.plotting.PlotFunction`.

    The line bounds what at least half of a label's runs dominate, the band lies between what a quarter and three
    quarters of them do (`hypermap_lite.pareto.attainment_surface`) [1]_. A single run is its own front, without a band.

    References
    ----------
    .. [1] Grunert da Fonseca, Fonseca, Hall. Inferential Performance Assessment of Stochastic Optimisers and the
       Attainment Function. Evolutionary Multi-Criterion Optimization, 2001.
    """
    runs = load_settled(folders, labels)
    n_objectives = len(runs[0].objectives)
    if n_objectives != 2:
        hint = "objectives" if n_objectives == 1 else "hypervolume"
        raise UsageError(f"`plot attainment` needs 2 objectives, this scenario has {n_objectives}: try `plot {hint}`")
    require_drawable(runs)
    reference = common_reference_point(runs, reference_point)
    target = style.output_path(output, runs, "attainment")
    surfaces = label_surfaces(runs)
    with style.house_style():
        figure = style.new_figure(7.2, 5.6)
        axes = figure.subplots()
        view = _view(runs, surfaces, reference)
        view.apply(axes)
        for index, group in enumerate(surfaces.values()):
            _draw_surfaces(axes, runs, group, view, index)
        is_marked = bool(view.contains(reference.values[None])[0])
        if is_marked:
            axes.plot(*reference.values, linestyle="none", marker="x", markersize=9, markeredgewidth=2.2, color="black")
        axes.set_xlabel(style.axis_label(runs[0].objectives[0]))
        axes.set_ylabel(style.axis_label(runs[0].objectives[1]))
        style.add_legend(figure, _legend(runs, reference if is_marked else None))
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    return [*files, style.save_data(*_numbers_behind(runs, surfaces), target)] if data else files


def label_surfaces(runs: Sequence[Run]) -> dict[str, list[FloatArray]]:
    """Return the surfaces of `FRACTIONS` of each label, to be minimized, shapes (k, 2)."""
    return {
        label: [attainment_surface([run.Y[run.is_front] for run in group], fraction) for fraction in FRACTIONS]
        for label, group in by_label(runs).items()
    }


def _view(runs: Sequence[Run], surfaces: Mapping[str, Sequence[FloatArray]], reference: ReferencePoint) -> View:
    """Fit the view to the medians where they are better than the reference point, and to the rest where it is near.

    So the ends of a front that gain next to nothing at a price beyond the reference point do not set the scale; but
    each label is in view.
    """
    corner = to_minimization(runs[0].objectives, reference.values)
    important, others = [], [corner[None]]
    for better, median, worse in surfaces.values():
        counts = (median <= corner).all(axis=1)
        important.append(median[counts] if counts.any() else median)
        others += [better, median, worse]
    return robust_view(*(to_minimization(runs[0].objectives, np.vstack(points)) for points in (important, others)))


def _draw_surfaces(axes: Axes, runs: Sequence[Run], surfaces: Sequence[FloatArray], view: View, index: int) -> None:
    """Draw one label: the median as a staircase that runs out of view on its worse sides, and the band around it."""
    objectives = runs[0].objectives
    ends = to_minimization(objectives, np.vstack([view.low, view.high]))
    worst = np.vstack([ends, *surfaces]).max(axis=0)
    better, median, worse = (to_minimization(objectives, staircase(surface, worst)) for surface in surfaces)
    colour = style.colour(index)
    if not np.array_equal(better, worse):
        axes.fill(*np.vstack([better, worse[::-1]]).T, color=colour, alpha=0.18, linewidth=0, zorder=2)
        for border in (better, worse):
            axes.plot(*border.T, color=colour, linewidth=0.7, alpha=0.45, zorder=3, solid_joinstyle="miter")
    axes.plot(
        *median.T, color=colour, linestyle=LINES[index % len(LINES)], linewidth=2.2, zorder=4, solid_joinstyle="miter"
    )


def _legend(runs: Sequence[Run], reference: ReferencePoint | None) -> list[Line2D]:
    """Return the entries of the legend: the labels with their numbers of runs first, then what the marks mean."""
    groups = by_label(runs)
    entries = [
        style.legend_entry(
            f"{label} ({len(group)} run{'s' * (len(group) != 1)})", style.colour(i), line=LINES[i % len(LINES)]
        )
        for i, (label, group) in enumerate(groups.items())
    ]
    if any(len(group) > 1 for group in groups.values()):
        entries.append(style.legend_entry("median", style.GREY, line="-"))
        entries.append(style.legend_entry("25 % to 75 % of the runs", style.LIGHT_GREY, line="-", width=8))
    if reference is not None:
        kind = "reference point (inferred)" if reference.is_inferred else "reference point"
        entries.append(style.legend_entry(kind, "black", "x", size=8))
    return entries


def _numbers_behind(
    runs: Sequence[Run], surfaces: Mapping[str, Sequence[FloatArray]]
) -> tuple[list[str], list[list[object]]]:
    """Return the header and rows of the data of the picture: one row per corner of each surface."""
    objectives = runs[0].objectives
    n_runs = {label: len(group) for label, group in by_label(runs).items()}
    rows: list[list[object]] = [
        [label, n_runs[label], fraction, *map(float, corner)]
        for label, group in surfaces.items()
        for fraction, surface in zip(FRACTIONS, group, strict=True)
        for corner in to_minimization(objectives, surface)
    ]
    return ["label", "runs", "fraction", *(o.name for o in objectives)], rows
