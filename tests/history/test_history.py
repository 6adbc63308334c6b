"""The record of a run in memory."""

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.space import RealParameter, SearchSpace

SPACE = SearchSpace((RealParameter(name="x", low=0, high=2),))
OBJECTIVES = (Objective(name="cost"), Objective(name="speed", goal=Goal.MAXIMIZE))


def row(trial: int, state: State = State.COMPLETED) -> Evaluation:
    values = {"cost": float(trial), "speed": 10.0 * trial} if state is State.COMPLETED else {}
    return Evaluation(
        suggestion=Suggestion(trial=trial, configuration={"x": 0.5 * trial}, phase="design"), state=state, values=values
    )


def test_only_completed_evaluations_have_values_which_are_minimized() -> None:
    history = History(SPACE, OBJECTIVES)
    history.extend([row(0), row(1, State.FAILED), row(2)])
    assert history.X().tolist() == [[0.0], [0.5]]
    assert history.Y().tolist() == [[0.0, 0.0], [2.0, -20.0]]
    assert history.X_all().shape == (3, 1)


def test_an_empty_history_has_the_right_shapes() -> None:
    history = History(SPACE, OBJECTIVES)
    assert history.X().shape == (0, 1)
    assert history.Y().shape == (0, 2)
    assert np.array_equal(history.X_all(), np.empty((0, 1)))


def test_trials_come_in_order() -> None:
    history = History(SPACE, OBJECTIVES)
    with pytest.raises(UsageError, match="trial 1 cannot be recorded: the next trial is 0"):
        history.append(row(1))
