"""How the weights of a scalarization are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.objectives import Objective
from hypermap_lite.scalarization.base import Normalize
from hypermap_lite.typing import FloatArray, Rng

SMALLEST = 1e-2
"""Normalized objective values below this count as this, so that no weight takes everything."""


REST = 1e-6
"""Weight of each of the others where one objective counts alone: scalarizations may divide by it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dirichlet:
    """Weights from a symmetric Dirichlet distribution; alpha 1 is uniform on the simplex.

    Few of these draws look for the ends of a front, where much of one objective buys little of another; and where a
    front is known well, many ask for a trade-off that has been found. So a share of the draws may look at a single
    objective, as the corners of ParEGO's lattice do [1]_, and a draw that promises nothing may be made again.

    References
    ----------
    .. [1] Knowles. ParEGO: A Hybrid Algorithm with On-Line Landscape Approximation for Expensive Multiobjective
       Optimization Problems, sec. III. IEEE Trans. Evolutionary Computation, 2006.
    """

    alpha: float = 1.0

    ends: float = 0.0
    """Share of the draws that look at a single objective, in [0, 1]."""

    redraws: int = 0
    """New draws, at most, while the best point at the drawn trade-off promises next to nothing."""

    def __post_init__(self) -> None:
        if not self.alpha > 0:
            raise ScenarioError("$.alpha", f"the concentration is {self.alpha}", allowed="a number > 0")
        if not 0 <= self.ends <= 1:
            raise ScenarioError("$.ends", f"the share is {self.ends}", allowed="in [0, 1]")
        if self.redraws < 0:
            raise ScenarioError("$.redraws", f"there are {self.redraws} draws", allowed="an integer >= 0")

    def sample(self, objectives: Sequence[Objective], normalize: Normalize, rng: Rng) -> FloatArray:
        """Return m weights that sum to one, shape (m,)."""
        m = len(objectives)
        if self.ends and rng.random() < self.ends:
            weights = np.full(m, REST)
            weights[rng.integers(m)] += 1.0 - m * REST
            return weights
        return rng.dirichlet(np.full(m, self.alpha))


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

    redraws: ClassVar[int] = 0

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

    def sample(self, objectives: Sequence[Objective], normalize: Normalize, rng: Rng) -> FloatArray:
        """Return m weights that sum to one, shape (m,)."""
        target = np.array([o.sign * rng.uniform(self.limits[o.name][0], self.limits[o.name][1]) for o in objectives])
        weights = 1.0 / np.maximum(normalize(target), SMALLEST)
        return weights / weights.sum()
