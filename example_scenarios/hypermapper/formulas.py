"""The synthetic problems of this folder as functions of numbers; all objectives are to be minimized."""

import math
from collections.abc import Sequence


def branin(x1: float, x2: float) -> float:
    """Return the Branin function on [-5, 10] x [0, 15].

    Its three minima, 0.397887, are at (-pi, 12.275), (pi, 2.275) and (3 pi, 2.475).

    References
    ----------
    Dixon, Szego. The Global Optimization Problem: An Introduction. 1978.
    """
    bend = x2 - 5.1 / (4 * math.pi**2) * x1**2 + 5 / math.pi * x1 - 6
    return bend**2 + 10 * (1 - 1 / (8 * math.pi)) * math.cos(x1) + 10


def currin(x1: float, x2: float) -> float:
    """Return the exponential function of Currin et al. on [0, 1] x (0, 1].

    Its smallest value, 1.1804, is at (0, 1).

    References
    ----------
    Currin, Mitchell, Morris, Ylvisaker. Bayesian Prediction of Deterministic Functions. JASA 1991.
    """
    damping = 1 - math.exp(-1 / (2 * x2))
    return damping * (2300 * x1**3 + 1900 * x1**2 + 2092 * x1 + 60) / (100 * x1**3 + 500 * x1**2 + 4 * x1 + 20)


def chakong_haimes(x1: float, x2: float) -> tuple[float, float, bool]:
    """Return the two objectives of Chankong and Haimes on [-20, 20]^2, and whether both constraints hold.

    16.2 % of the square is feasible.

    References
    ----------
    Chankong, Haimes. Multiobjective Decision Making: Theory and Methodology. 1983.
    """
    f1 = 2 + (x1 - 2) ** 2 + (x2 - 1) ** 2
    f2 = 9 * x1 - (x2 - 1) ** 2
    return f1, f2, x1**2 + x2**2 <= 225 and x1 - 3 * x2 + 10 <= 0


def dtlz1(x: Sequence[float]) -> tuple[float, float]:
    """Return the two objectives of DTLZ1 on [0, 1]^n with a ripple of one period per axis.

    On the front every coordinate but the first is 0.5, and the objectives sum to 0.5.

    References
    ----------
    Knowles. ParEGO: A Hybrid Algorithm with On-Line Landscape Approximation for Expensive Multiobjective
    Optimization Problems. IEEE Trans. Evolutionary Computation, 2006. Section IV.
    """
    centred = [xi - 0.5 for xi in x[1:]]
    g = 100 * (len(centred) + sum(c**2 - math.cos(2 * math.pi * c) for c in centred))
    return 0.5 * x[0] * (1 + g), 0.5 * (1 - x[0]) * (1 + g)
