"""A score of points whose outcome may be of one kind or of another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.acquisition.base import Rough, Scorer, rough_of
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True)
class Either:
    """Log of the sum of two utilities in log form: what is expected of either kind times the chance of that kind."""

    first: Scorer
    second: Scorer

    @property
    def is_differentiable(self) -> bool:
        """Whether both are."""
        return self.first.is_differentiable and self.second.is_differentiable

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        return np.asarray(np.logaddexp(self.first(X), self.second(X)))

    @property
    def rough(self) -> Rough | None:
        """The cheaper approximation, if one of them has one."""
        a, b = rough_of(self.first), rough_of(self.second)
        if a is None and b is None:
            return None
        return lambda X: np.asarray(np.logaddexp((a or self.first)(X), (b or self.second)(X)))

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        (a, by_a), (b, by_b) = self.first.with_gradient(X), self.second.with_gradient(X)
        score = np.logaddexp(a, b)
        share = np.exp(a - np.where(np.isfinite(score), score, 0.0))[:, None]
        return score, share * by_a + (1 - share) * by_b
