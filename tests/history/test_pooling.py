"""Tests for pooling.py."""

import math

import numpy as np
import pytest

from hypermap_lite.evaluation.aggregation import mean, standard_error
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.history.pooling import confirmed_groups, groups_of, key_of, pool, pooled


def row(trial, x, values=None, *, phase="model", state=State.COMPLETED, **options):
    suggestion = Suggestion(trial=trial, configuration={"x": x}, phase=phase)
    return Evaluation(suggestion=suggestion, state=state, values=values or {}, **options)


def sampled(trial, x, sample, **options):
    """Return the row that these replicates of one objective make."""
    errors = {"f": standard_error(sample)}
    return row(trial, x, {"f": mean(sample)}, standard_errors=errors, replicates=len(sample), **options)


@pytest.mark.parametrize(
    "parts",
    [
        pytest.param([[1.0, 4.0, 2.0], [7.0, 3.0]], id="two samples"),
        pytest.param([[1.0, 4.0], [5.0]], id="a single replicate among them"),
        pytest.param([[1.0], [2.0], [6.0]], id="single replicates only"),
    ],
)
def test_pooled_samples_are_the_joint_sample(parts):
    everything = [value for part in parts for value in part]
    found, error, n = pool(
        np.array([[mean(part)] for part in parts]),
        np.array([[standard_error(part)] for part in parts]),
        [len(part) for part in parts],
    )
    assert n == len(everything)
    assert found[0] == pytest.approx(mean(everything))
    assert error[0] == pytest.approx(standard_error(everything))


def test_unknown_spread_is_estimated_from_what_is_known():
    # Two known rows of two replicates with variances 2 and 2; the third, of unknown spread, lies at their mean.
    found, error, n = pool(np.array([[0.0], [0.0], [0.0]]), np.array([[1.0], [1.0], [math.nan]]), [2, 2, 4])
    assert (found[0], n) == (0.0, 8)
    assert error[0] == pytest.approx(math.sqrt(4.0 / 4 / 8))  # squares 4, freedom 2 within and 2 between


def test_spread_of_one_replicate_is_not_known():
    _, error, _ = pool(np.array([[3.0]]), np.array([[math.nan]]), [1])
    assert math.isnan(error[0])


def test_configurations_are_equal_in_any_order_of_their_parameters():
    assert key_of({"a": 1, "b": "x"}) == key_of({"b": "x", "a": 1.0})
    assert key_of({"a": 1, "b": "x"}) != key_of({"a": 1, "b": "y"})


def test_only_confirmed_configurations_are_grouped():
    assert groups_of("aba") == [[0, 2], [1]]
    assert confirmed_groups("aba", ["design", "design", "model"]) == [[0], [1], [2]]
    assert confirmed_groups("abab", ["design", "design", "confirm", "model"]) == [[0, 2], [1], [3]]


def test_confirmed_configuration_has_the_mean_of_all_its_replicates():
    rows = [
        sampled(0, 0.5, [9.0, 10.0], phase="design", seconds=1.0),
        sampled(1, 0.7, [1.0]),
        sampled(2, 0.5, [3.0, 4.0, 5.0], phase="confirm", seconds=2.0),
    ]
    first, second = pooled(rows)
    assert (first.trial, first.suggestion.phase, first.replicates, first.seconds) == (0, "design", 5, 3.0)
    assert first.values["f"] == pytest.approx(6.2)
    assert first.standard_errors["f"] == pytest.approx(standard_error([9.0, 10.0, 3.0, 4.0, 5.0]))
    assert second is rows[1]


@pytest.mark.parametrize("state", [State.FAILED, State.TIMEOUT, State.INFEASIBLE])
def test_confirmation_that_does_not_complete_takes_the_configuration_away(state):
    rows = [sampled(0, 0.5, [1.0]), row(1, 0.5, phase="confirm", state=state)]
    (only,) = pooled(rows)
    assert only.state is state


def test_rows_without_a_confirmation_are_left_as_they_are():
    rows = [sampled(0, 0.5, [1.0], phase="earlier"), sampled(1, 0.5, [2.0], phase="earlier")]
    assert pooled(rows) == rows
