"""``plot hypervolume_gap``: how much of the volume that all runs together dominate a run lacks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from hypermap_lite.errors import RunFolderError, UsageError
from hypermap_lite.objectives import to_minimization
from hypermap_lite.pareto import hypervolume, hypervolume_trace
from hypermap_lite.plotting import style, traces
from hypermap_lite.plotting.files import numbers_of
from hypermap_lite.plotting.reference import ReferencePoint, common_reference_point
from hypermap_lite.plotting.runs import Run, Source, by_label, load_runs, require_drawable
from hypermap_lite.plotting.settled import settled, trace
from hypermap_lite.typing import FloatArray

SHORTEST_EPOCH: Final = 1e8
"""Times from here on [s] are dates, as HyperMapper writes them in its client-server mode; they count from the first."""


def plot_hypervolume_gap(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
    against: str = "evaluations",
    log: bool = False,
) -> list[Path]:
    """Draw the hypervolume gap to the front of all runs together; see `hypermap_lite.plotting.PlotFunction`.

    The gap is the share of the volume dominated by that front which a run does not dominate yet: 1 at the beginning, 0
    on the front. It does not depend on the units of the objectives. Runs that share a label become their mean with a
    band of one standard error, up to the end of the shortest.

    `against` is ``evaluations`` or ``time``, the ``Timestamp`` column; `log` makes the axis of the gap logarithmic.
    """
    runs = load_runs(folders, labels)
    require_drawable(runs)
    if len(runs[0].objectives) < 2:
        raise UsageError("`plot hypervolume_gap` needs at least 2 objectives, this scenario has 1: try `plot regret`")
    reference = common_reference_point(runs, reference_point)
    gaps = {label: [gap(run, runs, reference) for run in group] for label, group in by_label(runs).items()}
    target = style.output_path(output, runs, "hypervolume_gap")
    with style.house_style():
        figure = style.new_figure(7.2, 5.0)
        axes = figure.subplots()
        if log:
            traces.make_logarithmic(axes, [trace for group in gaps.values() for trace in group])
        else:
            axes.set_ylim(0, 1.02)
        if against == "time":
            _draw_over_time(axes, runs, gaps)
        else:
            traces.draw_design_ends(axes, runs)
            for index, group in enumerate(gaps.values()):
                traces.draw_trace(axes, group, style.colour(index))
            traces.show_evaluations(axes, runs)
        axes.set_xlabel(f"{axes.get_xlabel()}\n({reference})")
        axes.set_ylabel("share of the hypervolume that is missing")
        entries = traces.trace_legend(runs, single="hypervolume gap")
        style.add_legend(figure, [e for e in entries if against != "time" or e.get_label() != traces.END_OF_DESIGN])
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    return [*files, style.save_data(*traces.numbers_behind(runs, gaps, "gap"), target)] if data else files


def gap(run: Run, runs: Sequence[Run], reference: ReferencePoint) -> FloatArray:
    """Return the missing share of the hypervolume after each evaluation of a run, shape (n,), in [0, 1].

    Parameters
    ----------
    run
        The run.
    runs
        All runs, whose front together has no gap.
    reference
        Corner that all are measured from.

    Raises
    ------
    UsageError
        If nothing in any run is better than the reference point in every objective.
    """
    corner = to_minimization(run.objectives, reference.values)
    points = np.vstack([settled(other).Y for other in runs])
    ideal = np.nanmin(points, axis=0)
    span = corner - ideal
    if not (span > 0).all():
        raise UsageError(f"no run beats the reference point in every objective ({reference})")
    # points and reference alike on the scale from ideal to reference: volumes are shares of the box between them
    whole = hypervolume((points - ideal) / span, np.ones(len(span)))
    if whole <= 0:
        raise UsageError(f"no evaluation beats the reference point in every objective ({reference})")
    own = trace(run, lambda Y: hypervolume_trace((Y - ideal) / span, np.ones(len(span))))
    return np.clip(1 - own / whole, 0.0, 1.0)


def _draw_over_time(axes: Axes, runs: Sequence[Run], gaps: Mapping[str, Sequence[FloatArray]]) -> None:
    """Draw the mean of each label at all times at which one of its runs has a new row, up to the end of the first."""
    end = 0.0
    for index, (label, group) in enumerate(by_label(runs).items()):
        times = [_seconds(run) for run in group]
        until = min(float(t[-1]) for t in times)
        instants = np.unique(np.concatenate([[0.0], *times]))
        instants = instants[instants <= until]
        held = [
            np.append(1.0, trace)[np.searchsorted(t, instants, side="right")]
            for t, trace in zip(times, gaps[label], strict=True)
        ]
        mean, error = traces.mean_and_error(held)
        axes.step(instants, mean, where="post", color=style.colour(index), zorder=4)
        if len(group) > 1:
            look: dict[str, Any] = {
                "step": "post",
                "color": style.colour(index),
                "alpha": 0.2,
                "linewidth": 0,
                "zorder": 2,
            }
            axes.fill_between(instants, mean - error, mean + error, **look)
        end = max(end, until)
    axes.set_xlim(0, 1.02 * end if end > 0 else 1)
    axes.set_xlabel("time [s]")


def _seconds(run: Run) -> FloatArray:
    """Return the time of each row [s], never falling, shape (n,)."""
    if "Timestamp" not in run.columns:
        raise RunFolderError(f"{run.place}: no column 'Timestamp'; found {', '.join(run.columns)}")
    times = numbers_of(run.rows, ["Timestamp"], run.place)[:, 0] / 1000
    if not np.isfinite(times).all():
        raise RunFolderError(f"{run.place}: a row has no Timestamp")
    if times.min() >= SHORTEST_EPOCH:
        times = times - times.min()
    return np.maximum.accumulate(times)
