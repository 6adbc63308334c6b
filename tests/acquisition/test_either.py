"""What is expected of two kinds of outcomes, added up."""

from dataclasses import dataclass

import numpy as np
import pytest

from hypermap_lite.acquisition.either import Either
from hypermap_lite.typing import FloatArray

X = np.random.default_rng(0).random((7, 2))


@dataclass
class Quadratic:
    """A score, or the log of nothing left of a place."""

    peak: float
    left: float = 0.0
    offset: float = 0.0
    is_differentiable: bool = True

    def __call__(self, X: FloatArray) -> FloatArray:
        score = self.offset - 3 * ((X - self.peak) ** 2).sum(axis=1)
        return np.where(X[:, 0] < self.left, -np.inf, score)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self(X), -6 * (X - self.peak)


@dataclass
class Screened(Quadratic):
    """Has a cheaper form."""

    def rough(self, X: FloatArray) -> FloatArray:
        return np.round(self(X), 1)


def test_utilities_are_added_up() -> None:
    a, b = Quadratic(0.2), Quadratic(0.9, offset=-1)
    assert np.exp(Either(a, b)(X)) == pytest.approx(np.exp(a(X)) + np.exp(b(X)))


def test_gradients_are_those_of_the_sum() -> None:
    either, step = Either(Quadratic(0.2), Quadratic(0.9, offset=-1)), 1e-6
    value, gradient = either.with_gradient(X)
    assert np.array_equal(value, either(X))
    for j in range(2):
        moved = X + step * np.eye(2)[j]
        assert (either(moved) - value) / step == pytest.approx(gradient[:, j], abs=1e-4)


def test_where_neither_promises_anything_nothing_is_promised() -> None:
    with np.errstate(all="raise"):
        value, gradient = Either(Quadratic(0.2, left=0.5), Quadratic(0.9, left=0.5)).with_gradient(X)
    assert np.array_equal(np.isneginf(value), X[:, 0] < 0.5)
    assert np.isfinite(gradient).all()


def test_it_can_do_what_both_can() -> None:
    assert Either(Quadratic(0.2), Quadratic(0.9)).is_differentiable
    assert not Either(Quadratic(0.2), Quadratic(0.9, is_differentiable=False)).is_differentiable


def test_it_is_cheaper_where_one_of_them_is() -> None:
    plain, screened = Quadratic(0.2), Screened(0.9)
    assert Either(plain, plain).rough is None
    for either in (Either(plain, screened), Either(screened, plain)):
        assert either.rough is not None
        assert either.rough(X) == pytest.approx(np.logaddexp(plain(X), screened.rough(X)))
