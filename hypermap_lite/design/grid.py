"""A full grid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np

from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """The finest full grid of at most n points, bounds included; shuffled, so that a stopped run has seen all regions.

    All axes get the same number of levels, or all their own where they have fewer.
    """

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return the points of the grid, shape (k, d) with k <= n."""
        levels = 1
        while self._size(space, levels + 1) <= n and self._size(space, levels + 1) > self._size(space, levels):
            levels += 1
        X = np.array(list(product(*self._axes(space, levels))))
        return space.snap(rng.permutation(X))

    @staticmethod
    def _counts(space: SearchSpace, levels: int) -> list[int]:
        return [levels if p.n_levels is None else min(levels, p.n_levels) for p in space.parameters]

    def _size(self, space: SearchSpace, levels: int) -> int:
        return math.prod(self._counts(space, levels))

    def _axes(self, space: SearchSpace, levels: int) -> list[FloatArray]:
        axes = []
        for parameter, count in zip(space.parameters, self._counts(space, levels), strict=True):
            spread = np.linspace(0.0, 1.0, count) if count > 1 else np.array([0.5])
            if count == parameter.n_levels or not parameter.is_ordered:
                spread = (np.arange(count) + 0.5) / count
            axes.append(parameter.snap(spread))
        return axes
