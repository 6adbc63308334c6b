"""Allowed points of a space that random draws hardly ever hit: steps around those that are known."""

from __future__ import annotations

import numpy as np

from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng

STEPS = (0.3, 0.1, 0.03, 0.01, 0.003, 0.001)
"""Standard deviations of the steps, in units of the cube, chosen at random."""

STEPS_AT_ONCE = 256
MAX_ROUNDS = 100
"""Attempts before a walk ends with fewer points than it was asked for."""


def walk(space: SearchSpace, points: FloatArray, n: int, rng: Rng) -> FloatArray:
    """Return n different allowed points: the given ones, then steps around them and around each other, shape (n, d).

    Fewer if no more are found.
    """
    points = points if len(points) else space.known_point
    for _ in range(MAX_ROUNDS):
        if len(points) >= n or not len(points):
            break
        start = points[rng.integers(len(points), size=STEPS_AT_ONCE)]
        size = rng.choice(STEPS, size=(STEPS_AT_ONCE, 1))
        is_moved = rng.random(start.shape) < rng.choice([0.5, 1.0], size=(STEPS_AT_ONCE, 1))
        stepped = np.clip(start + size * is_moved * rng.standard_normal(start.shape), 0.0, 1.0)
        more = np.vstack([points, space.keep_allowed(space.snap(stepped))])
        points = more[space.unseen(more, ())]
    return points[:n]


def spread(space: SearchSpace, n: int, rng: Rng) -> FloatArray:
    """Return up to n different allowed points of a space in which random draws find too few, shape (k, d)."""
    listed = space.sample_listed(n, rng)
    return listed if len(listed) else walk(space, space.known_point, n, rng)
