"""Tests for boundary_weighted.py."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from hypermap_lite.acquisition.base import rough_of
from hypermap_lite.acquisition.boundary_weighted import WIDTH, BoundaryWeighted, nearness
from hypermap_lite.typing import FloatArray

ALL = np.array([True, True])
FIRST = np.array([True, False])


@dataclass(frozen=True)
class Slope:
    """A score that rises along both axes."""

    is_differentiable: bool = True

    def __call__(self, X: FloatArray) -> FloatArray:
        return X.sum(axis=1)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self(X), np.ones_like(X)


@dataclass(frozen=True)
class WithRough(Slope):
    """The same, with an approximation."""

    def rough(self, X: FloatArray) -> FloatArray:
        return np.zeros(len(X))


@pytest.mark.parametrize(
    ("x", "axes", "expected"),
    [
        ([0.5, 0.5], ALL, 1.0),
        ([WIDTH, 1 - WIDTH], ALL, 1.0),
        ([0.0, 0.5], ALL, 0.3),
        ([0.5, 1.0], ALL, 0.3),
        ([0.0, 1.0], ALL, 0.09),
        ([0.0, 1.0], FIRST, 0.3),
        ([WIDTH / 2, 0.5], ALL, 1 - 0.7 / 4),
    ],
)
def test_each_bound_that_a_point_is_on_costs_the_factor(x, axes, expected) -> None:
    scorer = BoundaryWeighted(inner=Slope(), axes=axes, factor=0.3)
    assert np.exp(scorer.log_weight(np.array([x])))[0] == pytest.approx(expected)
    assert scorer(np.array([x]))[0] == pytest.approx(sum(x) + np.log(expected))


def test_nearness_falls_from_one_on_the_bound_to_nothing_at_the_width() -> None:
    x = np.linspace(0, 0.5, 51)
    along = nearness(np.column_stack([x, x]), FIRST)
    assert along[0, 0] == 1
    assert (np.diff(along[:, 0]) <= 0).all()
    assert along[x >= WIDTH, 0] == pytest.approx(0)
    assert not along[:, 1].any()


@pytest.mark.parametrize("axes", [ALL, FIRST], ids=["all", "first"])
def test_gradients_are_those_of_finite_differences(axes) -> None:
    scorer = BoundaryWeighted(inner=Slope(), axes=axes, factor=0.3)
    X = np.random.default_rng(0).random((40, 2)) * 0.998 + 0.001
    value, gradient = scorer.with_gradient(X)
    np.testing.assert_allclose(value, scorer(X), rtol=1e-12)
    for j in range(2):
        step = 1e-7 * np.eye(2)[j]
        np.testing.assert_allclose(gradient[:, j], (scorer(X + step) - scorer(X - step)) / 2e-7, rtol=1e-4, atol=1e-5)


def test_approximation_is_weighted_as_the_score_is() -> None:
    X = np.array([[0.0, 0.5], [0.5, 0.5]])
    rough = rough_of(BoundaryWeighted(inner=WithRough(), axes=ALL, factor=0.3))
    assert rough is not None
    np.testing.assert_allclose(rough(X), [np.log(0.3), 0.0])
    assert rough_of(BoundaryWeighted(inner=Slope(), axes=ALL, factor=0.3)) is None
