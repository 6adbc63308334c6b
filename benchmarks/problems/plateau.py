"""A skill that mostly fails: a plateau of failure, on which effort still varies, with cliffs around the successes."""

from __future__ import annotations

import numpy as np

from .base import FloatArray, Problem, real_parameters

HOLE = np.array([0.7, 0.35])
TOLERANCE = 0.15
"""Distance from the hole up to which the skill can succeed."""

ENOUGH_FORCE = 0.3
TIME_OUT = 1.5
"""Duration of a failure."""


def plateau(X: FloatArray) -> FloatArray:
    """Return duration and effort of a skill, both to be small, shape (n, 2).

    Parameters x1 and x2 say where to push, x3 how hard, x4 how fast, and x5 is a posture. The skill succeeds where
    the place is within `TOLERANCE` of the hole and the force is enough, in 4.9 % of the cube; then

        duration = 0.2 + 0.8 (1 - x4)^2 + 0.3 (distance / TOLERANCE)^2
        effort   = 0.1 + 0.6 x4^2 + 0.5 (x3 - ENOUGH_FORCE) + 0.3 (x5 - 0.5)^2

    and elsewhere the duration is `TIME_OUT` and the effort 0.5 x3 + 0.1 x4, which is least for doing nothing.
    """
    x3, x4, x5 = X[:, 2:].T
    distance = np.sqrt(((X[:, :2] - HOLE) ** 2).sum(axis=1))
    succeeds = (distance <= TOLERANCE) & (x3 >= ENOUGH_FORCE)
    duration = 0.2 + 0.8 * (1 - x4) ** 2 + 0.3 * (distance / TOLERANCE) ** 2
    effort = 0.1 + 0.6 * x4**2 + 0.5 * (x3 - ENOUGH_FORCE) + 0.3 * (x5 - 0.5) ** 2
    return np.where(
        succeeds[:, None],
        np.column_stack([duration, effort]),
        np.column_stack([np.full(len(X), TIME_OUT), 0.5 * x3 + 0.1 * x4]),
    )


PLATEAU = Problem(
    function=plateau,
    parameters=real_parameters([(0, 1)] * 5),
    reference_point=(1.6, 1.2),
    best=1.47,
)
"""The front is the successes at the hole with just enough force, and doing nothing, (1.5, 0).

Above doing nothing lies 0.1 x 0.1; above the successes with effort up to 0.7, the integral of
(1.4 - 0.8 (1 - s)^2) 1.2 s over s in [0, 1], which is 0.76; and above the fastest one 1.4 x 0.5.
"""
