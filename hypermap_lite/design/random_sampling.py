"""Uniform random points."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.design.base import distinct
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class RandomSampling:
    """Independent uniform draws; priors play no part."""

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""

        def draw(k: int) -> FloatArray:
            return rng.random((k, space.dimension))

        return distinct(space, draw(n), n, draw, rng)
