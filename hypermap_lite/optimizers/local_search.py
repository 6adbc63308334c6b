"""Local search on the black box itself: hill climbs by one-exchange steps, from the best of some first points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.maximizers.neighbours import REAL_STEPS, neighbours
from hypermap_lite.optimizers.fitness import check_weights
from hypermap_lite.optimizers.model_free import SearchState
from hypermap_lite.optimizers.streams import Stream
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray

IMPROVEMENTS = ("first", "best")


@dataclass(frozen=True, slots=True, kw_only=True)
class HillClimbing:
    """Climbs by exchanging one parameter's value at a time, along every axis in both directions [1]_.

    It starts from the best of the first points, moves to a neighbour that is better, and at a local optimum goes on
    from the next best of the first points, then from random ones. Neighbours at about the distance of the last move
    come first. Evaluations without a usable result are worse than any other.

    References
    ----------
    .. [1] Hoos, Stutzle. Stochastic Local Search: Foundations and Applications, ch. 1-2. Morgan Kaufmann, 2004.
    """

    random_points: int = 10
    """Points evaluated before the first climb, those of the initial design included."""

    weights: Sequence[float] | None = None
    """Weight of each objective, scaled to sum to one; None for equal ones."""

    improvement: str = "first"
    """``first`` moves to the first neighbour found to be better, ``best`` to the best of all."""

    phase: ClassVar[str] = "climb"

    def __post_init__(self) -> None:
        if self.random_points < 1:
            raise ScenarioError("$.random_points", f"there are {self.random_points} points", allowed="an integer >= 1")
        if self.improvement not in IMPROVEMENTS:
            hint = nearest(self.improvement, IMPROVEMENTS)
            problem = f"unknown rule {self.improvement!r}"
            raise ScenarioError("$.improvement", problem, allowed=", ".join(IMPROVEMENTS), hint=hint)
        check_weights(self.weights)

    @property
    def n_initial(self) -> int:
        """The random points."""
        return self.random_points

    def check(self, space: SearchSpace) -> None:
        """Accept any space."""

    def next_point(self, state: SearchState) -> FloatArray | None:
        """Return the next neighbour to try; None where every climb is at its end."""
        fitness = state.fitness(state.Y)
        known = dict(zip(state.space.keys(state.X), enumerate(fitness), strict=True))
        visited: set[bytes] = set()
        for i in np.argsort(fitness, kind="stable"):
            if state.phases[i] != self.phase and np.isfinite(fitness[i]):
                x = self._climb(state, state.X[i], known, visited)
                if x is not None:
                    return x
        return None

    def _climb(
        self, state: SearchState, x: FloatArray, known: Mapping[bytes, tuple[int, float]], visited: set[bytes]
    ) -> FloatArray | None:
        """Follow a climb over what is known to the first neighbour that is not; None at its end."""
        step = REAL_STEPS[0]
        (key,) = state.space.keys(x[None])
        while key not in visited:
            visited.add(key)
            trial, value = known[key]
            around = self._neighbours(state, x, trial, step)
            keys = state.space.keys(around)
            better = [i for i, k in enumerate(keys) if k in known and known[k][1] < value]
            end = better[0] if better and self.improvement == "first" else len(keys)
            for i in range(end):
                if keys[i] not in state.taken and state.is_new(around[i]):
                    return around[i]
            if not better:
                return None
            chosen = better[0] if self.improvement == "first" else min(better, key=lambda i: known[keys[i]][1])
            step = _distances(state.space, x, around[chosen][None], step)[0]
            x, key = around[chosen], keys[chosen]
        return None

    @staticmethod
    def _neighbours(state: SearchState, x: FloatArray, trial: int, step: float) -> FloatArray:
        """Return the neighbours of an evaluated point in the order in which they are tried, shape (k, d)."""
        around = state.space.snap(neighbours(state.space, x, np.ones(state.space.dimension, dtype=bool)))
        around = around[(around != x).any(axis=1)]
        around = state.generator(Stream.NEIGHBOURS, trial).permutation(around)
        apart = np.abs(np.log(_distances(state.space, x, around, step) / step))
        return np.asarray(around[np.argsort(apart, kind="stable")])


def _distances(space: SearchSpace, x: FloatArray, X: FloatArray, step: float) -> FloatArray:
    """Return how far n neighbours are, shape (n,); `step` where a category is exchanged, which is no distance."""
    moved = np.abs(X - x)
    return np.where(moved[:, ~space.is_ordered].any(axis=1), step, moved.max(axis=1))
