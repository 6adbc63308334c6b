"""Tests for aggregation.py."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.evaluation.aggregation import mean, standard_error, summarize
from hypermap_lite.evaluation.outcome import Outcome, State, Suggestion
from tests.evaluation.examples import replicate

SUGGESTION = Suggestion(trial=0, configuration={"x": 0.5}, phase="design")
FAILED = replicate(1, State.FAILED, "broken arm")
LATE = replicate(2, State.TIMEOUT, "too slow")
INFEASIBLE = replicate(3, State.INFEASIBLE, "not allowed")


def test_replicates_are_averaged_with_their_standard_error():
    row = summarize(SUGGESTION, [replicate(i, f=v) for i, v in enumerate((1.0, 2.0, 6.0))], 77)
    assert row.values == {"f": 3.0}
    assert row.standard_errors["f"] == pytest.approx(math.sqrt(7 / 3))
    assert (row.replicates, row.seconds, row.timestamp, row.error) == (3, 1.5, 77, "")


def test_one_replicate_has_no_standard_error():
    assert math.isnan(summarize(SUGGESTION, [replicate(f=1.0)]).standard_errors["f"])


@pytest.mark.parametrize(
    ("calls", "state", "error"),
    [
        ([FAILED], State.FAILED, "broken arm"),
        ([replicate(f=1.0), FAILED, LATE, INFEASIBLE], State.FAILED, "1 of 4 replicates failed: broken arm"),
        ([LATE, replicate(f=1.0)], State.TIMEOUT, "1 of 2 replicates ran past the time limit: too slow"),
        ([INFEASIBLE, INFEASIBLE], State.INFEASIBLE, "2 of 2 replicates were infeasible: not allowed"),
    ],
)
def test_worst_state_among_the_replicates_counts(calls, state, error):
    row = summarize(SUGGESTION, calls)
    assert (row.state, row.error, row.values, row.standard_errors) == (state, error, {}, {})


def test_configuration_with_one_infeasible_replicate_is_infeasible_and_keeps_the_means_of_what_was_measured():
    measured = Outcome(state=State.INFEASIBLE, values={"f": 4.0}, error="not allowed")
    calls = [replicate(0, f=1.0, g=3.0), replace(replicate(1), outcome=measured), INFEASIBLE]
    row = summarize(SUGGESTION, calls)
    assert (row.state, row.error) == (State.INFEASIBLE, "2 of 3 replicates were infeasible: not allowed")
    assert row.values == {"f": 2.5, "g": 3.0}
    assert row.standard_errors["f"] == pytest.approx(1.5)
    assert math.isnan(row.standard_errors["g"])


@given(st.permutations([0.1, 0.2, 0.3, 1e16, -1e16, 3.3]))
def test_order_of_arrival_does_not_matter(values):
    assert mean(values) == mean(sorted(values))


def test_huge_values_keep_a_finite_mean():
    assert mean([1.7e308, 1.7e308]) == pytest.approx(1.7e308)


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=9))
def test_standard_error_is_that_of_numpy(values):
    expected = np.std(values, ddof=1) / math.sqrt(len(values))
    assert standard_error(values) == pytest.approx(expected, rel=1e-9, abs=1e-9)
