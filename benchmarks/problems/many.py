"""Problems with many parameters, 10 to 20, of which some may not matter, and 100 evaluations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from .base import FloatArray, Problem, one_objective, real_parameters
from .formulas import hartmann6, levy
from .several import SEVERAL, dtlz2
from .single import HARTMANN6

EVALUATIONS = 100
RELEVANT = (3, 4, 9, 11, 16, 18)
"""Axes of the twenty on which Hartmann-6 depends."""

GRASP = np.array([0.3, 0.6, 0.5, 0.7])
REACH = np.array([0.3, 0.3, 0.35, 0.25])
"""Distances from `GRASP` along the first four axes up to which the skill with twelve parameters succeeds."""

DROPPED = (6.0, 5.0)
"""Duration and effort of a failure."""


def hartmann6_of_20(X: FloatArray) -> FloatArray:
    """Return Hartmann-6 of six of twenty coordinates, shape (n,)."""
    return hartmann6(X[:, RELEVANT])


def zdt1(X: FloatArray) -> FloatArray:
    """Return ZDT1 (Zitzler, Deb, Thiele 2000), whose front is f2 = 1 - sqrt(f1)."""
    g = 1 + 9 * X[:, 1:].mean(axis=1)
    return np.column_stack([X[:, 0], g * (1 - np.sqrt(X[:, 0] / g))])


def skill12(X: FloatArray) -> FloatArray:
    """Return duration and effort of a skill with twelve parameters, both to be small, shape (n, 2).

    It succeeds where x1 to x4 are within `REACH` of `GRASP`, in 12 % of the cube; x5 is its haste, and x6 to x12 are
    best at 0.4:

        duration = 1 + x5 + 0.5 (x6 - 0.4)^2 + 0.3 sum_j (xj - 0.4)^2 for j = 7 ... 12
        effort   = 2 - x5 + 0.5 (x1 - 0.4)^2 + 0.2 the same sum

    A failure is worth (6, 5).
    """
    rest = ((X[:, 6:] - 0.4) ** 2).sum(axis=1)
    duration = 1 + X[:, 4] + 0.5 * (X[:, 5] - 0.4) ** 2 + 0.3 * rest
    effort = 2 - X[:, 4] + 0.5 * (X[:, 0] - 0.4) ** 2 + 0.2 * rest
    succeeds = (np.abs(X[:, :4] - GRASP) <= REACH).all(axis=1)
    return np.where(succeeds[:, None], np.column_stack([duration, effort]), DROPPED)


DTLZ2 = SEVERAL["dtlz2"]

MANY: Mapping[str, Problem] = {
    "hartmann6_of_20": replace(
        HARTMANN6,
        function=one_objective(hartmann6_of_20),
        parameters=real_parameters([(0, 1)] * 20),
        evaluations=EVALUATIONS,
    ),
    "levy10": Problem(
        function=one_objective(levy), parameters=real_parameters([(-10, 10)] * 10), best=0.0, evaluations=EVALUATIONS
    ),
    "dtlz2_d12": replace(
        DTLZ2, function=partial(dtlz2, m=2), parameters=real_parameters([(0, 1)] * 12), evaluations=EVALUATIONS
    ),
    "zdt1_d20": Problem(
        function=zdt1,
        parameters=real_parameters([(0, 1)] * 20),
        reference_point=(1.1, 1.1),
        best=1.21 - 1 / 3,
        evaluations=EVALUATIONS,
    ),
    "skill12": Problem(
        function=skill12,
        parameters=real_parameters([(0, 1)] * 12),
        reference_point=(3.0, 3.0),
        best=3.5,
        evaluations=EVALUATIONS,
    ),
}
"""The front of the skill is duration + effort = 3 with durations of 1 to 2, so the largest hypervolume is 1.5 + 2."""
