"""``plot hypervolume``: how the dominated volume grew with the evaluations."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from hypermap_lite.errors import UsageError
from hypermap_lite.objectives import to_minimization
from hypermap_lite.plotting import style, traces
from hypermap_lite.plotting.reference import ReferencePoint, common_reference_point
from hypermap_lite.plotting.runs import Run, Source, by_label, load_runs, require_drawable
from hypermap_lite.plotting.settled import volume_trace
from hypermap_lite.typing import FloatArray

logger = logging.getLogger(__name__)


def plot_hypervolume(
    folders: Sequence[Source],
    output: str | Path | None = None,
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
    reference_point: Mapping[str, float] | None = None,
    data: bool = False,
) -> list[Path]:
    """Draw hypervolume against evaluations; see `hypermap_lite.plotting.PlotFunction`.

    All runs are measured from one reference point. Runs that share a label become their mean with a band of one
    standard error, up to the end of the shortest. Failed evaluations leave the hypervolume as it was; one that
    confirms a configuration may lower it.
    """
    runs = load_runs(folders, labels)
    require_drawable(runs)
    if len(runs[0].objectives) < 2:
        raise UsageError("`plot hypervolume` needs at least 2 objectives, this scenario has 1: try `plot objectives`")
    reference = common_reference_point(runs, reference_point)
    if reference.is_inferred:
        logger.warning("%s; set `reference_point` in the scenario to compare with other pictures", reference)
    volumes = run_traces(runs, reference)
    if not all(np.isfinite(trace).all() for group in volumes.values() for trace in group):
        raise UsageError("the hypervolume is beyond all floats: give objectives or reference point another unit")
    target = style.output_path(output, runs, "hypervolume")
    with style.house_style():
        figure = style.new_figure(7.2, 5.0)
        axes = figure.subplots()
        traces.draw_design_ends(axes, runs)
        for index, group in enumerate(volumes.values()):
            traces.draw_trace(axes, group, style.colour(index))
        traces.show_evaluations(axes, runs)
        axes.set_ylim(bottom=0)
        style.label_with_power(axes, "hypervolume")
        axes.set_xlabel(f"evaluations\n({reference})")
        style.add_legend(figure, traces.trace_legend(runs, single="hypervolume"))
        style.set_title(figure, title, runs)
        files = style.save(figure, target)
    return [*files, style.save_data(*traces.numbers_behind(runs, volumes, "hypervolume"), target)] if data else files


def run_traces(runs: Sequence[Run], reference: ReferencePoint) -> dict[str, list[FloatArray]]:
    """Return the hypervolume after each evaluation of each run, shape (n,), under the runs' labels."""
    corner = to_minimization(runs[0].objectives, reference.values)
    return {label: [volume_trace(run, corner) for run in group] for label, group in by_label(runs).items()}
