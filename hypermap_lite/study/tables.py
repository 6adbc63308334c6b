"""The files of a study, besides its runs.

====================  ==============================================================================================
``study.json``        the study as it was run, with the versions in use
``summary.csv``       a row per run and evaluation: hypervolume, best values, extra numbers so far
``averages.csv``      a row per variant and evaluation: mean over the runs, and its standard error
``comparison.csv``    a row per variant: final values, and how they compare with the baseline
``union_front.csv``   the non-dominated evaluations of all runs together
====================  ==============================================================================================
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from hypermap_lite.history.csv_format import format_record
from hypermap_lite.history.files import make_folder, write_atomically
from hypermap_lite.history.scenario_record import installed_versions
from hypermap_lite.plotting.settled import trial_of
from hypermap_lite.study.specification import Study
from hypermap_lite.study.statistics import Interval, mean_and_standard_error
from hypermap_lite.study.summary import Summary


def write_tables(summary: Summary) -> list[Path]:
    """Write what a study has found into its folder; return the tables.

    Raises
    ------
    RunFolderError
        If a file cannot be written.
    """
    folder = summary.study.folder
    make_folder(folder)
    write_atomically(folder / "study.json", _as_json(summary.study))
    tables = {
        "summary.csv": _summary_rows(summary),
        "averages.csv": _average_rows(summary),
        "comparison.csv": _comparison_rows(summary),
        "union_front.csv": _front_rows(summary),
    }
    for name, rows in tables.items():
        write_atomically(folder / name, _as_csv(rows))
    return [folder / name for name in tables]


def _summary_rows(summary: Summary) -> Iterator[list[object]]:
    study = summary.study
    objectives = [f"best_{o.name}" for o in study.objectives]
    yield [
        "variant",
        "seed",
        "evaluation",
        "state",
        *(["hypervolume", "hypervolume_share"] if summary.reference_point else []),
        *objectives,
        *(f"{name}_{how}" for name, how in study.metrics.items()),
    ]
    for comparison in summary.comparisons:
        for r in comparison.repetitions:
            for i, score in enumerate(r.score.tolist()):
                volume = [score, summary.share(score)] if summary.reference_point else []
                extra = [float(values[i]) for values in r.metrics.values()]
                yield [comparison.variant.name, r.seed, i + 1, r.run.states[i], *volume, *r.best[i].tolist(), *extra]


def _average_rows(summary: Summary) -> Iterator[list[object]]:
    study = summary.study
    score = "hypervolume" if summary.reference_point else f"best_{study.objectives[0].name}"
    sign = 1.0 if summary.reference_point else -study.objectives[0].sign
    share = ["hypervolume_share", "hypervolume_share_se"] if summary.reference_point else []
    yield ["variant", "evaluation", "runs", score, f"{score}_se", *share]
    for c in summary.comparisons:
        scores = np.array([r.score[: summary.n_evaluations] for r in c.repetitions])
        for i, column in enumerate(scores.T):
            mean, error = mean_and_standard_error(column)
            shares = [summary.share(mean), summary.share(error)] if summary.reference_point else []
            yield [c.variant.name, i + 1, len(scores), sign * mean, error, *shares]


def _comparison_rows(summary: Summary) -> Iterator[list[object]]:
    study = summary.study
    score = "hypervolume" if summary.reference_point else f"best_{study.objectives[0].name}"
    header = ["variant", "label", "runs", "evaluations", "without_result", f"final_{score}", f"final_{score}_se"]
    header += ["final_share", "ratio", "ratio_low", "ratio_high"] if summary.reference_point else []
    header += ["evaluations_to_baseline", "evaluations_to_baseline_low", "evaluations_to_baseline_high", "paired"]
    for name, how in study.metrics.items():
        stem = f"{name}_{how}"
        header += [stem, f"{stem}_se", f"{stem}_ratio", f"{stem}_ratio_low", f"{stem}_ratio_high"]
    yield [*header, "seconds_per_run"]
    sign = 1.0 if summary.reference_point else -study.objectives[0].sign
    for c in summary.comparisons:
        mean, error = c.final
        row: list[object] = [c.variant.name, c.variant.label, len(c.repetitions), summary.n_evaluations]
        row += [c.n_without_result, sign * mean, error]
        row += [summary.share(mean), *_cells(c.ratio)] if summary.reference_point else []
        row += [*_cells(c.evaluations), str(c.is_paired).lower()]
        for name in study.metrics:
            row += [*c.metrics[name], *_cells(c.metric_ratios.get(name))]
        yield [*row, sum(r.seconds for r in c.repetitions) / len(c.repetitions)]


def _cells(interval: Interval | None) -> list[float]:
    return [math.nan] * 3 if interval is None else [interval.value, interval.low, interval.high]


def _front_rows(summary: Summary) -> Iterator[list[object]]:
    first = summary.union_front[0][0]
    names = [o.name for o in first.objectives]
    columns = [*first.columns[: first.columns.index(names[0])], *names]
    yield ["variant", "seed", "trial", *columns]
    for run, i in summary.union_front:
        yield [
            run.folder.parent.name,
            run.folder.name,
            trial_of(run, i),
            *(run.rows[i].get(name, "") for name in columns),
        ]


def _as_csv(rows: Iterator[list[object]]) -> str:
    """Return rows as CSV; numbers so that they read back exactly, NaN as nothing."""
    return "".join(format_record([_cell(value) for value in row]) for row in rows)


def _cell(value: object) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(float(value))
    return str(value)


def _as_json(study: Study) -> str:
    counts = {variant.name: variant.n_evaluations for variant in study.variants}
    variants = {name: {**entry, "evaluations": counts[name]} for name, entry in study.canonical["variants"].items()}
    record = {**study.canonical, "variants": variants, "versions": installed_versions()}
    return json.dumps(record, indent=2, ensure_ascii=False) + "\n"
