"""The volume a set of points dominates, its growth over a run, and the corner it is measured from."""

from __future__ import annotations

from typing import Final

import moocore
import numpy as np

from hypermap_lite.pareto.dominance import check_points, non_dominated
from hypermap_lite.typing import FloatArray

REFERENCE_MARGIN: Final = 0.1
"""How far beyond the nadir an inferred reference point lies, as a fraction of the front's range."""


def hypervolume(Y: FloatArray, reference_point: FloatArray) -> float:
    """Measure the volume dominated by a set of points, all objectives minimized.

    Exact, by moocore [1]_: O(n log n) up to three objectives, O(n^2) for four, O(n^(m-2)) in the worst case above.

    Parameters
    ----------
    Y
        Objective values, shape (n, m). Points outside the reference box and rows that hold NaN add nothing.
    reference_point
        Upper corner of the box, shape (m,), finite, in the objectives' own units.

    Returns
    -------
    float
        Dominated volume, in the product of the objectives' units; 0.0 for an empty set, inf if beyond all floats.

    Raises
    ------
    ValueError
        If the shapes disagree, or the reference point is not finite.

    References
    ----------
    .. [1] Fonseca, Paquete, Lopez-Ibanez. An Improved Dimension-Sweep Algorithm for the Hypervolume Indicator.
       IEEE Congress on Evolutionary Computation, 2006.

    Examples
    --------
    >>> hypervolume(np.array([[1.0, 2.0], [2.0, 1.0]]), np.array([3.0, 3.0]))
    3.0
    """
    Y = check_points(Y)
    corner = _check_reference_point(reference_point, Y.shape[1])
    inside = Y[np.less(Y, corner).all(axis=1)]  # NaN compares false
    return float(moocore.hypervolume(inside, ref=corner)) if len(inside) else 0.0


def hypervolume_trace(Y: FloatArray, reference_point: FloatArray) -> FloatArray:
    """Measure the hypervolume after each of n evaluations.

    Parameters
    ----------
    Y
        Objective values to be minimized in the order of the evaluations, shape (n, m). A row that holds NaN (an
        evaluation that failed) leaves the value as it was.
    reference_point
        Upper corner of the box, shape (m,).

    Returns
    -------
    FloatArray
        Hypervolume of the first 1, 2, ..., n rows, shape (n,); never falls.

    Raises
    ------
    ValueError
        If the shapes disagree, or the reference point is not finite.
    """
    Y = check_points(Y)
    corner = _check_reference_point(reference_point, Y.shape[1])
    trace = np.zeros(len(Y))
    front = np.empty((0, Y.shape[1]))
    volume = 0.0
    for i, y in enumerate(Y):
        if (y < corner).all() and not (front <= y).all(axis=1).any():
            front = np.vstack([front[~(y <= front).all(axis=1)], y])
            volume = max(volume, hypervolume(front, corner))  # the last bit of a sum may round down
        trace[i] = volume
    return trace


def infer_reference_point(Y: FloatArray) -> FloatArray:
    """Choose a reference point from the points themselves, for want of one the user gave.

    The nadir of their front (per objective the worst value on it), moved outwards by 10 % of the front's range:
    the rule of Ishibuchi et al. [1]_ as BoTorch's ``infer_reference_point`` has it. Where the front has no range
    (a single point, equal values) the step is 10 % of the value, or 0.1 if the value is zero.

    Parameters
    ----------
    Y
        Objective values to be minimized, shape (n, m); rows that hold NaN or infinities are left out.

    Returns
    -------
    FloatArray
        Reference point, shape (m,), strictly worse than each point of the front in each objective (but for the
        largest float).

    Raises
    ------
    ValueError
        If `Y` is not of shape (n, m), or has no row without NaN and infinities.

    References
    ----------
    .. [1] Ishibuchi, Imada, Setoguchi, Nojima. How to Specify a Reference Point in Hypervolume Calculation for
       Fair Performance Comparison. Evolutionary Computation, 2018.

    Examples
    --------
    >>> infer_reference_point(np.array([[0.0, 10.0], [1.0, 0.0], [5.0, 50.0]]))
    array([ 1.1, 11. ])
    """
    Y = check_points(Y)
    Y = Y[np.isfinite(Y).all(axis=1)]
    if not len(Y):
        raise ValueError("Expected `Y` to have at least one row of finite values to infer a reference point from")
    front = Y[non_dominated(Y)]
    nadir = front.max(axis=0)
    with np.errstate(over="ignore"):  # a range beyond all floats is measured in parts, the point stays a float
        span = nadir - front.min(axis=0)
        parts = REFERENCE_MARGIN * nadir - REFERENCE_MARGIN * front.min(axis=0)
        step = np.where(np.isfinite(span), REFERENCE_MARGIN * span, parts)
        step = np.where(step > 0, step, REFERENCE_MARGIN * np.abs(nadir))
        step = np.where(step > 0, step, REFERENCE_MARGIN)
        corner = np.maximum(nadir + step, np.nextafter(nadir, np.inf))  # worse even if the step is lost in rounding
    return np.minimum(corner, np.finfo(float).max)


def _check_reference_point(reference_point: FloatArray, m: int) -> FloatArray:
    """Return the reference point as an array of m finite floats, or raise ValueError."""
    corner = np.asarray(reference_point, dtype=float)
    if corner.shape != (m,):
        raise ValueError(
            f"Expected `reference_point` to have shape ({m},), one value per objective. Got {corner.shape=}"
        )
    if not np.isfinite(corner).all():
        raise ValueError(f"Expected `reference_point` to be finite. Got {corner.tolist()}")
    return corner
