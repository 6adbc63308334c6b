"""Tests for batch_results.py."""

import numpy as np
import pandas as pd
import pytest

from hypermap_lite.evaluation.batch_results import outcomes_of
from hypermap_lite.evaluation.outcome import State

TWO = ("f", "g")
EXPECTED = [{"f": 1.0, "g": 2.0}, {"f": 3.0, "g": 4.0}, {"f": 5.0, "g": 6.0}]
COLUMNS = {"f": [1, 3, 5], "g": [2, 4, 6]}


@pytest.mark.parametrize(
    "result",
    [
        pytest.param([{"f": 1, "g": 2}, {"f": 3, "g": 4}, {"f": 5, "g": 6}], id="list of mappings"),
        pytest.param([(1, 2), [3, 4], np.array([5, 6])], id="list of sequences"),
        pytest.param(np.array([[1, 2], [3, 4], [5, 6]]), id="array"),
        pytest.param(COLUMNS, id="mapping of lists"),
        pytest.param({name: np.array(column) for name, column in COLUMNS.items()}, id="mapping of arrays"),
        pytest.param({name: pd.Series(column, index=[7, 8, 9]) for name, column in COLUMNS.items()}, id="of series"),
        pytest.param(pd.DataFrame(COLUMNS, index=[7, 8, 9]), id="data frame"),
    ],
)
def test_every_form_gives_an_outcome_per_configuration(result):
    outcomes = outcomes_of(result, TWO, 3)
    assert [o.values for o in outcomes] == EXPECTED


@pytest.mark.parametrize(
    "result", [[1, 2.0], (1, 2), np.array([1, 2]), pd.Series([1, 2], index=[4, 5]), {"f": [1, 2]}, [{"f": 1}, (2,)]]
)
def test_one_objective_may_be_a_list_of_numbers(result):
    assert [o.values for o in outcomes_of(result, ("f",), 2)] == [{"f": 1.0}, {"f": 2.0}]


@pytest.mark.parametrize(
    ("result", "reason"),
    [
        ([{"f": 1}], "the function returned 1 results for 2 configurations"),
        ({"f": [1, 2, 3]}, "'f' holds 3 values for 2 configurations"),
        ({"f": 1.0}, "'f' is 1.0; expected a list of 2 values"),
        ({"f": [1, 2], "feasible": [True]}, "'feasible' holds 1 values for 2 configurations"),
        (None, "the result for 2 configurations is None; expected a list with an item per configuration, or"),
        (3.0, "the result for 2 configurations is 3.0; expected a list"),
        ("12", "the result for 2 configurations is '12'; expected a list"),
    ],
)
def test_result_that_does_not_fit_fails_every_configuration(result, reason):
    outcomes = outcomes_of(result, ("f",), 2)
    assert [o.state for o in outcomes] == [State.FAILED] * 2
    assert all(o.error.startswith(reason) for o in outcomes)


def test_one_bad_item_fails_alone():
    good, nan, none, text = outcomes_of([1.0, float("nan"), None, "x"], ("f",), 4)
    assert (good.state, nan.state, none.state, text.state) == (State.COMPLETED, *[State.FAILED] * 3)
    assert nan.error == "'f' is nan, not a finite number"


def test_extra_numbers_become_metrics_and_a_single_one_is_everybodys():
    outcomes = outcomes_of({"f": [1, 2], "steps": [10, 20], "version": 3, "note": "hm"}, ("f",), 2)
    assert [o.metrics for o in outcomes] == [{"steps": 10.0, "version": 3.0}, {"steps": 20.0, "version": 3.0}]


def test_infeasible_items_are_told_apart():
    outcomes = outcomes_of({"f": [1, 2], "feasible": np.array([True, False])}, ("f",), 2)
    assert [o.state for o in outcomes] == [State.COMPLETED, State.INFEASIBLE]
