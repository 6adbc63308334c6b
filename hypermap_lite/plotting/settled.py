"""Runs with confirmed configurations: what counts of them, in the end and after each evaluation.

What is compared, or drawn as a front, is the settled run, with the rows of a confirmed configuration as one. What is
drawn in the order of the evaluations are the rows as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from hypermap_lite.history.csv_format import format_number
from hypermap_lite.history.pooling import CONFIRM, confirmed_groups, pool
from hypermap_lite.objectives import Objective
from hypermap_lite.pareto import hypervolume_trace
from hypermap_lite.plotting.runs import Run, Source, load_runs
from hypermap_lite.typing import FloatArray


def load_settled(sources: Sequence[Source], labels: Sequence[str] | None = None) -> list[Run]:
    """Read the runs of one picture, settled; see `load_runs`."""
    return [settled(run) for run in load_runs(sources, labels)]


def settled(run: Run) -> Run:
    """Return a run with the rows of each confirmed configuration pooled into its first; see `pooling.pooled`."""
    phases = [row.get("phase", "") for row in run.rows]
    if CONFIRM not in phases:
        return run
    names = run.columns[: run.columns.index(run.objectives[0].name)]
    groups = confirmed_groups([tuple(row[name] for name in names) for row in run.rows], phases)
    firsts = [group[0] for group in groups]
    values, errors, rows = run.values[firsts].copy(), run.standard_errors[firsts].copy(), [run.rows[i] for i in firsts]
    for k, group in enumerate(groups):
        if len(group) == 1:
            continue
        worst = next((i for i in group if not run.is_completed[i]), None)
        if worst is not None:
            values[k], errors[k], rows[k] = np.nan, np.nan, run.rows[worst]
            continue
        sizes = [int(run.rows[i].get("replicates") or 1) for i in group]
        values[k], errors[k], n = pool(run.values[group], run.standard_errors[group], sizes)
        rows[k] = {**rows[k], **_as_texts(run.objectives, values[k], errors[k]), "replicates": str(n)}
    return replace(run, rows=tuple(rows), values=values, standard_errors=errors)


def _as_texts(objectives: Sequence[Objective], values: FloatArray, errors: FloatArray) -> dict[str, str]:
    texts = {o.name: format_number(float(v)) for o, v in zip(objectives, values, strict=True)}
    return texts | {f"{o.name}_sem": format_number(float(e)) for o, e in zip(objectives, errors, strict=True)}


def trial_of(run: Run, i: int) -> int:
    """Return the running number of a row, from 0: in a settled run its place is another."""
    return int(run.rows[i].get("trial") or i)


def beginning(run: Run, n: int) -> Run:
    """Return a run as it was after its first n evaluations."""
    return replace(run, rows=run.rows[:n], values=run.values[:n], standard_errors=run.standard_errors[:n])


def trace(run: Run, measure: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Measure a run after each of its evaluations.

    Parameters
    ----------
    run
        With all its rows.
    measure
        Takes objectives to be minimized in the order of the evaluations, shape (k, m), to what is measured after each
        of them, shape (k, ...).

    Returns
    -------
    FloatArray
        Shape (n, ...). From the first confirmed configuration on, each entry is of the settled run so far, so that a
        measure of what is best may get worse.
    """
    phases, n = [row.get("phase") for row in run.rows], len(run.rows)
    start = phases.index(CONFIRM) if CONFIRM in phases else n
    before = measure(run.Y[:start])
    ends = [measure(settled(beginning(run, k)).Y)[-1:] for k in range(start + 1, n + 1)]
    return np.concatenate([before, *ends])


def volume_trace(run: Run, corner: FloatArray) -> FloatArray:
    """Return the hypervolume after each evaluation, shape (n,), from a corner to be minimized against, shape (m,)."""
    return trace(run, lambda Y: hypervolume_trace(Y, corner))
