"""What a scalarization is: several objectives turned into one number, smaller is better."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from hypermap_lite.objectives import Objective
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.typing import FloatArray, Rng

Normalize = Callable[[FloatArray], FloatArray]
"""Brings objectives as they are reported, but to be minimized, shape (m,), to comparable sizes."""

SMALLEST_EXTENT = 1e-3
"""Smallest range of the front that counts as a trade-off, as a share of the range of all evaluations."""


class Scalarization(Protocol):
    """A monotone function of m normalized objectives, all to be minimized."""

    is_linear: ClassVar[bool]
    """Whether the expected improvement may be taken per objective and summed."""

    def __call__(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return the scalar of each row, shape (..., m) to (...)."""
        ...

    def gradient(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return a (sub)gradient by Y, shape (..., m)."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Normalization:
    """Shift and scale that bring the objectives, to be minimized, to comparable sizes."""

    offset: FloatArray
    """Shape (m,): the value that becomes 0, the best of the front."""

    scale: FloatArray
    """Shape (m,): the length that becomes 1, the range of the front."""

    @classmethod
    def of_front(cls, Y: FloatArray, reference_point: FloatArray | None = None) -> Normalization:
        """Take the best and the worst values of the non-dominated rows of Y, shape (n, m).

        With a reference point only the part of the front that dominates it counts, as long as there is one: what is
        worse than the reference point in some objective is of no interest, however good it is in the others.
        Where that part has (next to) no extent in an objective, all rows are taken, so that numerical dust is no
        trade-off; where those have none, scale 1.
        """
        front = Y[non_dominated(Y)]
        if reference_point is not None and (inside := (front < reference_point).all(axis=1)).any():
            front = front[inside]
        offset = front.min(axis=0)
        scale = front.max(axis=0) - offset
        overall = Y.max(axis=0) - Y.min(axis=0)
        scale = np.where(scale > SMALLEST_EXTENT * overall, scale, overall)
        return cls(offset=offset, scale=np.where(scale > 0, scale, 1.0))

    def reaching(self, ideal: FloatArray) -> Normalization:
        """Return the normalization whose zero is the ideal, shape (m,), where that is better; the worst stays one.

        A Tchebyshev scalarization sees no gain beyond its zero. Where a boundary has to be followed to get to the
        ends of the front, its zero must be what can be reached, not what has been.
        """
        offset = np.minimum(self.offset, ideal)
        return Normalization(offset=offset, scale=self.scale + (self.offset - offset))

    def __call__(self, Y: FloatArray) -> FloatArray:
        """Return normalized objectives, shape (..., m)."""
        return (Y - self.offset) / self.scale


class WeightSampling(Protocol):
    """Draws the weights of a scalarization: which trade-off is looked for next."""

    @property
    def redraws(self) -> int:
        """How often weights at which no point promises anything may be drawn again."""
        ...

    def sample(self, objectives: Sequence[Objective], normalize: Normalize, rng: Rng) -> FloatArray:
        """Return m weights >= 0 that sum to one, shape (m,)."""
        ...
