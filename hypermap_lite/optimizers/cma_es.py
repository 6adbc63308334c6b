"""CMA-ES on the black box itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError, positive_number
from hypermap_lite.maximizers.evolution_strategy import EvolutionStrategy, require_cma
from hypermap_lite.optimizers.fitness import check_weights
from hypermap_lite.optimizers.model_free import SearchState
from hypermap_lite.optimizers.streams import Stream
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, IntArray

ATTEMPTS = 20
"""Draws from the distribution until one is a new configuration."""

LEVEL_SHARE = 0.3
"""Least standard deviation along a discrete axis, in levels: below, all draws would be the same level."""

CONVERGED = 1e-5
"""Steps below this, in units of the cube, are not worth evaluations; it starts again elsewhere."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CmaEs:
    """Covariance matrix adaptation in the unit cube [1]_, from the best point of the initial design.

    The distribution is built anew for each suggestion, by telling the finished generations in the order of their
    trials; so it is a function of the history. When it has converged it starts again from a draw, with twice the
    population [2]_. Integers and ordinals are rounded. Evaluations without a usable result are worse than any other.

    References
    ----------
    .. [1] Hansen, Ostermeier. Completely Derandomized Self-Adaptation in Evolution Strategies. Evolutionary
       Computation, 2001.
    .. [2] Auger, Hansen. A Restart CMA Evolution Strategy with Increasing Population Size. CEC 2005.
    """

    sigma: float = 0.2
    """First standard deviation, in units of the parameters' ranges."""

    weights: Sequence[float] | None = None
    """Weight of each objective, scaled to sum to one; None for equal ones."""

    phase: ClassVar[str] = "cma_es"
    n_initial: ClassVar[int] = 0

    def __post_init__(self) -> None:
        positive_number(self.sigma, "$.sigma", "the standard deviation")
        check_weights(self.weights)

    def check(self, space: SearchSpace) -> None:
        """Raise a `ScenarioError` if a parameter has no order, or the package is missing."""
        for parameter in space.parameters:
            if not parameter.is_ordered:
                raise ScenarioError(
                    "$.type",
                    f"'{parameter.name}' has no order, and CMA-ES needs directions",
                    allowed="real, integer and ordinal parameters",
                    hint="Take the optimizer 'evolutionary' or 'local_search'.",
                )
        require_cma()

    def next_point(self, state: SearchState) -> FloatArray | None:
        """Return a new point of the current distribution; None if it has none left."""
        fitness = state.fitness(state.Y)
        if not np.isfinite(fitness).any():
            return None
        strategy = self._strategy(state, fitness)
        strategy.rng = state.generator(Stream.SUGGESTION, state.trial)
        for x in state.space.snap(strategy.ask(ATTEMPTS)):
            if state.is_new(x):
                return x
        return None

    def _strategy(self, state: SearchState, fitness: FloatArray) -> EvolutionStrategy:
        """Return the distribution after all finished generations."""
        own = np.array([i for i in range(len(state.X)) if state.phases[i] == self.phase], dtype=np.int64)
        start, n_restarts = self._start(state, fitness), 0
        strategy = self._fresh(state, start, n_restarts)
        while len(own) >= strategy.population:
            rows, own = own[: strategy.population], own[strategy.population :]
            strategy.rng = state.generator(Stream.SUGGESTION, int(rows[-1]))
            strategy.ask(1)  # the package wants every generation to begin with one
            strategy.tell(state.X[rows], finite(fitness, rows))
            if strategy.is_finished:
                n_restarts += 1
                drawn = state.prior.sample(1, state.generator(Stream.RESTART, n_restarts))[0]
                strategy = self._fresh(state, drawn, n_restarts)
        return strategy

    def _fresh(self, state: SearchState, start: FloatArray, n_restarts: int) -> EvolutionStrategy:
        d = len(start)
        population = int(4 + 3 * np.log(d)) * 2 ** min(n_restarts, 10)
        rng = state.generator(Stream.RESTART, n_restarts, 1)
        steps = np.array([0.0 if p.n_levels is None else LEVEL_SHARE / p.n_levels for p in state.space.parameters])
        return EvolutionStrategy(
            start, self.sigma, rng, population=population, tolerance=CONVERGED, smallest_steps=steps
        )

    def _start(self, state: SearchState, fitness: FloatArray) -> FloatArray:
        """Return the best of the first points, or where those gave nothing of all before the search; it stays so."""
        n_before = state.phases.index(self.phase) if self.phase in state.phases else len(fitness)
        usable = np.flatnonzero(np.isfinite(fitness))
        first = usable[usable < state.n_initial]
        usable = first if len(first) else usable[usable < n_before]
        return state.X[usable[np.argmin(fitness[usable])]]


def finite(fitness: FloatArray, rows: IntArray) -> FloatArray:
    """Return the fitness of some evaluations, shape (k,), infinite ones as worse than all finite ones of the run."""
    usable = fitness[np.isfinite(fitness)]
    return np.where(np.isfinite(fitness[rows]), fitness[rows], usable.max() + np.ptp(usable) + 1.0)
