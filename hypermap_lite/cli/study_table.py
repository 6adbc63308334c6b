"""The comparison of a study's variants as text."""

from __future__ import annotations

import math

from hypermap_lite.cli.pareto import align
from hypermap_lite.plotting.reference import number
from hypermap_lite.study.statistics import Interval
from hypermap_lite.study.summary import Summary


def describe(summary: Summary) -> str:
    """Return the comparison of the variants as a table for people."""
    study, reference = summary.study, summary.reference_point
    score = "hypervolume" if reference else f"best {study.objectives[0].name}"
    header = ["variant", "runs", score, *(["share"] if reference else [])]
    header += [f"/ {study.baseline.label} (95 %)"] if reference else []
    header += [f"evaluations to {study.baseline.label} (95 %)", *(f"{how} {n}" for n, how in study.metrics.items())]
    sign = 1.0 if reference else -study.objectives[0].sign
    rows = []
    for c in summary.comparisons:
        mean, error = c.final
        row = [c.variant.label, str(len(c.repetitions)), _with_error(sign * mean, error)]
        row += [_share(summary.share(mean)), _interval(c.ratio, ".2f")] if reference else []
        row += [_interval(c.evaluations, ".0f", "never"), *(_with_error(*c.metrics[name]) for name in study.metrics)]
        rows.append(row)
    lines = [f"{study.name}: {summary.n_evaluations} evaluations per run\n", align([header, *rows]), ""]
    if reference:
        whole = summary.whole_volume
        meaning = "is share 1" if whole > 0 else "in all: nothing found beats the reference point in every objective"
        lines.append(f"hypervolume {number(whole)} {meaning} ({reference})")
    failed = [f"{c.n_without_result} of {c.variant.label}" for c in summary.comparisons if c.n_without_result]
    if failed:
        lines.append(f"evaluations without a usable result: {', '.join(failed)}")
    longer = [v.label for v in study.variants if v.n_evaluations > summary.n_evaluations]
    if longer:
        lines.append(f"only the first {summary.n_evaluations} evaluations of {', '.join(longer)} are compared")
    if summary.n_missing:
        runs = "1 run is" if summary.n_missing == 1 else f"{summary.n_missing} runs are"
        lines.append(f"{runs} not finished and not counted")
    return "\n".join(lines)


def _interval(interval: Interval | None, form: str, infinity: str = "inf") -> str:
    if interval is None or math.isnan(interval.value):
        return ""
    ends = [f"{x:{form}}" if math.isfinite(x) else infinity for x in (interval.value, interval.low, interval.high)]
    return ends[0] if math.isnan(interval.low) else f"{ends[0]} ({ends[1]} to {ends[2]})"


def _share(share: float) -> str:
    return "" if math.isnan(share) else f"{share:.3f}"


def _with_error(value: float, error: float) -> str:
    return number(value) if math.isnan(error) else f"{number(value)} ± {number(error, 2)}"
