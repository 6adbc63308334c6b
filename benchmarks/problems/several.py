"""Problems with two and three objectives, of known reference points and largest hypervolumes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from .base import FloatArray, Problem, real_parameters
from .formulas import branin, currin
from .penicillin import penicillin


def branin_currin(X: FloatArray) -> FloatArray:
    """Return Branin, on its own square, and Currin's function at points of the unit square (Belakaria et al. 2019)."""
    return np.column_stack([branin(X * 15 + [-5, 0]), currin(X)])


def zdt2(X: FloatArray) -> FloatArray:
    """Return ZDT2 (Zitzler, Deb, Thiele 2000), whose front is f2 = 1 - f1^2."""
    g = 1 + 9 * X[:, 1:].mean(axis=1)
    return np.column_stack([X[:, 0], g * (1 - (X[:, 0] / g) ** 2)])


def dtlz2(X: FloatArray, m: int) -> FloatArray:
    """Return DTLZ2 (Deb, Thiele, Laumanns, Zitzler 2005): its front is the unit sphere between the axes."""
    radius = 1 + ((X[:, m - 1 :] - 0.5) ** 2).sum(axis=1)
    angles = X[:, : m - 1] * math.pi / 2
    columns = []
    for k in range(m):
        column = radius * np.cos(angles[:, : m - 1 - k]).prod(axis=1)
        columns.append(column * np.sin(angles[:, m - 1 - k]) if k else column)
    return np.column_stack(columns)


def vehicle_safety(X: FloatArray) -> FloatArray:
    """Return mass, acceleration and intrusion of a car's front in a crash, by five thicknesses [1]_.

    References
    ----------
    .. [1] Tanabe, Ishibuchi. An Easy-to-Use Real-World Multi-Objective Optimization Problem Suite. Applied Soft
       Computing, 2020. Problem RE3-5-4.
    """
    a, b, c, d, e = X.T
    mass = 1640.2823 + 2.3573285 * a + 2.3220035 * b + 4.5688768 * c + 7.7213633 * d + 4.4559504 * e
    acceleration = 6.5856 + 1.15 * a - 1.0427 * b + 0.9738 * c + 0.8364 * d
    acceleration += -0.3695 * a * d + 0.0861 * a * e + 0.3628 * b * d - 0.1106 * a**2 - 0.3437 * c**2 + 0.1764 * d**2
    intrusion = -0.0551 + 0.0181 * a + 0.1024 * b + 0.0421 * c - 0.0073 * a * b + 0.024 * b * c - 0.0118 * b * d
    intrusion += -0.0204 * c * d - 0.008 * c * e - 0.0241 * b**2 + 0.0109 * d**2
    return np.column_stack([mass, acceleration, intrusion])


BRANIN_CURRIN = Problem(
    function=branin_currin,
    parameters=real_parameters([(0, 1)] * 2),
    reference_point=(18.0, 6.0),
    best=59.36011874867746,
)

SEVERAL: Mapping[str, Problem] = {
    "branin_currin": BRANIN_CURRIN,
    "branin_currin_noisy": replace(BRANIN_CURRIN, noise=0.1),
    "zdt2": Problem(
        function=zdt2, parameters=real_parameters([(0, 1)] * 6), reference_point=(11.0, 11.0), best=120 + 1 / 3
    ),
    "dtlz2": Problem(
        function=lambda X: dtlz2(X, 2),
        parameters=real_parameters([(0, 1)] * 6),
        reference_point=(1.1, 1.1),
        best=1.1**2 - math.pi / 4,
    ),
    "dtlz2_m3": Problem(
        function=lambda X: dtlz2(X, 3),
        parameters=real_parameters([(0, 1)] * 6),
        reference_point=(1.1, 1.1, 1.1),
        best=1.1**3 - math.pi / 6,
    ),
    "vehicle_safety": Problem(
        function=vehicle_safety,
        parameters=real_parameters([(1, 3)] * 5),
        reference_point=(1864.72022, 11.81993945, 0.2903999384),
        best=246.81607081187002,
    ),
    "penicillin": Problem(
        function=penicillin,
        parameters=real_parameters([(60, 120), (0.05, 18), (293, 303), (0.05, 18), (0.01, 0.5), (500, 700), (5, 6.5)]),
        reference_point=(25.935, 57.612, 935.5),
        best=2183455.909507436,
    ),
}
