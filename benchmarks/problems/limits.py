"""Problems with one objective whose feasible set an optimizer learns only by evaluating."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .base import BoolArray, FloatArray, Problem, one_objective, real_parameters
from .constrained import in_disk
from .formulas import branin
from .single import HARTMANN6

LEAST_MEAN = 0.4
"""Of the parameters of `sum_beyond`."""


def gramacy_holds(X: FloatArray) -> BoolArray:
    """Tell whether both constraints of the toy problem of Gramacy et al. hold, as in 46 % of the square [1]_.

    References
    ----------
    .. [1] Gramacy, Gray, Le Digabel, Lee, Ranjan, Wells, Wild. Modeling an Augmented Lagrangian for Blackbox
       Constrained Optimization. Technometrics, 2016.
    """
    a, b = X.T
    wave = 1.5 - a - 2 * b - 0.5 * np.sin(2 * np.pi * (a**2 - 2 * b))
    return (wave <= 0) & (a**2 + b**2 <= 1.5)


def simionescu_holds(X: FloatArray) -> BoolArray:
    """Tell whether points lie in Simionescu's flower (2014), 51 % of the square."""
    a, b = X.T
    return np.asarray(a**2 + b**2 <= (1 + 0.2 * np.cos(8 * np.arctan2(a, b))) ** 2)


def tension_spring(X: FloatArray) -> FloatArray:
    """Return the weight of a spring of wire and coil diameters and a number of coils [1]_.

    References
    ----------
    .. [1] Arora. Introduction to Optimum Design, 1989; Coello. Use of a Self-Adaptive Penalty Approach for Engineering
       Optimization Problems. Computers in Industry, 2000.
    """
    wire, coil, number = X.T
    return (number + 2) * coil * wire**2


def tension_spring_holds(X: FloatArray) -> BoolArray:
    """Tell whether deflection, stress, frequency and outer diameter are within limits: thin wires, 1.6 % of the box."""
    wire, coil, number = X.T
    stress = (4 * coil**2 - wire * coil) / (12_566 * (coil * wire**3 - wire**4)) + 1 / (5108 * wire**2)
    frequency = 140.45 * wire / (coil**2 * number)
    return (coil**3 * number >= 71_785 * wire**4) & (stress <= 1) & (frequency >= 1) & (coil + wire <= 1.5)


def sum_of_all(X: FloatArray) -> FloatArray:
    """Return the sum of the parameters, and a little that depends on the first one."""
    return X.sum(axis=1) + (X[:, 0] - 0.3) ** 2


def sum_beyond(dimension: int) -> Problem:
    """Return the sum of all parameters where their mean is to be at least `LEAST_MEAN`.

    As what costs time or force and fails if there is too little: everything beyond the limit is better and infeasible,
    the more the farther.
    """
    return Problem(
        function=one_objective(sum_of_all),
        is_feasible=lambda X: X.mean(axis=1) >= LEAST_MEAN,
        parameters=real_parameters([(0, 1)] * dimension),
        best=LEAST_MEAN * dimension,
    )


LIMITS: Mapping[str, Problem] = {
    "gramacy": Problem(
        function=one_objective(lambda X: X.sum(axis=1)),
        is_feasible=gramacy_holds,
        parameters=real_parameters([(0, 1)] * 2),
        best=0.5997880520,
    ),
    "simionescu": Problem(
        function=one_objective(lambda X: 0.1 * X.prod(axis=1)),
        is_feasible=simionescu_holds,
        parameters=real_parameters([(-1.25, 1.25)] * 2),
        best=-0.072,
    ),
    "branin_disk": Problem(
        function=one_objective(branin),
        is_feasible=lambda X: in_disk((X - [-5, 0]) / 15),
        parameters=real_parameters([(-5, 10), (0, 15)]),
        best=0.39788735772973816,
    ),
    "sum_beyond2": sum_beyond(2),
    "sum_beyond5": sum_beyond(5),
    "tension_spring": Problem(
        function=one_objective(tension_spring),
        is_feasible=tension_spring_holds,
        parameters=real_parameters([(0.05, 1), (0.25, 1.3), (2, 15)]),
        best=0.0126652328,
    ),
    "hartmann6_ball": Problem(
        function=HARTMANN6.function,
        is_feasible=lambda X: (X**2).sum(axis=1) <= 1,
        parameters=HARTMANN6.parameters,
        best=HARTMANN6.best,
    ),
}
