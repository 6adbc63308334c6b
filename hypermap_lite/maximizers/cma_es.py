"""CMA-ES on the acquisition function."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import positive_number
from hypermap_lite.maximizers.base import (
    MaximizationProblem,
    Maximum,
    best_unseen,
    check_options,
    choose_starts,
    draw_candidates,
)
from hypermap_lite.maximizers.evolution_strategy import EvolutionStrategy, require_cma
from hypermap_lite.maximizers.local_search import LocalSearch
from hypermap_lite.typing import FloatArray

MAX_GENERATIONS = 100
"""Per start and parameter."""

WORST = 1e10
"""Stands for minus a score that is not finite."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CmaEs:
    """The best of many candidates, refined by CMA-ES in the unit cube [1]_.

    Spaces with a parameter that is not real are left to `LocalSearch`.

    References
    ----------
    .. [1] Hansen, Ostermeier. Completely Derandomized Self-Adaptation in Evolution Strategies. Evolutionary
       Computation, 2001.
    """

    candidates: int = 1024
    """Sobol candidates; draws from the prior and perturbed incumbents come on top."""

    starts: int = 1
    """Candidates that are refined."""

    sigma: float = 0.2
    """First standard deviation, in units of the parameters' ranges."""

    def __post_init__(self) -> None:
        check_options(self.candidates, self.starts)
        positive_number(self.sigma, "$.sigma", "the standard deviation")
        require_cma()

    def maximize(self, problem: MaximizationProblem) -> Maximum | None:
        """Return the best new point found; None if the space holds no other."""
        if not problem.space.is_continuous.all():
            return LocalSearch(candidates=self.candidates, starts=max(self.starts, 4)).maximize(problem)
        X = draw_candidates(problem, self.candidates)
        scores = problem.score(X)
        climbs = [self._climb(problem, x) for x in choose_starts(X, scores, self.starts)]
        points = np.vstack([*climbs, X])
        return best_unseen(problem, points, problem.score(points))

    def _climb(self, problem: MaximizationProblem, start: FloatArray) -> FloatArray:
        """Return the best point of every generation, shape (k, d)."""
        strategy = EvolutionStrategy(start, self.sigma, problem.rng)
        best = []
        for _ in range(MAX_GENERATIONS * problem.space.dimension):
            X = strategy.ask(strategy.population)
            scores = np.where(problem.space.is_allowed(X), problem.score(X), -np.inf)
            best.append(X[np.argmax(scores)])
            strategy.tell(X, np.where(np.isfinite(scores), -scores, WORST))
            if strategy.is_finished:
                break
        return np.array(best)
