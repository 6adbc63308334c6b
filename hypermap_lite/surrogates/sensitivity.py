"""How much each axis of the unit cube matters to a function."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypermap_lite.quasi_random import sobol_points
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng

POINTS = 2048
"""Base points of the estimate; the function is called at d + 2 times as many."""


def total_sobol_indices(
    function: Callable[[FloatArray], FloatArray], space: SearchSpace, rng: Rng, points: int = POINTS
) -> FloatArray:
    """Estimate the total Sobol indices of each axis: the share of the variance that vanishes if all others are known.

    Interactions count for each of the axes they tie together. The estimator is Jansen's [1]_, on a Sobol sequence;
    every level of a discrete axis weighs as its bin is wide.

    Parameters
    ----------
    function
        Returns m values at each of n points, shape (n, d) to (n, m).
    space
        Says which points are legal.
    rng
        Scrambles the sequence.
    points
        Base points, a power of two.

    Returns
    -------
    FloatArray
        Shape (m, d), >= 0; zeros for a function that is constant.

    References
    ----------
    .. [1] Jansen. Analysis of variance designs for model output. Computer Physics Communications, 1999, eq. 2.
    """
    d = space.dimension
    draws = sobol_points(points, 2 * d, rng)
    A, B = space.snap(draws[:, :d]), space.snap(draws[:, d:])
    values = function(A)  # (n, m)
    variance = np.vstack([values, function(B)]).var(axis=0)
    differences = np.empty((values.shape[1], d))
    for j in range(d):
        mixed = A.copy()
        mixed[:, j] = B[:, j]
        differences[:, j] = 0.5 * ((values - function(mixed)) ** 2).mean(axis=0)
    is_constant = variance <= (1e-12 * np.abs(values).max(axis=0)) ** 2
    scale = np.where(is_constant, 1.0, variance)
    return np.where(is_constant[:, None], 0.0, differences / scale[:, None])
