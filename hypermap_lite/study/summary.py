"""From the finished runs of a study to what its tables say."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from hypermap_lite.errors import RunFolderError, ScenarioError, nearest
from hypermap_lite.history.csv_format import read_records
from hypermap_lite.objectives import to_minimization
from hypermap_lite.pareto import hypervolume, non_dominated
from hypermap_lite.plotting.reference import ReferencePoint, common_reference_point
from hypermap_lite.plotting.runs import Run, load_run
from hypermap_lite.plotting.settled import beginning, settled, trace, volume_trace
from hypermap_lite.study.folder import is_finished
from hypermap_lite.study.specification import Study, Variant
from hypermap_lite.study.statistics import (
    Interval,
    evaluations_to_reach,
    mean_and_standard_error,
    ratio_of_means,
)
from hypermap_lite.typing import FloatArray

AGGREGATES: Final[Mapping[str, Callable[[FloatArray], FloatArray]]] = {
    "mean": lambda values: np.cumsum(values) / np.arange(1, len(values) + 1),
    "sum": np.cumsum,
    "max": np.maximum.accumulate,
}
"""How extra numbers of the calls of a run, in their order, become one number so far, by name."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Repetition:
    """A finished run with what is compared of it."""

    run: Run
    seed: str
    score: FloatArray
    """Hypervolume after each evaluation, shape (n,); with a single objective its best value so far, to be maximized."""

    best: FloatArray
    """Best value of each objective so far, as the user directed it, shape (n, m)."""

    metrics: Mapping[str, FloatArray]
    """Extra numbers so far, by name, shapes (n,)."""

    seconds: float
    """Time spent on suggestions and evaluations [s]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison:
    """One variant against the baseline."""

    variant: Variant
    repetitions: tuple[Repetition, ...]
    final: tuple[float, float]
    """Mean and standard error of the final score."""

    ratio: Interval | None
    """Final score over that of the baseline; None for the baseline and for a single objective."""

    evaluations: Interval
    """Evaluations after which the mean score reaches the baseline's final mean; inf if it does not."""

    metrics: Mapping[str, tuple[float, float]]
    """Mean and standard error of the extra numbers at the end."""

    metric_ratios: Mapping[str, Interval]
    """Extra numbers over those of the baseline."""

    is_paired: bool
    """Whether its repetitions begin with the same configurations as those of the baseline."""

    n_without_result: int
    """Evaluations of all its runs that gave no usable result."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Summary:
    """All that the tables of a study say."""

    study: Study
    comparisons: tuple[Comparison, ...]
    """In the order of the variants; those without a finished run are left out."""

    n_evaluations: int
    """Evaluations per run that are compared: those of the shortest run."""

    reference_point: ReferencePoint | None
    """Corner the hypervolume is measured from; None for a single objective."""

    whole_volume: float
    """Hypervolume of the reference front; NaN for a single objective."""

    n_missing: int
    """Runs that are not finished."""

    union_front: tuple[tuple[Run, int], ...]
    """Run and row of each evaluation that no evaluation of any run dominates."""

    def share(self, volume: float) -> float:
        """Return a hypervolume as a share of the reference front's; NaN if that has none."""
        return volume / self.whole_volume if self.whole_volume > 0 else math.nan


def summarize(study: Study) -> Summary:
    """Read and compare the finished runs of a study.

    Raises
    ------
    RunFolderError
        If no run of the baseline is finished, a run folder holds the results of another scenario, or a file cannot be
        read.
    ScenarioError
        If the study's metrics or reference front are not what the files hold.
    """
    runs = _finished_runs(study)
    everything = [run for group in runs.values() for run in group]
    if not runs[study.baseline]:
        raise RunFolderError(f"{study.folder}: no run of the baseline '{study.baseline.name}' is finished yet")
    is_multi = len(study.objectives) > 1
    n = min(len(run.rows) for run in everything)
    stated = {o.name: o.reference_point for o in study.objectives if o.reference_point is not None}
    reference = common_reference_point(everything, stated) if is_multi else None
    corner = None if reference is None else to_minimization(study.objectives, reference.values)
    union = _union_front(everything, n)
    whole = math.nan if corner is None else hypervolume(_reference_front(study, union), corner)
    repetitions = {variant: tuple(_repetition(study, run, corner) for run in group) for variant, group in runs.items()}
    baseline = repetitions[study.baseline]
    return Summary(
        study=study,
        comparisons=tuple(_compare(study, v, group, baseline, n) for v, group in repetitions.items() if group),
        n_evaluations=n,
        reference_point=reference,
        whole_volume=whole,
        n_missing=sum(1 for _ in study.runs()) - len(everything),
        union_front=tuple(union),
    )


def _finished_runs(study: Study) -> dict[Variant, list[Run]]:
    """Read the runs that came to their end with a usable result, by variant, in the order of the seeds."""
    finished: dict[Variant, list[Run]] = {variant: [] for variant in study.variants}
    for planned in study.runs():
        planned.check_folder()
        if is_finished(planned.folder, planned.variant.n_evaluations):
            finished[planned.variant].append(load_run(planned.folder, label=planned.variant.label))
    return finished


