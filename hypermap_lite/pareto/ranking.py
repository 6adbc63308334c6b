"""Sorting points by how good they are when there are several objectives."""

from __future__ import annotations

import numpy as np

from hypermap_lite.pareto.dominance import check_points, non_dominated
from hypermap_lite.typing import FloatArray, IntArray


def non_dominated_ranks(Y: FloatArray) -> IntArray:
    """Return the number of the front each point is on, shape (n,), all objectives minimized [1]_.

    Front 0 is that of all points, front 1 that of the points without front 0, and so on. Points with an infinite or
    undefined objective share the last front.

    References
    ----------
    .. [1] Deb, Pratap, Agarwal, Meyarivan. A Fast and Elitist Multiobjective Genetic Algorithm: NSGA-II. IEEE Trans.
       Evolutionary Computation, 2002.

    Examples
    --------
    >>> non_dominated_ranks(np.array([[1.0, 2.0], [2.0, 1.0], [2.0, 2.0], [np.inf, 0.0]]))
    array([0, 0, 1, 2])
    """
    Y = check_points(Y)
    ranks = np.zeros(len(Y), dtype=np.int64)
    left = np.flatnonzero(np.isfinite(Y).all(axis=1))
    ranks[np.setdiff1d(np.arange(len(Y)), left)] = len(Y)
    front = 0
    while len(left):
        is_on = non_dominated(Y[left])
        ranks[left[is_on]] = front
        left, front = left[~is_on], front + 1
    return np.minimum(ranks, front)


def crowding_distances(Y: FloatArray, ranks: IntArray) -> FloatArray:
    """Return how lonely each point is on its front, shape (n,): the size of the gap around it, all objectives summed.

    Gaps are in units of the front's extent, and infinite at its ends [1]_; zero for points with an infinite objective.

    References
    ----------
    .. [1] Deb, Pratap, Agarwal, Meyarivan. A Fast and Elitist Multiobjective Genetic Algorithm: NSGA-II. IEEE Trans.
       Evolutionary Computation, 2002.

    Examples
    --------
    >>> Y = np.array([[0.0, 4.0], [1.0, 1.0], [4.0, 0.0]])
    >>> crowding_distances(Y, non_dominated_ranks(Y))
    array([inf,  2., inf])
    """
    distances = np.zeros(len(Y))
    for front in np.unique(ranks):
        rows = np.flatnonzero((ranks == front) & np.isfinite(Y).all(axis=1))
        for k in range(Y.shape[1] if len(rows) else 0):
            order = rows[np.argsort(Y[rows, k], kind="stable")]
            y = Y[order, k]
            if y[-1] > y[0]:
                distances[order[1:-1]] += (y[2:] - y[:-2]) / (y[-1] - y[0])
                distances[order[[0, -1]]] = np.inf
    return distances
