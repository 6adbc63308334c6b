"""Functions of one objective, over the last axis of an array; their minima are in `problems/single.py`."""

from __future__ import annotations

import numpy as np

from .base import FloatArray

HARTMANN_ALPHA = np.array([1.0, 1.2, 3.0, 3.2])
HARTMANN_A = np.array(
    [
        [10, 3, 17, 3.5, 1.7, 8],
        [0.05, 10, 17, 0.1, 8, 14],
        [3, 3.5, 1.7, 10, 17, 8],
        [17, 8, 0.05, 10, 0.1, 14],
    ]
)
HARTMANN_P = 1e-4 * np.array(
    [
        [1312, 1696, 5569, 124, 8283, 5886],
        [2329, 4135, 8307, 3736, 1004, 9991],
        [2348, 1451, 3522, 2883, 3047, 6650],
        [4047, 8828, 8732, 5743, 1091, 381],
    ]
)
HARTMANN6_MINIMIZER = np.array([0.20168952, 0.15001069, 0.47687398, 0.27533243, 0.31165162, 0.65730054])


def branin(X: FloatArray) -> FloatArray:
    """Return Branin's function (Dixon and Szego 1978) on [-5, 10] x [0, 15]."""
    a, b = X[..., 0], X[..., 1]
    curve = b - 5.1 / (4 * np.pi**2) * a * a + 5 / np.pi * a - 6
    return curve**2 + 10 * (1 - 1 / (8 * np.pi)) * np.cos(a) + 10


def currin(X: FloatArray) -> FloatArray:
    """Return the exponential function of Currin et al. (1991) on the unit square, with its limit at x2 = 0."""
    a, b = X[..., 0], X[..., 1]
    damping = 1 - np.exp(-1 / (2 * np.maximum(b, 1e-9)))
    return damping * (2300 * a**3 + 1900 * a**2 + 2092 * a + 60) / (100 * a**3 + 500 * a**2 + 4 * a + 20)


def hartmann6(X: FloatArray) -> FloatArray:
    """Return Hartmann's function in six dimensions (Dixon and Szego 1978) on the unit cube."""
    distance = (HARTMANN_A * (X[..., None, :] - HARTMANN_P) ** 2).sum(axis=-1)
    return -(np.exp(-distance) @ HARTMANN_ALPHA)


def ackley(X: FloatArray) -> FloatArray:
    """Return Ackley's function (1987); zero at the origin."""
    ridge = -20 * np.exp(-0.2 * np.sqrt(np.mean(X * X, axis=-1)))
    return ridge - np.exp(np.mean(np.cos(2 * np.pi * X), axis=-1)) + 20 + np.e


def levy(X: FloatArray) -> FloatArray:
    """Return Levy's function; zero at (1, ..., 1)."""
    w = 1 + (X - 1) / 4
    first, middle, last = w[..., 0], w[..., :-1], w[..., -1]
    waves = ((middle - 1) ** 2 * (1 + 10 * np.sin(np.pi * middle + 1) ** 2)).sum(axis=-1)
    return np.sin(np.pi * first) ** 2 + waves + (last - 1) ** 2 * (1 + np.sin(2 * np.pi * last) ** 2)


def rosenbrock(X: FloatArray) -> FloatArray:
    """Return Rosenbrock's function (1960); zero at (1, ..., 1)."""
    return (100 * (X[..., 1:] - X[..., :-1] ** 2) ** 2 + (1 - X[..., :-1]) ** 2).sum(axis=-1)


def six_hump_camel(X: FloatArray) -> FloatArray:
    """Return the six-hump camel function (Dixon and Szego 1978)."""
    a, b = X[..., 0], X[..., 1]
    return (4 - 2.1 * a**2 + a**4 / 3) * a**2 + a * b + (4 * b**2 - 4) * b**2


def beale(X: FloatArray) -> FloatArray:
    """Return Beale's function; zero at (3, 0.5)."""
    a, b = X[..., 0], X[..., 1]
    return (1.5 - a + a * b) ** 2 + (2.25 - a + a * b**2) ** 2 + (2.625 - a + a * b**3) ** 2


def goldstein_price(X: FloatArray) -> FloatArray:
    """Return Goldstein and Price's function (1971) on [-2, 2]^2, between 3, at (0, -1), and 1e6."""
    a, b = X[..., 0], X[..., 1]
    first = 1 + (a + b + 1) ** 2 * (19 - 14 * a + 3 * a**2 - 14 * b + 6 * a * b + 3 * b**2)
    second = 30 + (2 * a - 3 * b) ** 2 * (18 - 32 * a + 12 * a**2 + 48 * b - 36 * a * b + 27 * b**2)
    return first * second


def zakharov(X: FloatArray) -> FloatArray:
    """Return Zakharov's function, usually on [-5, 10]^d, between 0, at 0, and 4e6 in four dimensions."""
    weighted = 0.5 * (np.arange(1, X.shape[-1] + 1) * X).sum(axis=-1)
    return (X**2).sum(axis=-1) + weighted**2 + weighted**4
