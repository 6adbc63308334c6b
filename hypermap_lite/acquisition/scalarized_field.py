"""A score that is a scalarization of one field: the optimistic bound, or a drawn function."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.scalarization.base import Normalization, Scalarization
from hypermap_lite.surrogates.base import Field
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class ScalarizedField:
    """Minus the scalarization of mean - beta std, in normalized objectives."""

    field: Field
    """With a single scenario."""

    beta: float
    scalarization: Scalarization
    weights: FloatArray
    normalization: Normalization
    is_differentiable: bool

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,)."""
        c = self.field(X)
        return -self.scalarization(self.normalization(c.mean[0] - self.beta * c.std[0]), self.weights)

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        bound = self.normalization(c.mean - self.beta * c.std)
        by_mean = -self.scalarization.gradient(bound, self.weights) / self.normalization.scale
        assert c.pullback is not None
        return -self.scalarization(bound[0], self.weights), c.pullback(by_mean, -self.beta * by_mean)
