"""``plot regret``: how far the best value so far is from the optimum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting import style, traces
from hypermap_lite.plotting.reference import number
from hypermap_lite.plotting.runs import Run, Source, by_label, load_runs, require_drawable
from hypermap_lite.plotting.settled import settled, trace
from hypermap_lite.typing import FloatArray


def plot_regret(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
    optimum: float | None = None,
    log: bool = False,
) -> list[Path]:
    """Draw the simple regret against the evaluations; see `hypermap_lite.plotting.PlotFunction`.

    The regret is the distance of the best feasible value so far from the optimum, for one objective. Runs that share a
    label become their mean with a band of one standard error, up to the end of the shortest. `reference_point` has no
    part here.

    `optimum` is the best possible value, as the user directed it; by default the best one of all runs. `log` makes the
    axis of the regret logarithmic; a regret of zero has no place on it.
    """
    runs = load_runs(folders, labels)
    require_drawable(runs)
    if len(runs[0].objectives) != 1:
        raise UsageError("`plot regret` needs one objective: try `plot hypervolume_gap`")
    objective = runs[0].objectives[0]
    best = best_value(runs) if optimum is None else optimum
    regrets = {label: [regret(run, best) for run in group] for label, group in by_label(runs).items()}
    target = style.output_path(output, runs, "regret")
    with style.house_style():
        figure = style.new_figure(7.2, 5.0)
        axes = figure.subplots()
        if log:
            traces.make_logarithmic(axes, [trace for group in regrets.values() for trace in group])
        traces.draw_design_ends(axes, runs)
        for index, group in enumerate(regrets.values()):
            traces.draw_trace(axes, group, style.colour(index))
        traces.show_evaluations(axes, runs)
        kind = "best value found" if optimum is None else "optimum"
        axes.set_xlabel(f"evaluations\n({kind}: {objective.name} {number(best)})")
        axes.set_ylabel("regret")
        style.add_legend(figure, traces.trace_legend(runs, single="regret"))
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    return [*files, style.save_data(*traces.numbers_behind(runs, regrets, "regret"), target)] if data else files


def best_value(runs: Sequence[Run]) -> float:
    """Return the best value of the first objective in all runs, as the user directed it."""
    sign = runs[0].objectives[0].sign
    return sign * float(min(np.nanmin(settled(run).Y[:, 0]) for run in runs))


def regret(run: Run, optimum: float) -> FloatArray:
    """Return the distance of the best value so far from the optimum, shape (n,), >= 0 if it is one; NaN before any."""
    best: FloatArray = trace(run, lambda Y: np.fmin.accumulate(Y[:, 0]))
    return best - run.objectives[0].sign * optimum
