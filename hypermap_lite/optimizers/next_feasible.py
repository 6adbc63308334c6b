"""Where to look while one or two feasible points are known, too few to learn how large their region is."""

from __future__ import annotations

from typing import Final

import numpy as np

from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.surrogates.feasibility import FEWEST_OF_FIT
from hypermap_lite.typing import BoolArray, FloatArray, Rng

PATIENCE: Final = 8
"""Evaluations since the last feasible one after which those near a feasible point begin.

Where the classifier leads to feasible points it finds other regions, too, which a search near the first point misses:
C2-DTLZ2 ended at 0.939 of the hypervolume without patience, at 0.955 with that of 4, and at 0.970 with this one.
"""

WIDTHS: Final = (0.25, 0.125, 0.0625, 0.03125, 0.015625)
"""Half widths of the boxes around a feasible point, as shares of the space, in the order they are tried."""

CANDIDATES: Final = 32
"""Draws from a box, of which the first that is new and allowed is taken."""


def attempt(is_feasible: BoolArray, n_pending: int = 0) -> int | None:
    """Return the number of the draw near a feasible point that is due, from 0 on; None if the search goes on without.

    While there are one or two, the 9th to 13th evaluation since the last of them are such draws, one for each of
    `WIDTHS`, then every second one. What was feasible only by chance, or is a region of its own, so small that nothing
    else of it is found, takes half of a run at most.

    Parameters
    ----------
    is_feasible
        Of the evaluations so far, those of the design included, shape (n,).
    n_pending
        Evaluations under way, which may all be infeasible.
    """
    if is_feasible.all() or not 0 < is_feasible.sum() < FEWEST_OF_FIT:
        return None
    late = len(is_feasible) - 1 - int(np.flatnonzero(is_feasible)[-1]) + n_pending - PATIENCE
    if late < len(WIDTHS):
        return late if late >= 0 else None
    beyond = late - len(WIDTHS)
    return len(WIDTHS) + beyond // 2 if beyond % 2 else None


def draw_near(space: SearchSpace, feasible: FloatArray, number: int, taken: list[bytes], rng: Rng) -> FloatArray | None:
    """Return a new point near one of k feasible ones, shape (k, d) to (d,), by turns; or None if none is found.

    It is uniform in the part of a box that is within the space; the box is smaller from one number to the next, and
    then large again. Axes without an order keep their values.

    The region that the first feasible point belongs to may be a sliver, of which a classifier knows no more than that
    point: it takes the point for a matter of chance, and the search leaves it. Final hypervolume of 60 evaluations, or
    log10 regret, by the classifier alone and with these draws, means over 6 seeds (Osyczka and Kundu 16):

        5 % along one axis of 3, by a bound      0.120  0.147
        5 % along one axis of 3, in the middle   0.164  0.176
        3 % between two planes of 4 axes         0.060  0.062
        4 % along the diagonal of a square       0.174  0.175
        Osyczka and Kundu, six axes               6110   6650
        tension spring, 1.6 %                    -1.39  -1.61
    """
    centre = feasible[::-1][number % len(feasible)]
    width = np.where(space.is_ordered, WIDTHS[number % len(WIDTHS)], 0.0)
    low, high = np.maximum(centre - width, 0.0), np.minimum(centre + width, 1.0)
    X = space.keep_allowed(space.snap(low + (high - low) * rng.random((CANDIDATES, len(centre)))))
    X = X[space.unseen(X, taken)]
    return X[0] if len(X) else None
