"""Gradient ascent from several starts at once, alternating with one-exchange steps on discrete axes."""

from __future__ import annotations

import math
import sys
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
from hypermap_lite.maximizers.local_search import LocalSearch
from hypermap_lite.maximizers.neighbours import climb
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import BoolArray, FloatArray

MAX_ITERATIONS = 50
"""Of L-BFGS-B, for all starts together."""

ROUNDS = 3
"""Alternations between real and discrete axes."""

LAST_DIGITS = 1e7 * sys.float_info.epsilon
"""Share of the scores that no step has to add less than, as SciPy has it."""

BISECTIONS = 30
"""Halvings of the way from a start to a point beyond what is allowed."""

WORST = -1e10
"""Stands for scores that are not finite."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MultistartGradient:
    """The best of many candidates, refined by L-BFGS-B on the real axes and one-exchange steps on the others, in turn.

    No combinations are enumerated: a step changes one axis, so twenty axes of ten levels have 180 neighbours. Integers
    and ordinals of many levels take part in both: the ascent leads them far, the steps to the right level. An ascent
    that leaves what constraints allow ends at their edge; steps on all axes go on from there.

    All starts are one problem, the sum of their scores, so that each step evaluates them together. Once that gets slow,
    the best of them goes on alone, in fewer and cheaper steps. A score without gradient is left to `LocalSearch`.
    """

    candidates: int = 1024
    """Sobol candidates; draws from the prior and perturbed incumbents come on top."""

    starts: int = 4
    """Candidates that are refined."""

    smooth_levels: int = 50
    """From so many levels on an ordered discrete axis is climbed as if real, then by steps; 0: no such axis is."""

    joint_tolerance: float = 1e-3
    """All climb until a step adds less than this share of their scores, then the best alone; 0: all to the end."""

    def __post_init__(self) -> None:
        check_options(self.candidates, self.starts)
        if self.smooth_levels < 0:
            raise ScenarioError("$.smooth_levels", f"there are {self.smooth_levels} levels", allowed="an integer >= 0")
        if not 0 <= self.joint_tolerance < 1:
            raise ScenarioError(
                "$.joint_tolerance", f"the tolerance is {self.joint_tolerance:g}", allowed="a number in [0, 1)"
            )

    def maximize(self, problem: MaximizationProblem) -> Maximum | None:
        """Return the best new point found; None if the space holds no other."""
        is_real = problem.space.is_continuous
        is_listed = problem.space.n_configurations <= self.candidates
        if not problem.scorer.is_differentiable or not is_smooth(problem.space, self.smooth_levels).any() or is_listed:
            return LocalSearch(candidates=self.candidates, starts=self.starts).maximize(problem)
        X = draw_candidates(problem, self.candidates)
        if not len(X):
            return None
        X, scores = problem.score_candidates(X)
        refined = choose_starts(X, scores, self.starts)
        stepped = np.ones_like(is_real) if problem.space.constraints else ~is_real
        for _ in range(ROUNDS if stepped.any() else 1):
            before = refined
            refined = self._ascend(problem, refined)
            if stepped.any():
                refined, _ = climb(problem.space, problem.score, refined, stepped)
            if np.array_equal(before, refined):
                break
        points = np.vstack([refined, X])
        return best_unseen(problem, points, np.concatenate([problem.score(refined), scores]))

    def _ascend(self, problem: MaximizationProblem, starts: FloatArray) -> FloatArray:
        """Improve k starts along the axes that gradients lead along, shape (k, d); the best of them to the end."""
        is_free = is_smooth(problem.space, self.smooth_levels)
        tolerance = self.joint_tolerance if len(starts) > 1 else 0.0
        moved = _climb(problem, starts, is_free, tolerance or LAST_DIGITS)
        if tolerance:
            best = [int(problem.score(moved).argmax())]
            moved[best] = _climb(problem, moved[best], is_free, LAST_DIGITS)
        moved = problem.space.snap(back_to_allowed(problem.space, starts, moved))
        better = (problem.score(moved) > problem.score(starts)) & problem.space.is_allowed(moved)
        return np.where(better[:, None], moved, starts)


def _climb(problem: MaximizationProblem, starts: FloatArray, is_free: BoolArray, tolerance: float) -> FloatArray:
    """Return where L-BFGS-B leads from k starts, shape (k, d), until a step adds too little.

    That is a share of the sum of the scores, or as much itself where the sum is below one in size.
    """
    from scipy.optimize import minimize  # slow to import, and not needed to check a scenario

    def negative(flat: FloatArray) -> tuple[float, FloatArray]:
        X = starts.copy()
        X[:, is_free] = flat.reshape(len(starts), -1)
        score, gradient = problem.scorer.with_gradient(X)
        usable = np.isfinite(score) & np.isfinite(gradient).all(axis=1)
        score, gradient = np.where(usable, score, WORST), np.where(usable[:, None], gradient, 0.0)
        return -float(score.sum()), -gradient[:, is_free].ravel()

    start = starts[:, is_free].ravel()
    options = {"maxiter": MAX_ITERATIONS, "ftol": tolerance}
    result = minimize(negative, start, jac=True, method="L-BFGS-B", bounds=[(0.0, 1.0)] * len(start), options=options)
    moved = starts.copy()
    moved[:, is_free] = np.clip(result.x, 0.0, 1.0).reshape(len(starts), -1)
    return moved


def is_smooth(space: SearchSpace, many: int) -> BoolArray:
    """Tell which axes gradients lead along: real ones, and ordered ones of so many levels, shape (d,); 0: real ones."""
    least = many or math.inf
    return np.array([p.n_levels is None or (p.is_ordered and p.n_levels >= least) for p in space.parameters])


def back_to_allowed(space: SearchSpace, starts: FloatArray, moved: FloatArray) -> FloatArray:
    """Return k moved points, those not allowed drawn back towards their allowed starts, to the edge, shape (k, d)."""
    is_outside = ~space.is_allowed(moved)
    if not is_outside.any():
        return moved
    inside, outside = starts[is_outside], moved[is_outside]
    for _ in range(BISECTIONS):
        middle = (inside + outside) / 2
        is_inside = space.is_allowed(middle)[:, None]
        inside, outside = np.where(is_inside, middle, inside), np.where(is_inside, outside, middle)
    drawn_back = moved.copy()
    drawn_back[is_outside] = inside
    return drawn_back
