"""What each point adds to the volume that all dominate together."""

from __future__ import annotations

import moocore
import numpy as np

from hypermap_lite.pareto.dominance import check_points
from hypermap_lite.typing import FloatArray


def hypervolume_contributions(Y: FloatArray, reference_point: FloatArray) -> FloatArray:
    """Measure the volume that each point dominates and no other does, all objectives minimized.

    Parameters
    ----------
    Y
        Objective values, shape (n, m).
    reference_point
        Upper corner of the box, shape (m,), finite.

    Returns
    -------
    FloatArray
        Shape (n,), >= 0; zero for points that are dominated, outside the box, equal to another, or hold NaN. For one
        objective, how far the best value is from the next one, or from the reference.

    Examples
    --------
    >>> hypervolume_contributions(np.array([[1.0, 3.0], [2.0, 2.0], [3.0, 3.0]]), np.array([4.0, 4.0])).tolist()
    [1.0, 2.0, 0.0]
    """
    Y = check_points(Y)
    contributions = np.zeros(len(Y))
    inside = np.flatnonzero((reference_point > Y).all(axis=1))
    if not len(inside):
        return contributions
    if Y.shape[1] > 1:
        contributions[inside] = np.maximum(
            moocore.hv_contributions(Y[inside], ref=reference_point, ignore_dominated=False), 0.0
        )
        return contributions
    best, following = np.sort(np.append(Y[inside, 0], reference_point[0]))[:2]
    contributions[inside[np.argmin(Y[inside, 0])]] = following - best
    return contributions
