"""Problems with two objectives whose feasible set an optimizer learns only by evaluating."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from .base import BoolArray, FloatArray, Problem, real_parameters
from .several import branin_currin, dtlz2

C2_RADIUS = 0.2
"""Of the feasible balls of C2-DTLZ2 with two objectives."""


def in_disk(X: FloatArray) -> BoolArray:
    """Tell whether points of the unit square lie in Gelbart's disk (2014) over Branin's square."""
    a, b = (X * 15 + [-5, 0]).T
    return (a - 2.5) ** 2 + (b - 7.5) ** 2 <= 50


def near_the_middle_or_an_end(X: FloatArray) -> BoolArray:
    """Tell whether the objectives of DTLZ2 lie in a ball around the front's middle or one of its ends [1]_.

    References
    ----------
    .. [1] Jain, Deb. An Evolutionary Many-Objective Optimization Algorithm Using Reference-Point Based Nondominated
       Sorting Approach, Part II. IEEE Trans. Evolutionary Computation, 2014.
    """
    Y = dtlz2(X, 2)
    ends = [((Y - end) ** 2).sum(axis=1) for end in np.eye(2)]
    # BoTorch, whose hypervolume this is, subtracts the squared radius of the ball in the middle for each objective.
    middle = ((Y - 1 / math.sqrt(2)) ** 2 - C2_RADIUS**2).sum(axis=1)
    return (np.min(ends, axis=0) <= C2_RADIUS**2) | (middle <= 0)


def chankong_haimes(X: FloatArray) -> FloatArray:
    """Return the objectives of Chankong and Haimes (1983) on [-20, 20]^2."""
    a, b = X.T
    return np.column_stack([2 + (a - 2) ** 2 + (b - 1) ** 2, 9 * a - (b - 1) ** 2])


def chankong_haimes_holds(X: FloatArray) -> BoolArray:
    """Tell whether both constraints of Chankong and Haimes hold, as they do in 16.2 % of the square."""
    a, b = X.T
    return (a**2 + b**2 <= 225) & (a - 3 * b + 10 <= 0)


def tnk_holds(X: FloatArray) -> BoolArray:
    """Tell whether both constraints of Tanaka et al. hold, as they do in a wavy band that is 5.1 % of the square [1]_.

    The objectives are the coordinates themselves, so the front is a part of the band's edge, in three pieces.

    References
    ----------
    .. [1] Tanaka, Watanabe, Furukawa, Tanino. GA-Based Decision Support System for Multicriteria Optimization. IEEE
       Int. Conf. Systems, Man and Cybernetics, 1995.
    """
    a, b = X.T
    is_outside = a**2 + b**2 >= 1 + 0.1 * np.cos(16 * np.arctan2(a, b))
    return is_outside & ((a - 0.5) ** 2 + (b - 0.5) ** 2 <= 0.5)


CONSTRAINED: Mapping[str, Problem] = {
    "constrained_branin_currin": Problem(
        function=branin_currin,
        is_feasible=in_disk,
        parameters=real_parameters([(0, 1)] * 2),
        reference_point=(80.0, 12.0),
        best=608.4004237022673,
    ),
    "c2dtlz2": Problem(
        function=lambda X: dtlz2(X, 2),
        is_feasible=near_the_middle_or_an_end,
        parameters=real_parameters([(0, 1)] * 4),
        reference_point=(1.1, 1.1),
        best=0.3996406303723544,
    ),
    "chankong_haimes": Problem(
        function=chankong_haimes,
        is_feasible=chankong_haimes_holds,
        parameters=real_parameters([(-20, 20)] * 2),
        reference_point=(260.0, 20.0),
        best=37_865.0,
    ),
    "tnk": Problem(
        function=np.array,
        is_feasible=tnk_holds,
        parameters=real_parameters([(0, math.pi)] * 2),
        reference_point=(1.3, 1.3),
        best=0.8967,  # of a grid of 26,000 x 26,000 points of the box below the reference point
    ),
}
