"""What the model foresees all over the space: where a front may end that has not been reached yet."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from hypermap_lite.history.history import History
from hypermap_lite.objectives import stated_or
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.pareto.hypervolume import infer_reference_point
from hypermap_lite.quasi_random import sobol_points
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.surrogates.base import Predictor
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.typing import FloatArray, Rng

SPREAD_POINTS: Final = 512
"""Points at which the ideal values of a constrained problem, and the ends of a front, are looked for."""

MAX_SPREAD_DRAWS: Final = 8192
"""Draws at most to find as many that known constraints allow."""

SURE: Final = 0.1
"""Standard deviation, as a share of the front's range, below which a prediction may move the reference point."""


def spread_points(space: SearchSpace, rng: Rng) -> FloatArray:
    """Return allowed points all over the space, shape (n, d)."""
    return space.draw(SPREAD_POINTS, lambda n: sobol_points(n, space.dimension, rng), MAX_SPREAD_DRAWS)


def foreseen_reference_point(
    posterior: Predictor, feasibility: FeasibilityPosterior | None, history: History, rng: Rng
) -> FloatArray:
    """Return the reference point of the front that the model foresees, shape (m,).

    That of the evaluated points alone would give nothing for an end of the front far from all of them. Only what is
    predicted well counts: at the beginning a model foresees ends that are none.
    """
    X = spread_points(history.space, rng)
    if feasibility is not None:
        X = X[feasibility.log_probability(X) > math.log(0.5)]
    evaluated, foreseen = posterior.predict(history.X()).mean, posterior.predict(X)
    is_sure = (foreseen.std < SURE * np.ptp(evaluated[non_dominated(evaluated)], axis=0)).all(axis=1)
    inferred = infer_reference_point(np.vstack([evaluated, foreseen.mean[is_sure]]))
    return stated_or(history.objectives, inferred)
