"""How the weights of a scalarization are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.objectives import Objective
from hypermap_lite.scalarization.base import Normalization
from hypermap_lite.typing import FloatArray, Rng

SMALLEST = 1e-2
"""Normalized objective values below this count as this, so that no weight takes everything."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dirichlet:
    """Weights from a symmetric Dirichlet distribution; alpha 1 is uniform on the simplex."""

    alpha: float = 1.0

    def __post_init__(self) -> None:
        if not self.alpha > 0:
            raise ScenarioError("$.alpha", f"the concentration is {self.alpha}", allowed="a number > 0")

    def sample(self, objectives: Sequence[Objective], normalization: Normalization, rng: Rng) -> FloatArray:
        """Return m weights that sum to one, shape (m,)."""
        return rng.dirichlet(np.full(len(objectives), self.alpha))


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundingBox:
    """Weights that aim at a box of objective values the user is interested in [1]_.

    A point is drawn in the box; the weights are the inverse of its normalized coordinates, so that the search goes
    from the best value of each objective through that point.

    References
    ----------
    .. [1] Paria, Kandasamy, Poczos. A Flexible Framework for Multi-Objective Bayesian Optimization using Random
       Scalarizations. UAI 2019.
    """

    limits: Mapping[str, Sequence[float]]
    """For each objective, [low, high] in the user's units."""

    def __post_init__(self) -> None:
        for name, box in self.limits.items():
            if len(box) != 2 or not box[0] <= box[1] or not np.isfinite(box[1] - box[0]):
                raise ScenarioError(
                    f"$.limits.{name}", f"the box is {list(box)}", allowed="[low, high] with low <= high"
                )

    def check(self, objectives: Sequence[Objective]) -> None:
        """Raise a `ScenarioError` unless exactly the objectives have a box."""
        names = [objective.name for objective in objectives]
        for name in self.limits:
            if name not in names:
                known = ", ".join(names)
                raise ScenarioError(f"$.limits.{name}", "no such objective", allowed=known, hint=nearest(name, names))
        missing = [name for name in names if name not in self.limits]
        if missing:
            raise ScenarioError("$.limits", f"no box for {missing[0]!r}", allowed="[low, high] for every objective")

    def sample(self, objectives: Sequence[Objective], normalization: Normalization, rng: Rng) -> FloatArray:
        """Return m weights that sum to one, shape (m,)."""
        target = np.array([o.sign * rng.uniform(self.limits[o.name][0], self.limits[o.name][1]) for o in objectives])
        weights = 1.0 / np.maximum(normalization(target), SMALLEST)
        return weights / weights.sum()
