"""Problems whose values span decades: functions that do so by themselves, and penalties for failures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from .base import FloatArray, Problem, one_objective, real_parameters
from .emulated import EMULATED
from .formulas import HARTMANN6_MINIMIZER, goldstein_price, hartmann6, zakharov
from .plateau import PLATEAU, TIME_OUT, plateau
from .single import HARTMANN6

PENALTY = 1e4
"""What a failure is worth."""

PEG_PENALTY = 1e6
"""The same for the peg, whose objectives are thousands."""

REACH = 0.6
"""Distance from its minimizer up to which penalized Hartmann-6 does not fail."""


def hartmann6_penalized(X: FloatArray) -> FloatArray:
    """Return Hartmann-6 near its minimizer, in 11 % of the cube, and the penalty elsewhere, shape (n,)."""
    distance = np.linalg.norm(X - HARTMANN6_MINIMIZER, axis=1)
    return np.where(distance <= REACH, hartmann6(X), PENALTY)


def plateau_penalized(X: FloatArray) -> FloatArray:
    """Return the plateau's duration and effort, with the penalty as the duration of failures, shape (n, 2)."""
    Y = plateau(X)
    Y[Y[:, 0] == TIME_OUT, 0] = PENALTY
    return Y


def peg_penalized(X: FloatArray) -> FloatArray:
    """Return peg insertion as emulated, with its penalty for both where the first is out of reach, shape (n, 2)."""
    known = EMULATED["peg_insertion_emulated"]
    Y = known.function(X)
    assert known.reference_point is not None
    return np.where(Y[:, :1] < known.reference_point[0], Y, PEG_PENALTY)


TAILS: Mapping[str, Problem] = {
    "goldstein_price": Problem(
        function=one_objective(goldstein_price), parameters=real_parameters([(-2, 2)] * 2), best=3.0, evaluations=40
    ),
    "zakharov4": Problem(function=one_objective(zakharov), parameters=real_parameters([(-5, 10)] * 4), best=0.0),
    "hartmann6_penalized": replace(HARTMANN6, function=one_objective(hartmann6_penalized)),
    "plateau_penalized": replace(PLATEAU, function=plateau_penalized, best=1.46),
    **(
        {"peg_insertion_penalized": replace(EMULATED["peg_insertion_emulated"], function=peg_penalized)}
        if EMULATED
        else {}
    ),
}
"""The plateau's front is that of its successes alone: doing nothing, which adds 0.01, is penalized."""
