"""Tests for evaluator.py."""

import collections
import math
import os

import numpy as np
import pandas as pd
import pytest

from hypermap_lite.errors import EvaluationError, ScenarioError
from hypermap_lite.evaluation.evaluator import as_number, call, failure, outcome_of
from hypermap_lite.evaluation.outcome import Outcome, State
from hypermap_lite.objectives import FeasibleOutput
from tests.evaluation.examples import request


def raising(error):
    def evaluate(request):
        raise error

    return evaluate


def test_mapping_gives_objectives_and_metrics():
    outcome = outcome_of({"g": 2, "f": np.float32(0.5), "speed": True, "note": "x", "bad": math.nan}, ["f", "g"])
    assert outcome == Outcome(state=State.COMPLETED, values={"f": 0.5, "g": 2.0}, metrics={"speed": 1.0})


@pytest.mark.parametrize("result", [(1.0, 2), [1.0, 2.0], np.array([1.0, 2.0])], ids=["tuple", "list", "array"])
def test_sequence_gives_objectives_in_order(result):
    assert outcome_of(result, ["f", "g"]).values == {"f": 1.0, "g": 2.0}


Point = collections.namedtuple("Point", ["g", "f"])


@pytest.mark.parametrize(
    "result", [pd.Series([2.0, 1.0], index=["g", "f"]), Point(g=2.0, f=1.0)], ids=["series", "named tuple"]
)
def test_names_of_a_result_go_before_its_order(result):
    assert outcome_of(result, ["f", "g"]).values == {"f": 1.0, "g": 2.0}


@pytest.mark.parametrize("result", [{1.0, 2.0}, {"f": 1.0, "g": 2.0}.values(), b"12"], ids=["set", "values", "bytes"])
def test_collection_without_a_firm_order_is_a_failure(result):
    outcome = outcome_of(result, ["f", "g"])
    assert outcome.state is State.FAILED
    assert "expected a mapping with 'f', 'g'" in outcome.error


def test_series_of_one_value_with_another_name_is_not_the_objective():
    assert "has no 'f' (it has: g)" in outcome_of(pd.Series({"g": 1.0}), ["f"]).error


@pytest.mark.parametrize("result", [3, 3.0, np.float64(3), np.array(3.0), np.array([3.0]), [3.0]])
def test_number_is_enough_for_one_objective(result):
    assert outcome_of(result, ["f"]).values == {"f": 3.0}


@pytest.mark.parametrize(
    ("result", "reason"),
    [
        pytest.param({"f": 1.0}, "the result has no 'g' (it has: f)", id="missing"),
        pytest.param({}, "the result has no 'f' (it has: nothing)", id="empty"),
        pytest.param({"f": math.nan, "g": 1.0}, "'f' is nan, not a finite number", id="nan"),
        pytest.param({"f": 1.0, "g": -math.inf}, "'g' is -inf, not a finite number", id="infinite"),
        pytest.param({"f": "1.0", "g": 1.0}, "'f' is '1.0', not a finite number", id="text"),
        pytest.param({"f": 1.0, "g": None}, "'g' is None, not a finite number", id="none in it"),
        pytest.param({"f": 10**400, "g": 1.0}, "not a finite number", id="huge integer"),
        pytest.param(None, "the result is None; expected a mapping with 'f', 'g'", id="nothing"),
        pytest.param("1,2", "the result is '1,2'; expected a mapping", id="string"),
        pytest.param(1.0, "the result is 1.0; expected a mapping", id="one number for two"),
        pytest.param([1.0, 2.0, 3.0], "the result has 3 numbers for 2 objectives", id="too many"),
        pytest.param([1.0, math.nan], "'g' is nan", id="nan in a list"),
    ],
)
def test_unusable_result_is_a_failure_with_its_reason(result, reason):
    outcome = outcome_of(result, ["f", "g"])
    assert outcome.state is State.FAILED
    assert outcome.values == {}
    assert reason in outcome.error


@pytest.mark.parametrize("no", [False, 0, np.False_])
def test_result_may_say_that_the_configuration_is_not_allowed(no):
    outcome = outcome_of({"feasible": no, "depth": 2.0}, ["f"])
    assert (outcome.state, outcome.metrics) == (State.INFEASIBLE, {"depth": 2.0})


@pytest.mark.parametrize("answer", ["false", "no", None, 0.5, math.nan, 2, []])
def test_feasible_is_true_or_false_and_nothing_else(answer):
    outcome = outcome_of({"feasible": answer, "f": 1.0}, ["f"])
    assert outcome.state is State.FAILED
    assert outcome.error == f"'feasible' is {answer!r}, neither true nor false"


@pytest.mark.parametrize("yes", [True, 1, np.True_, 1.0])
def test_feasible_result_is_complete(yes):
    assert outcome_of({"feasible": yes, "f": 1.0}, ["f"]).state is State.COMPLETED


VALID = FeasibleOutput(true_value="yes", false_value="1")


@pytest.mark.parametrize("answer", [True, np.True_, 1, 1.0, "yes"])
def test_feasible_output_says_yes_by_truth_or_text(answer):
    outcome = outcome_of({"f": 1.0, "Valid": answer}, ["f"], VALID)
    assert outcome == Outcome(state=State.COMPLETED, values={"f": 1.0})


