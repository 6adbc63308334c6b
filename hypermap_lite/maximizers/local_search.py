"""Local search without gradients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.maximizers.base import (
    MaximizationProblem,
    Maximum,
    best_unseen,
    check_options,
    choose_starts,
    draw_candidates,
)
from hypermap_lite.maximizers.neighbours import climb


@dataclass(frozen=True, slots=True, kw_only=True)
class LocalSearch:
    """The best of many candidates, refined by one-exchange steps along every axis in both directions."""

    candidates: int = 1024
    """Sobol candidates; draws from the prior and perturbed incumbents come on top."""

    starts: int = 4
    """Candidates that are refined."""

    tolerance: float = 0.0
    """A climb ends where a step gains less than this share of what the best candidate is above the median one, >= 0."""

    def __post_init__(self) -> None:
        check_options(self.candidates, self.starts)
        if not 0 <= self.tolerance < 1:
            raise ScenarioError("$.tolerance", f"the tolerance is {self.tolerance}", allowed="in [0, 1)")

    def maximize(self, problem: MaximizationProblem) -> Maximum | None:
        """Return the best new point found; None if the space holds no other."""
        X = draw_candidates(problem, self.candidates)
        if not len(X):
            return None
        X, scores = problem.score_candidates(X)
        if problem.space.n_configurations <= self.candidates:
            return best_unseen(problem, X, scores)
        axes = np.ones(problem.space.dimension, dtype=bool)
        starts, finite = choose_starts(X, scores, self.starts), scores[np.isfinite(scores)]
        above = float(finite.max() - np.median(finite)) if len(finite) else 0.0
        refined, heights = climb(problem.space, problem.score, starts, axes, tolerance=self.tolerance * above)
        points = problem.space.snap(np.vstack([refined, X]))
        return best_unseen(problem, points, np.concatenate([heights, scores]))
