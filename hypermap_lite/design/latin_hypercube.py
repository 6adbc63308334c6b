"""Latin hypercube sampling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.design.base import distinct
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class LatinHypercube:
    """One random point in each of n equal slices of every axis [1]_.

    References
    ----------
    .. [1] McKay, Beckman, Conover. A Comparison of Three Methods for Selecting Values of Input Variables in the
       Analysis of Output from a Computer Code. Technometrics, 1979.
    """

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""
        slices = np.column_stack([rng.permutation(n) for _ in range(space.dimension)])
        X = (slices + rng.random((n, space.dimension))) / n
        return distinct(space, X, n, lambda k: rng.random((k, space.dimension)), rng)
