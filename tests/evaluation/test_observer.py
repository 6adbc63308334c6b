"""Tests for observer.py."""

from dataclasses import replace

from hypermap_lite.evaluation.observer import FrontTracker, describe
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.objectives import Goal, Objective

TWO = (Objective(name="f"), Objective(name="g", goal=Goal.MAXIMIZE))


def row(**values):
    suggestion = Suggestion(trial=12, configuration={"x": 1.0}, phase="model")
    return Evaluation(suggestion=suggestion, state=State.COMPLETED, values=values, seconds=3.21)


def test_tracker_counts_who_joins_and_who_leaves_the_front():
    tracker = FrontTracker(TWO)
    rows = [row(f=1, g=1), row(f=2, g=2), row(f=3, g=1), row(f=0, g=3), row(f=0, g=3)]
    assert [tracker.add(r) for r in rows] == ["front +1", "front +1", "", "front +1 -2", "front +1"]
    assert tracker.size == 2


def test_tracker_of_one_objective_reports_the_best():
    tracker = FrontTracker(TWO[:1])
    assert [tracker.add(row(f=f)) for f in (2, 3, 1, 1)] == ["best", "", "best", ""]


def test_failure_does_nothing_to_the_front():
    assert FrontTracker(TWO).add(replace(row(), state=State.FAILED)) == ""


def test_line_tells_the_trial_in_short():
    assert describe(row(f=1.23456, g=-2), "front +1") == "trial 12 model completed 3.2 s f=1.235, g=-2, front +1"


def test_line_of_a_failure_tells_its_reason():
    failed = replace(row(), state=State.FAILED, error="it broke")
    assert describe(failed, "") == "trial 12 model failed 3.2 s it broke"


def test_confirmed_configuration_counts_by_its_mean():
    tracker = FrontTracker(TWO)
    again = replace(row(f=8, g=3), suggestion=Suggestion(trial=1, configuration={"x": 1.0}, phase="confirm"))
    other = Suggestion(trial=13, configuration={"x": 2.0}, phase="model")
    rows = [row(f=0, g=3), replace(row(f=1, g=3), suggestion=other), again]
    assert [tracker.add(r) for r in rows] == ["front +1", "", "front of 1"]
    assert tracker._front.tolist() == [[1, -3]]  # (0 + 8) / 2 is dominated now
