"""Branin and Currin on one unit square: what is good for one is not good for the other."""

import math
from collections.abc import Mapping


def evaluate(configuration: Mapping[str, float]) -> tuple[float, float]:
    """Return both functions at one configuration, in the order of the scenario's objectives."""
    x1, x2 = configuration["x1"], configuration["x2"]
    return branin(15 * x1 - 5, 15 * x2), currin(x1, x2)


def branin(x1: float, x2: float) -> float:
    """Return Branin on its own square, [-5, 10] x [0, 15]."""
    bend = x2 - 5.1 / (4 * math.pi**2) * x1**2 + 5 / math.pi * x1 - 6
    return bend**2 + 10 * (1 - 1 / (8 * math.pi)) * math.cos(x1) + 10


def currin(x1: float, x2: float) -> float:
    """Return the exponential function of Currin et al. (1988) on the unit square."""
    damping = 1 - math.exp(-1 / (2 * x2)) if x2 > 0 else 1.0
    return damping * (2300 * x1**3 + 1900 * x1**2 + 2092 * x1 + 60) / (100 * x1**3 + 500 * x1**2 + 4 * x1 + 20)