def _repetition(study: Study, run: Run, corner: FloatArray | None) -> Repetition:
    best = trace(run, lambda Y: np.fmin.accumulate(Y, axis=0))
    seconds = [float(row.get(key) or 0.0) for row in run.rows for key in ("suggest_seconds", "evaluate_seconds")]
    return Repetition(
        run=run,
        seed=run.folder.name,
        score=-best[:, 0] if corner is None else volume_trace(run, corner),
        best=to_minimization(run.objectives, best),
        metrics={name: _metric(run, name, AGGREGATES[how]) for name, how in study.metrics.items()},
        seconds=sum(seconds),
    )


def _metric(run: Run, name: str, aggregate: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Return an extra number after each evaluation of a run, shape (n,); NaN before the first call that has it.

    Raises
    ------
    ScenarioError
        If the evaluator does not return it.
    """
    file = run.folder / "evaluations.csv"
    records = read_records(file)
    header = records[0] if records else []
    if name not in header:
        known, hint = ", ".join(header) or "none", nearest(name, header)
        raise ScenarioError(f"$.metrics.{name}", f"{file} has no column '{name}'", allowed=known, hint=hint)
    trials, values = [], []
    for record in sorted(records[1:], key=lambda r: (int(r[0]), int(r[1]))):
        if text := record[header.index(name)]:
            trials.append(int(record[0]))
            values.append(_number(f"$.metrics.{name}", text, file))
    if not values:
        return np.full(len(run.rows), np.nan)
    so_far = aggregate(np.array(values))
    last = np.searchsorted(trials, np.arange(len(run.rows)), side="right") - 1
    return np.where(last >= 0, so_far[last], np.nan)


def _number(place: str, text: str, file: Path) -> float:
    try:
        return float(text)
    except ValueError:
        raise ScenarioError(place, f"{file} has {text!r} in a column of numbers", allowed="numbers") from None


def _union_front(runs: Sequence[Run], n: int) -> list[tuple[Run, int]]:
    """Return run and row of each of the first n evaluations that none of any run dominates, each point once."""
    runs = [settled(beginning(run, n)) for run in runs]
    fronts = [np.flatnonzero(run.is_front) for run in runs]
    places = [(run, int(i)) for run, front in zip(runs, fronts, strict=True) for i in front]
    Y = np.vstack([run.Y[front] for run, front in zip(runs, fronts, strict=True)])
    _, first = np.unique(Y, axis=0, return_index=True)
    return [places[i] for i in first[non_dominated(Y[first])]]


def _reference_front(study: Study, union: Sequence[tuple[Run, int]]) -> FloatArray:
    """Return the front whose hypervolume counts as one, to be minimized, shape (k, m)."""
    if study.reference_front is None:
        return np.array([run.Y[i] for run, i in union])
    names = [o.name for o in study.objectives]
    file, place = study.reference_front, "$.reference_front"
    records = read_records(file) if file.is_file() else []
    if len(records) < 2 or not set(names) <= set(records[0]):
        problem = f"{file} has no rows with columns {', '.join(names)}"
        raise ScenarioError(place, problem, allowed="a CSV with a column per objective")
    columns = [records[0].index(name) for name in names]
    values = np.array([[_number(place, record[j], file) for j in columns] for record in records[1:]])
    return to_minimization(study.objectives, values)


def _compare(
    study: Study, variant: Variant, group: tuple[Repetition, ...], baseline: tuple[Repetition, ...], n: int
) -> Comparison:
    scores, finals = np.array([r.score[:n] for r in group]), np.array([r.score[n - 1] for r in baseline])
    is_paired = _share_designs(group, baseline)
    is_baseline = variant is study.baseline
    ends = {name: np.array([r.metrics[name][n - 1] for r in group]) for name in study.metrics}
    theirs = {name: np.array([r.metrics[name][n - 1] for r in baseline]) for name in study.metrics}
    return Comparison(
        variant=variant,
        repetitions=group,
        final=mean_and_standard_error(scores[:, -1]),
        ratio=None
        if is_baseline or len(study.objectives) == 1
        else ratio_of_means(scores[:, -1], finals, is_paired=is_paired),
        evaluations=evaluations_to_reach(scores, finals, is_paired=is_paired),
        metrics={name: mean_and_standard_error(values) for name, values in ends.items()},
        metric_ratios={}
        if is_baseline
        else {name: ratio_of_means(ends[name], theirs[name], is_paired=is_paired) for name in ends},
        is_paired=is_paired,
        n_without_result=sum(int(np.count_nonzero(~r.run.is_completed[:n])) for r in group),
    )


def _share_designs(group: Sequence[Repetition], baseline: Sequence[Repetition]) -> bool:
    """Tell whether the repetitions of two variants begin with the same configurations, seed by seed."""
    if [r.seed for r in group] != [r.seed for r in baseline]:
        return False
    return all(_design(a.run) == _design(b.run) for a, b in zip(group, baseline, strict=True))


def _design(run: Run) -> list[list[str]]:
    names = run.columns[: run.columns.index(run.objectives[0].name)]
    return [[row[name] for name in names] for row, is_design in zip(run.rows, run.is_design, strict=True) if is_design]
