"""How sure a comparison over repetitions is: ratios and times with bootstrap intervals [1]_.

References
----------
.. [1] Efron, Tibshirani. An Introduction to the Bootstrap. Chapman & Hall, 1993, ch. 13 (percentile intervals).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.typing import FloatArray, IntArray

RESAMPLES: Final = 10_000
"""Bootstrap samples; the ends of an interval are then sure to about 2 % of its length."""

SEED: Final = 0
"""Of the resampling: the same runs always give the same interval."""

COVERAGE: Final = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """An estimate with its 95 % bootstrap interval."""

    value: float
    low: float
    high: float


def mean_and_standard_error(values: FloatArray) -> tuple[float, float]:
    """Return the mean of n values, shape (n,), and its standard error (ddof 1); NaN for a single value."""
    with np.errstate(invalid="ignore"):  # infinities
        error = float(values.std(ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else math.nan
    return float(values.mean()), error


def ratio_of_means(a: FloatArray, b: FloatArray, *, is_paired: bool) -> Interval:
    """Compare two sets of repetitions by the ratio of their means.

    Parameters
    ----------
    a, b
        One value per repetition, shapes (n,) and (k,); of the same length and in the same order if paired.
    is_paired
        Whether repetitions belong together, as those that share seed and design do: they are then resampled together.

    Returns
    -------
    Interval
        mean(a) / mean(b); NaN where that is not defined, and its interval if there are fewer than two repetitions.
    """
    drawn_a, drawn_b = _resamples(len(a), len(b), is_paired=is_paired)
    with np.errstate(divide="ignore", invalid="ignore"):
        value = np.float64(a.mean()) / b.mean()
        return _interval(float(value), a[drawn_a].mean(axis=1) / b[drawn_b].mean(axis=1), min(len(a), len(b)))


def evaluations_to_reach(traces: FloatArray, finals: FloatArray, *, is_paired: bool) -> Interval:
    """Count the evaluations after which a mean trace reaches the mean final value of the baseline.

    Parameters
    ----------
    traces
        A value after each of N evaluations, shape (n, N); NaN before there is one, and then the mean is none either.
    finals
        Last values of the baseline's repetitions, shape (k,).
    is_paired
        See `ratio_of_means`.

    Returns
    -------
    Interval
        Counted from 1; infinity where the mean never gets there.
    """
    drawn, drawn_finals = _resamples(len(traces), len(finals), is_paired=is_paired)
    counts = np.zeros((RESAMPLES, len(traces)))
    np.add.at(counts, (np.arange(RESAMPLES)[:, None], drawn), 1.0)
    is_known = np.isfinite(traces)  # zero times NaN is no zero
    means = counts @ np.where(is_known, traces, 0.0) / len(traces)
    means[counts @ ~is_known > 0] = np.nan
    targets = finals[drawn_finals].mean(axis=1)
    value = first_reaching(traces.mean(axis=0)[None], np.array([finals.mean()]))[0]
    return _interval(float(value), first_reaching(means, targets), min(len(traces), len(finals)))


def first_reaching(traces: FloatArray, targets: FloatArray) -> FloatArray:
    """Return after how many evaluations each trace, shape (n, N), reaches its target, shape (n,); inf if never.

    A millionth of a millionth of the target is not told apart from the target.
    """
    slack = 1e-12 * np.abs(np.where(np.isfinite(targets), targets, 0.0))
    is_reached = traces >= (targets - slack)[:, None]
    return np.where(is_reached.any(axis=1), is_reached.argmax(axis=1) + 1.0, np.inf)


def _resamples(n: int, k: int, *, is_paired: bool) -> tuple[IntArray, IntArray]:
    """Return the rows of each bootstrap sample of two sets, shapes (RESAMPLES, n) and (RESAMPLES, k)."""
    if is_paired and n != k:
        raise ValueError(f"Expected as many repetitions on both sides of a paired comparison. Got {n} and {k}")
    rng = np.random.default_rng(SEED)
    first = rng.integers(n, size=(RESAMPLES, n))
    return first, first if is_paired else rng.integers(k, size=(RESAMPLES, k))


def _interval(value: float, resampled: FloatArray, n: int) -> Interval:
    if n < 2 or math.isnan(value):
        return Interval(value, math.nan, math.nan)
    tail = (1.0 - COVERAGE) / 2.0
    # The nearest sample, not an interpolation: between a number and infinity there is no middle.
    low, high = np.nanquantile(resampled, [tail, 1.0 - tail], method="inverted_cdf")
    return Interval(value, float(low), float(high))
