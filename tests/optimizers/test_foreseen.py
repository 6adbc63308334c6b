"""Tests for foreseen.py."""

import numpy as np
import pytest

from hypermap_lite.assembly import build_history
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers.foreseen import SPREAD_POINTS, foreseen_reference_point, spread_points
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates.base import Prediction
from tests.optimizers.runs import scenario_of


class Line:
    """Knows two objectives, a and 1 - a, with the same doubt everywhere."""

    def __init__(self, std: float) -> None:
        self.std = std

    def predict(self, X):
        mean = np.column_stack([X[:, 0], 1 - X[:, 0]])
        return Prediction(mean=mean, std=np.full_like(mean, self.std))


class Left:
    """Takes the points with a below a half for feasible."""

    def log_probability(self, X):
        return np.where(X[:, 0] < 0.5, np.log(0.9), np.log(0.1))


def history_of(*places: float, **changes):
    history = build_history(load_scenario(scenario_of(objectives=[{"name": "f"}, {"name": "g"}], **changes)))
    for trial, a in enumerate(places):
        suggestion = Suggestion(trial=trial, configuration={"a": a, "b": 0.0}, phase="design")
        history.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"f": a, "g": 1 - a}))
    return history


def reference_point(std: float, feasibility=None, **changes):
    history = history_of(0.4, 0.6, **changes)
    return foreseen_reference_point(Line(std), feasibility, history, np.random.default_rng(0))  # type: ignore[arg-type]


def test_spread_points_are_where_known_constraints_allow() -> None:
    space = history_of(constraints=["a <= 0.5"]).space
    X = spread_points(space, np.random.default_rng(0))
    assert X.shape == (SPREAD_POINTS, 2)
    assert space.is_allowed(X).all()
    assert X.min() < 0.01
    assert X[:, 1].max() > 0.99


def test_ends_of_the_front_that_are_foreseen_count() -> None:
    assert reference_point(0.001) == pytest.approx(1.1, abs=0.01)


def test_ends_that_are_doubtful_do_not() -> None:
    assert reference_point(0.1) == pytest.approx(0.6 + 0.02)


def test_nor_do_those_that_are_hardly_feasible() -> None:
    assert reference_point(0.001, Left()) == pytest.approx([0.6 + 0.06, 1.06], abs=0.01)


def test_what_is_stated_stays() -> None:
    objectives = [{"name": "f", "reference_point": 5.0}, {"name": "g"}]
    history = build_history(load_scenario(scenario_of(objectives=objectives)))
    history.extend(list(history_of(0.4, 0.6)))
    found = foreseen_reference_point(Line(0.001), None, history, np.random.default_rng(0))  # type: ignore[arg-type]
    assert found == pytest.approx([5.0, 1.1], abs=0.01)
