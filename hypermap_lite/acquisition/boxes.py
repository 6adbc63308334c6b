"""What fronts leave undominated below a reference point, cut into boxes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.typing import FloatArray, IntArray

BoxIndex = tuple[int, int, int, int, int]
"""Lower and upper end along the first objective, height along the second, lower and upper end along the third."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Boxes:
    """Disjoint boxes that fill what S fronts of two or three objectives leave undominated below the reference point.

    All reach from minus infinity up to their height in the second objective. Their ends are positions among the limits
    of an objective, counted from one; zero stands for minus infinity. Fronts with fewer boxes than others have empty
    ones too.
    """

    limits: tuple[FloatArray, ...]
    """For each objective, values at which boxes may end, shapes (S, k)."""

    lower: tuple[IntArray, IntArray]
    """Lower ends in the first and the third objective, shapes (S, B)."""

    upper: tuple[IntArray, IntArray]
    """Upper ends likewise."""

    height: IntArray
    """Positions of the heights, counted from zero, shape (S, B)."""

    @classmethod
    def of(cls, fronts: FloatArray, reference_point: FloatArray) -> Boxes:
        """Cut the space below the reference point.

        Parameters
        ----------
        fronts
            S sets of points, to be minimized, shape (S, k, m), m in {2, 3}; dominated points, and those not below the
            reference point, leave no trace.
        reference_point
            Shape (m,).
        """
        kept = [np.unique(front_below(points, reference_point), axis=0) for points in fronts]
        size = 1 + max(map(len, kept))
        limits = np.broadcast_to(reference_point, (len(kept), size, len(reference_point))).copy()
        for s, front in enumerate(kept):
            limits[s, 1 : len(front) + 1] = front  # sorted by the first objective; the first row is the reference point
        found = [list(_boxes_of(front)) for front in kept]
        index = np.zeros((len(kept), max(map(len, found)), 5), dtype=np.intp)
        for s, boxes in enumerate(found):
            index[s, : len(boxes)] = boxes
        return cls(
            limits=tuple(limits[:, :, k] for k in range(limits.shape[2])),
            lower=(index[:, :, 0], index[:, :, 3]),
            upper=(index[:, :, 1], index[:, :, 4]),
            height=index[:, :, 2],
        )

    def __len__(self) -> int:
        return len(self.height)

    def first(self, n: int) -> Boxes:
        """Return those of the first n fronts."""
        return Boxes(
            limits=tuple(limits[:n] for limits in self.limits),
            lower=(self.lower[0][:n], self.lower[1][:n]),
            upper=(self.upper[0][:n], self.upper[1][:n]),
            height=self.height[:n],
        )

    def ends(self, k: int, values: FloatArray, *, below: float) -> tuple[FloatArray, FloatArray]:
        """Return what belongs to the lower and the upper ends of all boxes along objective k, shapes (S, B, n).

        Parameters
        ----------
        k
            0 or 2.
        values
            What belongs to the objective's limits, shape (S, k, n).
        below
            What belongs to minus infinity.
        """
        front = np.arange(len(values))[:, None]
        padded = np.concatenate([np.full_like(values[:, :1], below), values], axis=1)
        return padded[front, self.lower[k // 2]], padded[front, self.upper[k // 2]]

    def sides(self, k: int, values: FloatArray) -> FloatArray:
        """Return the differences of what belongs to the ends of all boxes along an objective, shape (S, B, n)."""
        if k == 1:
            return np.asarray(values[np.arange(len(values))[:, None], self.height])
        lower, upper = self.ends(k, values, below=0.0)
        return upper - lower


def front_below(Y: FloatArray, reference_point: FloatArray) -> FloatArray:
    """Return the non-dominated rows that are better than the reference point everywhere, shape (k, m)."""
    inside = Y[(reference_point > Y).all(axis=1)]
    return inside[non_dominated(inside)] if len(inside) else inside


def _boxes_of(front: FloatArray) -> Iterator[BoxIndex]:
    """Yield the boxes of one front, sorted by its first objective.

    Position 1 is the reference point, position i + 2 row i of the front; heights count from zero.
    """
    if front.shape[1] == 2:
        yield from ((*strip, 0, 0) for strip in _strips(range(len(front))))
        return
    stairs: list[int] = []
    since = dict.fromkeys(_strips(stairs), 0)
    for row in map(int, np.argsort(front[:, 2], kind="stable")):
        first, second, third = front[row]
        if any(front[other, 0] <= first and front[other, 1] <= second for other in stairs):
            continue
        stairs = sorted([row, *(i for i in stairs if front[i, 0] < first or front[i, 1] < second)])
        now = dict.fromkeys(_strips(stairs), row + 2)
        for strip, start in since.items():
            if strip in now:
                now[strip] = start
            elif start == 0 or front[start - 2, 2] < third:
                yield (*strip, start, row + 2)
        since = now
    yield from ((*strip, start, 1) for strip, start in since.items())


def _strips(stairs: Sequence[int]) -> Iterator[tuple[int, int, int]]:
    """Yield lower end, upper end and height between the steps of a staircase of rows, which falls to the right."""
    rights = [*(row + 2 for row in stairs), 1]
    lefts, heights = [0, *rights[:-1]], [0, *(row + 1 for row in stairs)]
    yield from zip(lefts, rights, heights, strict=True)
