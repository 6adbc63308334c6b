"""Problems with categories, integers and lists of values, most beside real parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .base import BoolArray, FloatArray, Problem, one_objective, real_parameters
from .formulas import ackley, hartmann6
from .several import SEVERAL, dtlz2

POUND_FORCE_LIMITS = 1000.0, 300.0
"""Largest load and preload of the coil spring [lbf]."""

WIRES = (
    *(0.009, 0.0095, 0.0104, 0.0118, 0.0128, 0.0132, 0.014, 0.015, 0.0162, 0.0173, 0.018, 0.020, 0.023, 0.025, 0.028),
    *(0.032, 0.035, 0.041, 0.047, 0.054, 0.063, 0.072, 0.080, 0.092, 0.105, 0.120, 0.135, 0.148, 0.162, 0.177, 0.192),
    *(0.207, 0.225, 0.244, 0.263, 0.283, 0.307, 0.331, 0.362, 0.394, 0.4375, 0.500),
)
"""Diameters of spring wire that can be had [inch]."""

BARS = (
    *(0.2, 0.31, 0.4, 0.44, 0.6, 0.62, 0.79, 0.8, 0.88, 0.93, 1.0, 1.2, 1.24, 1.32, 1.4, 1.55, 1.58, 1.6, 1.76, 1.8),
    *(1.86, 2.0, 2.17, 2.2, 2.37, 2.4, 2.48, 2.6, 2.64, 2.79, 2.8, 3.0, 3.08, 3.1, 3.16, 3.41, 3.52, 3.6, 3.72, 3.95),
    *(3.96, 4.0, 4.03, 4.2, 4.34, 4.4, 4.65, 4.74, 4.8, 4.84, 5.0, 5.28, 5.4, 5.53, 5.72, 6.0, 6.16, 6.32, 6.6, 7.11),
    *(7.2, 7.8, 7.9, 8.0, 8.4, 8.69, 9.0, 9.48, 10.27, 11.0, 11.06, 11.85, 12.0, 13.0, 14.0, 15.0),
)
"""Areas of reinforcing bars that can be had [square inch]."""


def integer(low: int, high: int) -> dict[str, Any]:
    """Return an integer parameter."""
    return {"parameter_type": "integer", "values": [low, high]}


def real(low: float, high: float) -> dict[str, Any]:
    """Return a real parameter."""
    return {"parameter_type": "real", "values": [low, high]}


def switches(n: int) -> dict[str, Any]:
    """Return n parameters that are off or on."""
    return {f"s{i + 1}": {"parameter_type": "categorical", "values": ["off", "on"]} for i in range(n)}


def ackley_of_categories(X: FloatArray) -> FloatArray:
    """Return Ackley's function of five categories, each a value out of 17 from -1 to 1, and a real parameter [1]_.

    References
    ----------
    .. [1] Ru, Alvi, Nguyen, Osborne, Roberts. Bayesian Optimisation over Multiple Continuous and Categorical Inputs.
       ICML 2020.
    """
    return ackley(np.column_stack([X[:, :5] / 8 - 1, X[:, 5]]))


def fitness_landscape(X: FloatArray) -> FloatArray:
    """Return an NK landscape of 16 switches: the worth of each depends on itself and the four after it [1]_.

    The worths are drawn once, uniform on [-1, 0]; the value is their mean. The best of all 65536 is known.

    References
    ----------
    .. [1] Kauffman, Weinberger. The NK Model of Rugged Fitness Landscapes. Journal of Theoretical Biology, 1989.
    """
    n = X.shape[1]
    worth = -np.random.default_rng(0).random((n, 2**5))
    on = X.astype(int)
    cell = sum(np.roll(on, -k, axis=1) << k for k in range(5))
    return np.asarray(worth[np.arange(n), cell].mean(axis=1))


def autocorrelation(X: FloatArray) -> FloatArray:
    """Return the energy of sequences of signs: the sum of the squared autocorrelations of all lags [1]_.

    References
    ----------
    .. [1] Bernasconi. Low Autocorrelation Binary Sequences: Statistical Mechanics and Configuration Space Analysis.
       Journal de Physique, 1987.
    """
    sign, n = 2 * X - 1, X.shape[1]
    lags = [(sign[:, : n - k] * sign[:, k:]).sum(axis=1) for k in range(1, n)]
    return np.asarray(np.square(lags).sum(axis=0))


def vessel_cost(X: FloatArray) -> FloatArray:
    """Return the cost of a pressure vessel: plates in sixteenths of an inch, radius and length [inch] [1]_.

    References
    ----------
    .. [1] Sandgren. Nonlinear Integer and Discrete Programming in Mechanical Design Optimization. Journal of Mechanical
       Design, 1990. With the variant of Kannan and Kramer, 1994.
    """
    shell, head, radius, length = (X * [1 / 16, 1 / 16, 1, 1]).T
    plates = 0.6224 * shell * radius * length + 1.7781 * head * radius**2
    return plates + (3.1661 * length + 19.84 * radius) * shell**2


def vessel_holds(X: FloatArray) -> BoolArray:
    """Tell whether both plates stand the pressure and the vessel holds its 750 cubic feet: 40 % of the box."""
    shell, head, radius, length = (X * [1 / 16, 1 / 16, 1, 1]).T
    volume = np.pi * radius**2 * length + 4 / 3 * np.pi * radius**3
    return (shell >= 0.0193 * radius) & (head >= 0.00954 * radius) & (volume >= 1_296_000)


def spring_volume(X: FloatArray) -> FloatArray:
    """Return the volume of wire of a coil spring: coils, diameter and wire [inch] (Sandgren, 1990)."""
    coils, diameter, wire = X.T
    return np.pi**2 / 4 * diameter * wire**2 * (coils + 2)


def spring_holds(X: FloatArray) -> BoolArray:
    """Tell whether stress, lengths, sizes and deflections are within limits, as in 1.5 % of the box."""
    coils, diameter, wire = X.T
    index, (load, preload) = diameter / wire, POUND_FORCE_LIMITS
    correction = (4 * index - 1) / (4 * index - 4) + 0.615 / index
    stiffness = 11.5e6 * wire**4 / (8 * coils * diameter**3)
    free_length = load / stiffness + 1.05 * (coils + 2) * wire
    return (
        (8 * correction * load * diameter <= 189_000 * np.pi * wire**3)
        & (free_length <= 14)
        & (wire >= 0.2)
        & (index >= 3)
        & (preload / stiffness <= 6)
        & ((load - preload) / stiffness >= 1.25)
    )


def beam_cost(X: FloatArray) -> FloatArray:
    """Return the cost of a concrete beam: area of its bars, depth and breadth [inch] [1]_.

    References
    ----------
    .. [1] Amir, Hasegawa. Nonlinear Mixed-Discrete Structural Optimization. Journal of Structural Engineering, 1989.
    """
    area, depth, breadth = X.T
    return 29.4 * area + 0.6 * depth * breadth


def beam_holds(X: FloatArray) -> BoolArray:
    """Tell whether the beam bears its load and is no slimmer than four to one, as in 6 % of the box."""
    area, depth, breadth = X.T
    return (depth <= 4 * breadth) & (area * depth - 7.375 * area**2 / breadth >= 180)


def brake_objectives(X: FloatArray) -> FloatArray:
    """Return mass [kg] and stopping time [s] of a disc brake: radii [mm], force [N], surfaces [1]_.

    References
    ----------
    .. [1] Osyczka, Kundu. A New Method to Solve Generalized Multicriteria Optimization Problems Using the Simple
       Genetic Algorithm. Structural Optimization, 1995; Ray, Liew. A Swarm Metaphor for Multiobjective Design
       Optimization. Engineering Optimization, 2002.
    """
    inner, outer, force, surfaces = X.T
    mass = 4.9e-5 * (outer**2 - inner**2) * (surfaces - 1)
    lever = (outer**2 + outer * inner + inner**2) / (outer + inner)
    return np.column_stack([mass, 9.82e6 / (force * surfaces * lever)])


def brake_holds(X: FloatArray) -> BoolArray:
    """Tell whether size, pressure, temperature and torque are within limits, as in 34 % of the box."""
    inner, outer, force, surfaces = X.T
    squares, cubes = outer**2 - inner**2, outer**3 - inner**3
    return (
        (outer - inner >= 20)
        & (2.5 * (surfaces + 1) <= 30)
        & (force <= 0.4 * 3.14 * squares)
        & (2.22e-3 * force * cubes <= squares**2)
        & (2.66e-2 * force * surfaces * cubes >= 900 * squares)
    )


MIXED: Mapping[str, Problem] = {
    "ackley5c": Problem(
        function=one_objective(ackley_of_categories),
        parameters={
            **{f"c{i + 1}": {"parameter_type": "categorical", "values": list("abcdefghijklmnopq")} for i in range(5)},
            "x": real(-1, 1),
        },
        best=0.0,
    ),
    "hartmann6_mixed": Problem(
        function=one_objective(hartmann6),
        parameters={
            **real_parameters([(0, 1)] * 3),
            **{
                f"x{j}": {"parameter_type": "ordinal", "values": [round(0.1 * i, 1) for i in range(11)]}
                for j in (4, 5, 6)
            },
        },
        best=-3.253105230874216,
    ),
    "nk16": Problem(
        function=one_objective(fitness_landscape), parameters=switches(16), best=-0.787099736476065, evaluations=100
    ),
    "labs16": Problem(function=one_objective(autocorrelation), parameters=switches(16), best=24.0, evaluations=100),
    "pressure_vessel": Problem(
        function=one_objective(vessel_cost),
        parameters={
            "shell": integer(1, 99),
            "head": integer(1, 99),
            "radius": real(10, 200),
            "length": real(10, 200),
        },
        is_feasible=vessel_holds,
        best=6059.714335,
    ),
    "coil_spring": Problem(
        function=one_objective(spring_volume),
        parameters={
            "coils": integer(1, 70),
            "diameter": real(1, 3),
            "wire": {"parameter_type": "ordinal", "values": list(WIRES)},
        },
        is_feasible=spring_holds,
        best=2.658559,
    ),
    "concrete_beam": Problem(
        function=one_objective(beam_cost),
        parameters={
            "area": {"parameter_type": "ordinal", "values": list(BARS)},
            "depth": integer(28, 40),
            "breadth": real(5, 10),
        },
        is_feasible=beam_holds,
        best=359.208,
    ),
    "dtlz2_mixed": Problem(
        function=lambda X: dtlz2(X / [1, 1, 1, 8, 8, 8], 2),
        parameters={**real_parameters([(0, 1)] * 3), **{f"n{j}": integer(0, 8) for j in (1, 2, 3)}},
        reference_point=SEVERAL["dtlz2"].reference_point,
        best=SEVERAL["dtlz2"].best,
    ),
    "disc_brake": Problem(
        function=brake_objectives,
        parameters={
            "inner": real(55, 80),
            "outer": real(75, 110),
            "force": real(1000, 3000),
            "surfaces": integer(2, 20),
        },
        reference_point=(8.0, 30.0),
        is_feasible=brake_holds,
        best=215.0285,
    ),
}
