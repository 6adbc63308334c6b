"""Tests for statistics.py."""

import math

import numpy as np
import pytest
from scipy.stats import bootstrap

from hypermap_lite.study.statistics import (
    RESAMPLES,
    Interval,
    evaluations_to_reach,
    first_reaching,
    mean_and_standard_error,
    ratio_of_means,
)

PAIRING = pytest.mark.parametrize("is_paired", [True, False], ids=["paired", "unpaired"])

SAMPLE = np.random.default_rng(3).gamma(4.0, size=(2, 25))


def ends(interval):
    return interval.low, interval.high


def test_mean_and_standard_error_by_hand():
    assert mean_and_standard_error(np.array([1.0, 3.0, 5.0])) == (3.0, pytest.approx(2.0 / math.sqrt(3.0)))
    mean, error = mean_and_standard_error(np.array([7.0]))
    assert mean == 7.0
    assert math.isnan(error)


def test_mean_of_infinities_is_infinite_and_warns_of_nothing():
    mean, error = mean_and_standard_error(np.array([math.inf, math.inf]))
    assert mean == math.inf
    assert math.isnan(error)


@PAIRING
def test_ratio_of_constants_is_certain(is_paired):
    assert ratio_of_means(np.full(4, 3.0), np.full(4, 2.0), is_paired=is_paired) == Interval(1.5, 1.5, 1.5)


def test_pairs_in_proportion_are_certain_only_if_they_are_taken_for_pairs():
    a, b = SAMPLE[0] * 2.0, SAMPLE[0]
    paired, unpaired = (ratio_of_means(a, b, is_paired=is_paired) for is_paired in (True, False))
    assert (paired.value, *ends(paired)) == pytest.approx((2.0, 2.0, 2.0), rel=1e-12)
    assert unpaired.value == paired.value
    assert unpaired.low < 1.8
    assert unpaired.high > 2.2


@PAIRING
def test_interval_agrees_with_that_of_scipy(is_paired):
    ours = ratio_of_means(*SAMPLE, is_paired=is_paired)
    theirs = bootstrap(
        tuple(SAMPLE),
        lambda a, b, axis: a.mean(axis=axis) / b.mean(axis=axis),
        n_resamples=RESAMPLES,
        method="percentile",
        paired=is_paired,
        rng=np.random.default_rng(1),
    ).confidence_interval
    assert ours.value == SAMPLE[0].mean() / SAMPLE[1].mean()
    assert ends(ours) == pytest.approx(tuple(theirs), abs=0.03 * (theirs.high - theirs.low))


def test_unpaired_sets_may_differ_in_number_and_paired_ones_may_not():
    a, b = np.array([1.0, 2.0, 3.0]), np.array([1.0, 1.0])
    assert ratio_of_means(a, b, is_paired=False) == Interval(2.0, pytest.approx(1.0, abs=0.4), 3.0)
    with pytest.raises(ValueError, match="Got 3 and 2"):
        ratio_of_means(a, b, is_paired=True)


@pytest.mark.parametrize(("n", "k"), [(1, 1), (1, 3), (3, 1)])
def test_one_repetition_on_either_side_has_a_value_and_no_interval(n, k):
    ratio = ratio_of_means(np.full(n, 3.0), np.full(k, 2.0), is_paired=False)
    assert ratio.value == 1.5
    assert np.isnan(ends(ratio)).all()


@pytest.mark.parametrize("spoilt", [(math.nan, 1.0), (1.0, math.nan), (0.0, 0.0), (math.inf, math.inf)])
@PAIRING
def test_ratio_that_is_not_defined_is_nan_and_warns_of_nothing(spoilt, is_paired):
    a, b = (np.full(3, value) for value in spoilt)
    ratio = ratio_of_means(a, b, is_paired=is_paired)
    assert np.isnan([ratio.value, *ends(ratio)]).all()


def test_ratio_to_a_baseline_of_zero_is_infinite():
    assert ratio_of_means(np.ones(3), np.zeros(3), is_paired=True) == Interval(math.inf, math.inf, math.inf)


def test_resamples_without_a_ratio_are_left_out():
    ratio = ratio_of_means(np.array([0.0, 2.0]), np.array([0.0, 1.0]), is_paired=True)
    assert ratio == Interval(2.0, 2.0, 2.0)


TRACES = np.array([[0.0, 1.0, 4.0, 4.0], [0.0, 3.0, 4.0, 6.0]])
"""Their mean is 0, 2, 4, 5."""


@pytest.mark.parametrize(
    ("target", "count"),
    [(-1.0, 1.0), (0.0, 1.0), (0.1, 2.0), (2.0, 2.0), (2.1, 3.0), (5.0, 4.0), (5.1, math.inf), (math.nan, math.inf)],
)
def test_evaluations_to_reach_a_target_by_hand(target, count):
    assert evaluations_to_reach(TRACES, np.full(2, target), is_paired=True).value == count


def test_interval_of_evaluations_by_hand():
    # The mean of two draws of the traces reaches 4.5 after 4 evaluations unless both are the first one (a quarter).
    assert evaluations_to_reach(TRACES, np.full(2, 4.5), is_paired=False) == Interval(4.0, 4.0, math.inf)


def test_baseline_reaches_its_own_end_in_every_resample():
    traces = np.maximum.accumulate(np.random.default_rng(0).normal(size=(12, 30)), axis=1)
    interval = evaluations_to_reach(traces, traces[:, -1], is_paired=True)
    assert interval.high <= 30


def test_mean_is_not_there_before_every_trace_has_begun():
    traces = np.array([[math.nan, math.nan, -1.0, -1.0], [-9.0, -1.0, -1.0, -1.0]])
    assert evaluations_to_reach(traces, np.full(2, -1.0), is_paired=True) == Interval(3.0, 2.0, 3.0)


def test_one_trace_has_a_count_and_no_interval():
    interval = evaluations_to_reach(TRACES[:1], np.array([3.5]), is_paired=False)
    assert interval.value == 3.0
    assert np.isnan(ends(interval)).all()


def test_rounding_does_not_hide_that_a_target_is_reached():
    assert first_reaching(np.array([[0.1 + 0.2]]), np.array([0.3])).tolist() == [1.0]
    assert first_reaching(np.array([[0.3]]), np.array([0.1 + 0.2])).tolist() == [1.0]
    assert first_reaching(np.array([[-0.3 - 1e-9]]), np.array([-0.3])).tolist() == [math.inf]


def test_infinite_target_is_reached_by_infinity():
    assert first_reaching(np.array([[1.0, math.inf]]), np.array([math.inf])).tolist() == [2.0]


@PAIRING
def test_same_runs_always_give_the_same_interval(is_paired):
    before = SAMPLE.copy()
    first, second = (ratio_of_means(*SAMPLE, is_paired=is_paired) for _ in range(2))
    assert first == second
    np.testing.assert_array_equal(SAMPLE, before)
    traces = SAMPLE.cumsum(axis=1)
    counts = [evaluations_to_reach(traces, traces[:, 20], is_paired=is_paired) for _ in range(2)]
    assert counts[0] == counts[1]
