"""What repeated runs reach together: the surfaces that a given part of their fronts attains."""

from __future__ import annotations

import math
from collections.abc import Sequence

import moocore
import numpy as np

from hypermap_lite.pareto.dominance import check_points
from hypermap_lite.typing import FloatArray


def attainment_surface(fronts: Sequence[FloatArray], fraction: float) -> FloatArray:
    """Find the best points that at least a part of several fronts attains, two objectives, both minimized.

    A front attains a point if one of its own points is nowhere larger. The points that at least `fraction` of the
    fronts attain are those above and to the right of a staircase [1]_; with a fraction of 0.5 it is the median of the
    fronts as it were. The staircase need not pass through any single front.

    Parameters
    ----------
    fronts
        Objective values of n >= 1 runs, shapes (k_i, 2). Dominated points change nothing, rows that hold NaN are
        left out, and a front without points attains nothing, but counts as one.
    fraction
        Part of the fronts, above 0 and at most 1; rounded up to whole fronts.

    Returns
    -------
    FloatArray
        Inner corners of the staircase, mutually non-dominated and sorted by the first objective, shape (k, 2); none
        if too few fronts have points.

    Raises
    ------
    ValueError
        If there is no front, one has another number of objectives than two, or `fraction` is out of range.

    Notes
    -----
    By moocore, for all parts at once: O(k log k + n k) for k points in all.

    References
    ----------
    .. [1] Grunert da Fonseca, Fonseca, Hall. Inferential Performance Assessment of Stochastic Optimisers and the
       Attainment Function. Evolutionary Multi-Criterion Optimization, 2001.

    Examples
    --------
    >>> attainment_surface([np.array([[1.0, 4.0], [3.0, 1.0]]), np.array([[2.0, 3.0]])], 1.0)
    array([[2., 4.],
           [3., 3.]])
    """
    if not 0 < fraction <= 1:
        raise ValueError(f"Expected `fraction` above 0 and at most 1. Got {fraction}")
    points = [_check_front(front) for front in fronts]
    if not points:
        raise ValueError("Expected at least one front. Got none")
    n_needed = math.ceil(fraction * len(points) - 1e-9)  # 0.07 * 100 is above 7
    points = [front for front in points if len(front)]
    if n_needed > len(points):
        return np.empty((0, 2))
    surfaces = moocore.eaf(np.vstack(points), np.repeat(np.arange(len(points)), list(map(len, points))))
    n_attaining = np.rint(surfaces[:, 2] / 100 * len(points))  # the last column is a percentage
    surface = surfaces[n_attaining == n_needed, :2]
    return surface[np.lexsort(surface.T[::-1])]


def _check_front(front: FloatArray) -> FloatArray:
    """Return the points of a front without those that hold NaN; ValueError if they are not of shape (k, 2)."""
    front = check_points(front)
    if front.shape[1] != 2:
        raise ValueError(f"Expected fronts of shape (k, 2), two objectives. Got {front.shape=}")
    return front[~np.isnan(front).any(axis=1)]
