"""Which points no other point dominates."""

from __future__ import annotations

import moocore
import numpy as np

from hypermap_lite.typing import BoolArray, FloatArray


def non_dominated(Y: FloatArray) -> BoolArray:
    """Mark the points that no other point dominates, all objectives minimized.

    A point dominates another if it is nowhere larger and somewhere smaller. Equal points do not dominate each
    other, so all duplicates of a point on the front are on the front.

    Parameters
    ----------
    Y
        Objective values, shape (n, m). A row that holds NaN is never on the front and dominates nothing.

    Returns
    -------
    BoolArray
        True for the rows on the front, shape (n,).

    Raises
    ------
    ValueError
        If `Y` is not of shape (n, m) with m >= 1.

    Notes
    -----
    By moocore [1]_: O(n log n) up to three objectives, O(n (log n)^(m-2)) or, for few points, O(m n^2) above.

    References
    ----------
    .. [1] Kung, Luccio, Preparata. On Finding the Maxima of a Set of Vectors. Journal of the ACM, 1975.

    Examples
    --------
    >>> non_dominated(np.array([[1.0, 2.0], [2.0, 1.0], [2.0, 2.0]]))
    array([ True,  True, False])
    """
    Y = check_points(Y)
    front: BoolArray = np.logical_not(np.isnan(Y).any(axis=1))
    if front.any():
        # "weakly" is moocore's word for the copies of a point that come after the first
        front[front] = moocore.is_nondominated(Y[front], keep_weakly=True)
    return front


def check_points(Y: FloatArray) -> FloatArray:
    """Return `Y` as an array of floats; it must have the shape (n, m) with m >= 1, or ValueError is raised."""
    Y = np.asarray(Y, dtype=float)
    if Y.ndim != 2 or Y.shape[1] == 0:
        raise ValueError(f"Expected `Y` to have shape (n, m) with m >= 1 objectives. Got {Y.shape=}")
    return Y
