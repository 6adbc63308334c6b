"""Draws from the user's prior."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.design.base import distinct
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.quasi_random import sobol_points
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import BoolArray, FloatArray, Rng

UNIFORM = -1
"""Origin of a point that has nothing to do with the prior."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorSampling:
    """Independent draws from the prior, uniform along axes without one, and Sobol points among them.

    Where the prior misleads, its draws lie close to each other and tell the model nothing about the rest of the space.
    """

    uniform_share: float = 0.25
    """Share of the points that are of a Sobol sequence over the whole space, in [0, 1]; the last of every four, say."""

    def __post_init__(self) -> None:
        if not 0 <= self.uniform_share <= 1:
            raise ScenarioError("$.uniform_share", f"the share is {self.uniform_share}", allowed="in [0, 1]")

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""

        def draw(k: int) -> FloatArray:
            return prior.sample(k, rng)

        X, _ = self._drawn(space, prior, n, rng)
        return distinct(space, X, n, draw, rng)

    def origins(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> dict[bytes, int]:
        """Return where the points that `points` draws first come from, by their keys.

        Returns
        -------
        dict
            The running number of a draw from the prior, or `UNIFORM`. Points that took the place of repeats or of
            forbidden ones are missing.
        """
        X, is_uniform = self._drawn(space, prior, n, rng)
        return {
            key: UNIFORM if uniform else i
            for i, (key, uniform) in enumerate(zip(space.keys(space.snap(X)), is_uniform, strict=True))
        }

    def _drawn(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> tuple[FloatArray, BoolArray]:
        """Return n points, shape (n, d), not yet checked, and which of them are of the Sobol sequence, shape (n,)."""
        X = prior.sample(n, rng)
        is_uniform = evenly_spread(n, 0.0 if prior.is_uniform else self.uniform_share)
        evenly = space.draw(int(is_uniform.sum()), lambda k: sobol_points(k, space.dimension, rng))
        is_uniform[np.flatnonzero(is_uniform)[len(evenly) :]] = False
        X[is_uniform] = evenly
        return X, is_uniform


def evenly_spread(n: int, share: float) -> BoolArray:
    """Mark a share of n places, rounded to the nearest number, half up, and spread evenly, shape (n,)."""
    k = int(share * n + 0.5)
    return np.diff(np.arange(n + 1) * k // max(n, 1)) > 0
