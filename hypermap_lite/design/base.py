"""What an initial design is: the points evaluated before there is a model."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import MAX_DRAWS, SearchSpace
from hypermap_lite.space.walk import walk
from hypermap_lite.typing import FloatArray, Rng

MAX_ROUNDS = 100
"""Attempts to replace repeated points of a finite space before it is enumerated."""

ENUMERATION_LIMIT = 100_000
"""Finite spaces up to this size are enumerated to find the points that are left."""


class InitialDesign(Protocol):
    """Chooses the first points of a run."""

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return up to n different legal, allowed points, shape (k, d) with k <= n.

        Fewer than n only where a finite space, or a grid, has no more.
        """
        ...


def distinct(space: SearchSpace, X: FloatArray, n: int, draw: Callable[[int], FloatArray], rng: Rng) -> FloatArray:
    """Snap points to the space, drop repeats and what is not allowed, and draw others until there are n.

    Parameters
    ----------
    space
        The search space.
    X
        Points of the unit cube, shape (k, d), in order of preference.
    n
        How many are wanted.
    draw
        Draws a number of further points, shape (k, d). Where it finds no new ones any more (a narrow prior over a
        discrete axis, a level of weight zero), the rest is uniform.
    rng
        Source of those.

    Returns
    -------
    FloatArray
        Different legal, allowed points, shape (min(n, n_configurations), d). Where constraints leave next to nothing
        of the space, the last of them come from steps around the others.
    """

    def uniform(k: int) -> FloatArray:
        return rng.random((k, space.dimension))

    points = space.keep_allowed(space.snap(X))
    points = points[space.unseen(points, ())]
    for draw_more in (draw, uniform):
        for _ in range(MAX_ROUNDS):
            if len(points) >= min(n, space.n_configurations):
                return points[:n]
            more = np.vstack([points, space.draw(n, draw_more, MAX_DRAWS // MAX_ROUNDS)])
            points = more[space.unseen(more, ())]
    if space.n_configurations <= ENUMERATION_LIMIT:
        rest = np.vstack([points, space.enumerate()])
        points = rest[space.unseen(rest, ())]
    elif space.constraints:
        points = walk(space, points, n, rng)
    return points[:n]
