"""Tests for text_rows.py."""

import pytest

from hypermap_lite.evaluation.outcome import State
from hypermap_lite.evaluation.text_rows import outcome_of_texts
from hypermap_lite.objectives import FeasibleOutput

VALID = FeasibleOutput(name="ok", true_value="1", false_value="0")


def outcome(feasible=None, extras=(), **row):
    return outcome_of_texts(row, ("f", "g"), feasible, extras)


def test_numbers_are_values():
    assert outcome(f="1", g="-2.5e3").values == {"f": 1.0, "g": -2500.0}


@pytest.mark.parametrize("text", ["nan", "NaN", "inf", "-Infinity"])
def test_number_that_is_not_finite_is_a_failure(text):
    found = outcome(f=text, g="1")
    assert found.state is State.FAILED
    assert "not a finite number" in found.error


@pytest.mark.parametrize("text", ["", "abc", "1,5"])
def test_text_that_is_no_number_is_an_error(text):
    with pytest.raises(ValueError, match=r"'g' is .*, not a number"):
        outcome(f="1", g=text)


def test_feasible_row_has_values():
    assert outcome(VALID, f="1", g="2", ok="1").state is State.COMPLETED


def test_infeasible_row_keeps_the_values_it_has():
    whole, partly = outcome(VALID, f="1", g="2", ok="0"), outcome(VALID, f="1", g="", ok="0")
    assert (whole.state, whole.values) == (State.INFEASIBLE, {"f": 1.0, "g": 2.0})
    assert (partly.state, partly.values) == (State.INFEASIBLE, {"f": 1.0})
    assert outcome(VALID, f="1", g="nan", ok="0").values == {"f": 1.0}


@pytest.mark.parametrize("text", ["True", "", "0.0"])
def test_other_text_on_feasibility_is_an_error(text):
    with pytest.raises(ValueError, match=f"'ok' is '{text}', neither '1' nor '0'"):
        outcome(VALID, f="1", g="2", ok=text)


def test_extra_numbers_are_metrics_and_other_extras_nothing():
    found = outcome(None, ("time", "note", "bad"), f="1", g="2", time="3", note="hm", bad="nan", other="4")
    assert found.metrics == {"time": 3.0}


@pytest.mark.parametrize(
    ("text", "state"), [("false", State.INFEASIBLE), ("0", State.INFEASIBLE), ("True", State.COMPLETED)]
)
def test_extra_column_feasible_counts(text, state):
    row = {"f": "1", "g": "2", "feasible": text}
    assert outcome_of_texts(row, ("f", "g"), None, ("feasible",)).state is state