@pytest.mark.parametrize("answer", [False, np.False_, 0, 0.0, "1"])
def test_feasible_output_says_no_and_the_finite_objectives_are_kept(answer):
    outcome = outcome_of({"f": 1.0, "g": math.nan, "h": "?", "t": 7, "Valid": answer}, ["f", "g", "h"], VALID)
    assert (outcome.state, outcome.values, outcome.metrics) == (State.INFEASIBLE, {"f": 1.0}, {"t": 7.0})


@pytest.mark.parametrize("answer", ["Yes", " yes", "True", "", None, 2, 0.5, math.nan])
def test_feasible_output_that_is_neither_text_is_a_failure(answer):
    outcome = outcome_of({"f": 1.0, "Valid": answer}, ["f"], VALID)
    assert outcome.state is State.FAILED
    assert outcome.error == f"'Valid' is {answer!r}, neither true nor false, nor 'yes' or '1'"


def test_feasible_output_must_be_answered():
    outcome = outcome_of({"f": 1.0, "feasible": True}, ["f"], VALID)
    assert (outcome.state, outcome.error) == (State.FAILED, "the result has no 'Valid' (it has: f, feasible)")


def test_feasible_output_comes_last_in_a_list():
    assert outcome_of([1.0, 2.0, True], ["f", "g"], VALID).values == {"f": 1.0, "g": 2.0}
    outcome = outcome_of([1.0, 2.0], ["f", "g"], VALID)
    assert "the result has 2 numbers for 2 objectives and 'Valid'" in outcome.error


def test_texts_for_yes_and_no_must_differ():
    with pytest.raises(ScenarioError, match=r"\$\.false_value: feasible and infeasible are both called 'a'"):
        FeasibleOutput(true_value="a", false_value="a")


def test_infeasible_result_keeps_its_objectives_without_a_column_for_it_too():
    assert outcome_of({"f": 1.0, "feasible": False}, ["f"]).values == {"f": 1.0}


def test_objective_may_be_called_feasible():
    assert outcome_of({"feasible": 0.5}, ["feasible"]).values == {"feasible": 0.5}


def test_feasible_result_needs_its_objectives_and_keeps_no_such_metric():
    assert outcome_of({"feasible": True, "f": 1.0}, ["f"]) == Outcome(state=State.COMPLETED, values={"f": 1.0})


def test_failure_keeps_the_numbers_that_explain_it():
    assert outcome_of({"f": math.nan, "steps": 7}, ["f"]).metrics == {"steps": 7.0}


def test_array_of_several_numbers_is_no_number():
    assert as_number(np.array([1.0, 2.0])) is None


def test_exception_becomes_a_failure_and_its_traceback_a_file(tmp_path):
    record = call(raising(ValueError("bad\n  luck")), request(tmp_path))
    assert (record.outcome.state, record.outcome.error) == (State.FAILED, "ValueError: bad luck")
    assert "Traceback" in (tmp_path / "0000" / "replicate_0.traceback.log").read_text()
    assert record.seconds >= 0


def test_known_failure_needs_no_traceback(tmp_path):
    record = call(raising(EvaluationError("out of reach")), request(tmp_path))
    assert record.outcome.error == "out of reach"
    assert not (tmp_path / "0000").exists()


def test_exit_of_the_black_box_does_not_end_the_run(tmp_path):
    assert call(raising(SystemExit(2)), request(tmp_path)).outcome.error == "SystemExit: 2"


def test_interrupt_is_not_a_failure(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        call(raising(KeyboardInterrupt()), request(tmp_path))


def test_folder_that_cannot_be_written_does_not_hide_the_failure(tmp_path):
    (tmp_path / "0000").write_text("a file in the way")
    assert call(raising(ValueError()), request(tmp_path)).outcome.error == "ValueError"


def test_long_reason_is_cut():
    assert len(failure("x" * 1000).error) == 300


@pytest.mark.parametrize("error", [KeyboardInterrupt("why"), GeneratorExit("why"), BaseException("why")])
def test_worker_counts_whatever_is_raised_as_a_failure(tmp_path, error):
    outcome = call(raising(error), request(tmp_path), caught=(BaseException,)).outcome
    assert (outcome.state, outcome.error) == (State.FAILED, f"{type(error).__name__}: why")


@pytest.mark.parametrize("kind", [ValueError, EvaluationError])
def test_exception_whose_message_cannot_be_shown_is_a_failure(tmp_path, kind):
    class Mute(kind):
        def __str__(self):
            raise KeyboardInterrupt

    outcome = call(raising(Mute()), request(tmp_path)).outcome
    assert "an exception whose message cannot be shown" in outcome.error


def test_forked_child_does_not_come_back_from_the_call(tmp_path):
    parent = os.getpid()

    def fork_and_fall_through(request):
        if os.fork() == 0:
            raise SystemExit(7)
        _, status = os.wait()
        return Outcome(state=State.COMPLETED, values={"f": float(os.waitstatus_to_exitcode(status))})

    outcome = call(fork_and_fall_through, request(tmp_path)).outcome
    if os.getpid() != parent:  # before the fix: leave the test session to the parent
        os._exit(1)
    assert outcome.values == {"f": 0.0}


def test_reason_is_one_line_of_printable_text():
    shown = failure("\x1b[1;31mred\x1b[0m\x00 \x1b]0;title\x07and\u2028new\u202e line\x9b2J").error
    assert shown == r"red\x00 and new\u202e line\x9b2J"
    assert shown.isprintable()
