"""Tests for feasibility_weighted.py."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from hypermap_lite.acquisition.feasibility_weighted import (
    FeasibilitySearch,
    FeasibilityWeighted,
    LogImprovement,
    optimistic_ideal,
)
from hypermap_lite.surrogates.base import Prediction
from hypermap_lite.surrogates.feasibility import ProbitProcess
from hypermap_lite.typing import FloatArray

X = np.random.default_rng(0).random((25, 2))
POSTERIOR = ProbitProcess().fit(X, X[:, 0] < 0.5, is_ordered=np.ones(2, dtype=bool))
POINTS = np.random.default_rng(1).random((9, 2))


@dataclass(frozen=True)
class Slope:
    """A score that rises along the first axis, where points get infeasible: 0 at best within the feasible half."""

    is_differentiable: bool = True

    def __call__(self, X: FloatArray) -> FloatArray:
        return X[:, 0] - 0.5

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self(X), np.tile([1.0, 0.0], (len(X), 1))


@pytest.mark.parametrize(
    "scorer",
    [
        LogImprovement(inner=Slope(), incumbent=-0.1),
        FeasibilityWeighted(inner=LogImprovement(inner=Slope(), incumbent=-0.1), feasibility=POSTERIOR),
        FeasibilitySearch(feasibility=POSTERIOR),
    ],
    ids=lambda scorer: type(scorer).__name__,
)
def test_gradients_are_those_of_finite_differences(scorer) -> None:
    value, gradient = scorer.with_gradient(POINTS)
    np.testing.assert_allclose(value, scorer(POINTS), rtol=1e-12)
    for j in range(2):
        step = 1e-6 * np.eye(2)[j]
        numeric = (scorer(POINTS + step) - scorer(POINTS - step)) / 2e-6
        np.testing.assert_allclose(gradient[:, j], numeric, rtol=1e-4, atol=1e-5)


def test_weighted_score_is_the_log_of_a_product() -> None:
    scorer = FeasibilityWeighted(inner=Slope(), feasibility=POSTERIOR)
    expected = np.exp(Slope()(POINTS)) * np.exp(POSTERIOR.log_probability(POINTS))
    np.testing.assert_allclose(np.exp(scorer(POINTS)), expected)


def test_improvement_is_positive_rises_with_the_score_and_counts_from_the_best_feasible_point() -> None:
    scorer = LogImprovement.over(Slope(), np.array([[0.3, 0.0], [0.45, 0.0]]))
    assert scorer.incumbent == pytest.approx(-0.05)
    values = scorer(np.array([[0.0, 0.0], [0.45, 0.0], [0.95, 0.0]]))
    assert np.all(np.diff(values) > 0)
    assert np.exp(values[2]) == pytest.approx(0.5, rel=1e-6)


def test_a_bound_times_the_probability_does_not_reward_the_infeasible() -> None:
    line = np.column_stack([np.linspace(0, 1, 201), np.full(201, 0.5)])
    scores = -np.abs(line[:, 0] - 0.4) - 0.77  # minus a positive bound, best at 0.4
    p = np.exp(POSTERIOR.log_probability(line))
    assert p[np.argmax(scores * p)] < 0.1  # the fault: the least of the products of positive bounds and probabilities

    @dataclass(frozen=True)
    class Bound(Slope):
        def __call__(self, X: FloatArray) -> FloatArray:
            return -np.abs(X[:, 0] - 0.4) - 0.77

    weighted = FeasibilityWeighted(inner=LogImprovement.over(Bound(), line[:40]), feasibility=POSTERIOR)
    best = int(np.argmax(weighted(line)))
    assert p[best] > 0.5
    assert line[best, 0] == pytest.approx(0.4, abs=0.05)


def test_the_ideal_is_sought_among_the_probably_feasible_points_only() -> None:
    class Known:
        def predict(self, X: FloatArray) -> Prediction:
            return Prediction(mean=np.column_stack([1 - X[:, 0], X[:, 0]]), std=np.full((len(X), 2), 0.25))

    points = np.column_stack([np.array([0.1, 0.3, 0.9]), np.full(3, 0.5)])
    np.testing.assert_allclose(optimistic_ideal(Known(), POSTERIOR, points), [0.45, -0.15])
    assert np.isinf(optimistic_ideal(Known(), POSTERIOR, points[2:])).all()
