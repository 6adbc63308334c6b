"""Tests for tails.py."""

import numpy as np
import pytest

from hypermap_lite.surrogates.tails import Tail, compress, likely_tail, slopes

TAILS = [Tail(limit=2.0, spread=0.5, highest=1e6), Tail(limit=2.0, spread=0.5, highest=1e6, is_double=True)]
Y = np.array([-3.0, 1.0, 2.0, 2.1, 7.0, 1e6])


@pytest.mark.parametrize("tail", TAILS)
def test_what_is_below_the_limit_stays_and_the_order_of_all(tail: Tail) -> None:
    z = tail.compress(Y)
    assert np.array_equal(z[:3], Y[:3])
    assert (np.diff(z) > 0).all()
    assert z[-1] < 2 + 0.5 * 15


@pytest.mark.parametrize("tail", TAILS)
def test_stretching_undoes_it(tail: Tail) -> None:
    assert tail.stretch(tail.compress(Y)) == pytest.approx(Y, rel=1e-9)


@pytest.mark.parametrize("tail", TAILS)
@pytest.mark.parametrize("z", [20.0, 1e9, 1e300])
def test_nothing_stands_for_more_than_a_few_times_the_largest_value(tail: Tail, z: float) -> None:
    assert tail.stretch(np.array([z]))[0] == pytest.approx(3e6, rel=1e-5)


@pytest.mark.parametrize("tail", TAILS)
def test_slope_is_the_derivative(tail: Tail) -> None:
    y, h = np.array([0.0, 2.5, 40.0, 1e5]), 1e-5
    numeric = (tail.compress(y + h) - tail.compress(y - h)) / (2 * h)
    assert np.exp(tail.log_slope(y)) == pytest.approx(numeric, rel=1e-4)


def test_objectives_without_a_tail_are_untouched() -> None:
    both = np.column_stack([Y, Y])
    assert compress(both, (None, None)) is both
    compressed = compress(both, (None, TAILS[0]))
    assert np.array_equal(compressed, np.column_stack([Y, TAILS[0].compress(Y)]))
    assert np.array_equal(slopes(both, (None, TAILS[0])), np.column_stack([np.ones(6), np.exp(TAILS[0].log_slope(Y))]))


def test_values_that_are_the_same_once_compressed_count_once() -> None:
    assert np.array_equal(TAILS[0].distinct(np.array([1e6, 0.5, 1e6, 0.4, 1e6 + 2, 2e5])), [0.4, 0.5, 2e5, 1e6])


def test_normal_outputs_have_none() -> None:
    found = [likely_tail(np.random.default_rng(seed).normal(size=40), -np.inf) for seed in range(20)]
    assert sum(tail is None for tail in found) >= 15


@pytest.mark.parametrize("spread", [0.0, 0.01])
def test_limit_is_below_the_gap_before_penalties_even_if_most_values_are_penalties(spread: float) -> None:
    y = np.r_[0.3, 0.5, 0.9, 0.7, 1e5 + spread * np.arange(20)]
    tail = likely_tail(y, -np.inf)
    assert tail is not None
    assert (tail.limit, tail.spread) == (0.9, pytest.approx(0.6))


@pytest.mark.parametrize("penalty", [10.0, 1e5, 1e12, 1e30, 1e150])
def test_a_penalty_may_be_of_any_size(penalty: float) -> None:
    tail = likely_tail(np.r_[0.3, 0.5, 0.9, 0.7, np.full(20, penalty)], -np.inf)
    assert tail is not None
    assert tail.limit == 0.9
    assert np.isfinite(tail.compress(np.array([penalty]))).all()


def test_two_values_that_happen_to_be_close_are_not_all_that_counts() -> None:
    y = np.r_[-3.3, -3.29999, np.linspace(-3, 1, 30)]
    tail = likely_tail(y, -np.inf)
    assert tail is None or tail.limit > -2


def test_limit_is_at_least_what_counts() -> None:
    y = np.r_[np.linspace(0.1, 1.0, 10), 1e3, 2e4, 3e5]
    tail = likely_tail(y, 50.0)
    assert tail is not None
    assert tail.limit == 50.0
    assert likely_tail(y, 3e5) is None


@pytest.mark.parametrize("y", [np.ones(5), np.array([1.0, 1.0, 1.0, 2.0]), np.array([1.0, 2.0])])
def test_too_few_different_values_have_none(y) -> None:
    assert likely_tail(y, -np.inf) is None


def test_it_does_not_depend_on_units() -> None:
    y = np.r_[np.random.default_rng(0).random(20), 50 + 1e4 * np.random.default_rng(1).random(6)]
    here, there = likely_tail(y, -np.inf), likely_tail(1e150 / 1e5 * y, -np.inf)
    assert here is not None
    assert there is not None
    assert there.limit / 1e145 == pytest.approx(here.limit)
    assert there.is_double == here.is_double
