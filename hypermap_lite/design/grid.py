"""A full grid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hypermap_lite.design.base import ENUMERATION_LIMIT, distinct
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng

UNIMAGINABLE = 10**300
"""Larger numbers of points are shown as this."""

LARGEST = 10_000
"""Points of the largest grid that is looked through for those that constraints allow."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """A full grid, bounds included; shuffled, so that a stopped run has seen all regions.

    Without `levels` it is the finest grid of at most n points: all axes get the same number of levels, or all their own
    where they have fewer. With `levels`, real axes have that many and the others all their own; of more than n points
    the first n in the shuffled order are taken. Where constraints reject some, only the allowed points count; if no
    grid has any, the points are random.
    """

    levels: int | None = None
    """Points per real axis; None for as many as fit."""

    def __post_init__(self) -> None:
        if self.levels is not None and self.levels < 2:
            raise ScenarioError("$.levels", f"there are {self.levels} levels", allowed="an integer >= 2, or null")

    def check(self, space: SearchSpace) -> None:
        """Raise a `ScenarioError` if the grid has too many points to list."""
        if self.levels is not None and (size := math.prod(_fixed(space, self.levels))) > ENUMERATION_LIMIT:
            allowed = f"at most {ENUMERATION_LIMIT} points"
            problem = f"the grid would have {min(size, UNIMAGINABLE):.3g} points"
            hint = "Take fewer levels, or another design."
            raise ScenarioError("$.levels", problem, allowed=allowed, hint=hint)

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return up to n points of the grid, shape (k, d) with k <= n."""
        self.check(space)
        X = _finest(space, n) if self.levels is None else _full(space, _fixed(space, self.levels))
        if not len(X):
            return distinct(space, X, n, lambda k: rng.random((k, space.dimension)), rng)
        return rng.permutation(X)[:n]


def _finest(space: SearchSpace, n: int) -> FloatArray:
    """Return all allowed points of the finest grid with at most n of them, shape (k, d)."""

    def size(levels: int) -> int:
        return math.prod(_equal(space, levels))

    levels = 1
    while size(levels) < size(levels + 1) <= n:
        levels += 1
    X = _full(space, _equal(space, levels))
    while space.constraints and size(levels) < size(levels + 1) <= LARGEST:
        levels += 1
        finer = _full(space, _equal(space, levels))
        if len(X) and len(finer) > n:
            break
        X = finer
    return X


def _equal(space: SearchSpace, levels: int) -> list[int]:
    """Return the numbers of levels of all axes if each has this many, or all its own where it has fewer."""
    return [levels if p.n_levels is None else min(levels, p.n_levels) for p in space.parameters]


def _fixed(space: SearchSpace, levels: int) -> list[int]:
    """Return the numbers of levels of all axes if real ones have this many, and the others all their own."""
    return [levels if p.n_levels is None else p.n_levels for p in space.parameters]


def _full(space: SearchSpace, counts: list[int]) -> FloatArray:
    """Return all allowed points of the grid with so many levels on each axis, shape (k, d)."""
    axes = np.meshgrid(*_axes(space, counts), indexing="ij")
    return space.keep_allowed(space.snap(np.column_stack([axis.ravel() for axis in axes])))


def _axes(space: SearchSpace, counts: list[int]) -> list[FloatArray]:
    axes = []
    for parameter, count in zip(space.parameters, counts, strict=True):
        if count == parameter.n_levels:
            axes.append(parameter.level_codes())
            continue
        spread = np.linspace(0.0, 1.0, count) if count > 1 else np.array([0.5])
        axes.append(parameter.snap(spread if parameter.is_ordered else (np.arange(count) + 0.5) / count))
    return axes
