"""Draws from the user's prior."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.design.base import distinct
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorSampling:
    """Independent draws from the prior; uniform along axes without one."""

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""

        def draw(k: int) -> FloatArray:
            return prior.sample(k, rng)

        return distinct(space, draw(n), n, draw, rng)
