"""A score that counts less on the bounds of the space, where a model promises too much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.acquisition.base import Rough, Scorer, rough_of
from hypermap_lite.typing import BoolArray, FloatArray

WIDTH = 0.2
"""How far from a bound its effect ends, in units of the cube."""


def nearness(X: FloatArray, axes: BoolArray) -> FloatArray:
    """Return how near n points are to a bound of each chosen axis, shape (n, d): 1 on it, 0 from `WIDTH` on.

    Zero along the other axes; the slope vanishes where the effect ends.
    """
    return np.where(axes, (1 - _distance(X)) ** 2, 0.0)


def _distance(X: FloatArray) -> FloatArray:
    """Return the distance to the nearer bound of each axis, in units of `WIDTH`, at most 1, shape (n, d)."""
    distance: FloatArray = np.minimum(np.minimum(X, 1 - X) / WIDTH, 1.0)
    return distance


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundaryWeighted:
    """A scorer in log form plus the log of a factor for each bound that a point is on, less for those it is near."""

    inner: Scorer
    axes: BoolArray
    """Axes whose bounds count, shape (d,)."""

    factor: float
    """Of a point on one bound, in (0, 1]."""

    @property
    def is_differentiable(self) -> bool:
        """Whether the inner scorer is."""
        return self.inner.is_differentiable

    def log_weight(self, X: FloatArray) -> FloatArray:
        """Return the log of the product of the factors at n points, shape (n,)."""
        log_weight: FloatArray = np.log(1 - (1 - self.factor) * nearness(X, self.axes)).sum(axis=1)
        return log_weight

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return self.inner(X) + self.log_weight(X)

    @property
    def rough(self) -> Rough | None:
        """The cheaper approximation, if the inner scorer has one."""
        inner = rough_of(self.inner)
        return None if inner is None else lambda X: inner(X) + self.log_weight(X)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        score, gradient = self.inner.with_gradient(X)
        inwards = np.where(X < 0.5, 1.0, -1.0) * self.axes
        slope = 2 * (1 - self.factor) * (1 - _distance(X)) / WIDTH * inwards
        return score + self.log_weight(X), gradient + slope / (1 - (1 - self.factor) * nearness(X, self.axes))
