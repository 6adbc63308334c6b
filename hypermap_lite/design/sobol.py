"""Scrambled Sobol points."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.design.base import distinct
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.quasi_random import sobol_points
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng

OVERSAMPLING = 32
"""Times as many points as are wanted are looked at where constraints reject some."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sobol:
    """Owen-scrambled Sobol sequence [1]_: fills the space more evenly than random points.

    References
    ----------
    .. [1] Owen. Scrambling Sobol' and Niederreiter-Xing Points. Journal of Complexity, 1998.
    """

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""
        X = sobol_points(OVERSAMPLING * n if space.constraints else n, space.dimension, rng)
        return distinct(space, X, n, lambda k: rng.random((k, space.dimension)), rng)
