"""Rough functions: more waves or steps than sixty evaluations can tell apart, most over a slope that they can."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .base import FloatArray, Problem, one_objective, real_parameters

MINIMIZER = np.array([0.7, -1.3, 2.1, -2.6, 1.6])
"""Of Rastrigin's, Griewank's and Weierstrass's functions and of the steps, in as many dimensions as they have."""


def rastrigin(X: FloatArray) -> FloatArray:
    """Return Rastrigin's function: ten waves along each axis over a paraboloid, shape (n,)."""
    Z = X - MINIMIZER[: X.shape[1]]
    return np.asarray((Z**2 - 10 * np.cos(2 * np.pi * Z) + 10).sum(axis=1))


def griewank(X: FloatArray) -> FloatArray:
    """Return Griewank's function [1]_, shape (n,): waves of height 2 over a paraboloid.

    In a box a tenth as wide as the usual one, in whose corners the paraboloid reaches 4.

    References
    ----------
    .. [1] Griewank. Generalized Descent for Global Optimization. JOTA, 1981.
    """
    Z = X - MINIMIZER[: X.shape[1]]
    waves = np.cos(Z / np.sqrt(np.arange(1, X.shape[1] + 1))).prod(axis=1)
    return np.asarray((Z**2).sum(axis=1) / 4000 - waves + 1)


def lunacek(X: FloatArray) -> FloatArray:
    """Return Lunacek's function of two paraboloids, of which the wider one is not the deeper one, with waves [1]_.

    With waves a fifth as high as there; shape (n,).

    References
    ----------
    .. [1] Lunacek, Whitley, Sutton. The Impact of Global Structure on Search. PPSN 2008.
    """
    d, first = X.shape[1], 2.5
    s = 1 - 1 / (2 * np.sqrt(d + 20) - 8.2)
    second = -np.sqrt((first**2 - 1) / s)
    Z = X - first
    bowls = np.minimum((Z**2).sum(axis=1), d + s * ((X - second) ** 2).sum(axis=1))
    return np.asarray(bowls + 2 * (1 - np.cos(2 * np.pi * Z)).sum(axis=1))


def weierstrass(X: FloatArray) -> FloatArray:
    """Return Weierstrass's function to twelve terms: waves on waves, shape (n,), with a period of five."""
    Z, k = (X - MINIMIZER[: X.shape[1]]) / 5, np.arange(12)
    waves = 0.5**k * np.cos(2 * np.pi * 3.0**k * (Z[:, :, None] + 0.5))
    lowest = (0.5**k * np.cos(np.pi * 3.0**k)).sum()
    return np.asarray(10 * (waves.sum(axis=2).mean(axis=1) - lowest) ** 3)


def steps(X: FloatArray) -> FloatArray:
    """Return an ellipsoid of plateaus, shape (n,): one wide along each axis, and a tenth near the minimizer.

    Its coefficients are 0.1 to 10. Much like function 7 of [1]_, but with a plateau as its minimum.

    References
    ----------
    .. [1] Hansen et al. Real-Parameter Black-Box Optimization Benchmarking 2009, function 7. INRIA, 2009.
    """
    d = X.shape[1]
    Z = X - MINIMIZER[:d]
    Z = np.where(np.abs(Z) > 0.5, np.round(Z), np.round(10 * Z) / 10)
    return np.asarray(0.1 * (10 ** (2 * np.arange(d) / (d - 1)) * Z**2).sum(axis=1))


def zdt4(X: FloatArray) -> FloatArray:
    """Return problem 4 of Zitzler, Deb and Thiele (2000) on the unit cube, shape (n, 2), with twenty waves."""
    Z = 10 * X[:, 1:] - 5
    g = 1 + (Z**2 - 10 * np.cos(4 * np.pi * Z) + 10).sum(axis=1)
    return np.column_stack([X[:, 0], g * (1 - np.sqrt(X[:, 0] / g))])


def _waves(function: object, dimension: int, width: float) -> Problem:
    assert callable(function)
    bounds = [(-width, width)] * dimension
    return Problem(function=one_objective(function), parameters=real_parameters(bounds), best=0.0)


ROUGH: Mapping[str, Problem] = {
    "rastrigin4": _waves(rastrigin, 4, 5.12),
    "griewank4": _waves(griewank, 4, 60.0),
    "lunacek4": _waves(lunacek, 4, 5.0),
    "weierstrass3": _waves(weierstrass, 3, 5.0),
    "steps5": _waves(steps, 5, 5.0),
    "zdt4": Problem(
        function=zdt4, parameters=real_parameters([(0, 1)] * 4), reference_point=(1.1, 30.0), best=32 + 2 / 3
    ),
}
"""Of ZDT4 the front is f2 = 1 - sqrt(f1): it takes 1/3 of the 30 up to f1 = 1, and nothing of 30 times 0.1 beyond."""
