"""What a maximizer is: the search for the point with the best score."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hypermap_lite.acquisition.base import Scorer, rough_of
from hypermap_lite.design.base import ENUMERATION_LIMIT
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.quasi_random import sobol_points
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.space.walk import spread
from hypermap_lite.typing import BoolArray, FloatArray, Rng

PERTURBATIONS = 24
"""Perturbed copies of each incumbent among the candidates."""

PERTURBATION_SCALES = (0.2, 0.05, 0.01)
"""Standard deviations of the perturbations, in units of the cube, used in turn."""

MAX_SWAPS = 3
"""Random swaps that perturb a permutation, at most."""

PRIOR_SHARE = 4
"""One prior draw per so many Sobol candidates, where there is a prior."""

DRAWS = 16
"""Times as many points as are wanted are drawn at most where constraints reject some."""

SEPARATION = 0.05
"""Starts are at least this far apart, in the largest coordinate difference."""


CLOSER_LOOKS = 96
"""Candidates whose scores are taken in full where there are cheaper ones."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MaximizationProblem:
    """Where to look for the best score."""

    scorer: Scorer
    space: SearchSpace
    prior: ProductPrior
    incumbents: FloatArray
    """Points worth refining, shape (k, d), best first."""

    seen: Collection[bytes]
    """Keys of points that must not be chosen again."""

    rng: Rng
    pending: FloatArray | None = None
    """Points to keep at a distance from, shape (p, d); None for none."""

    separation: float = 0.0
    """That distance, in the largest coordinate difference; points in other categories are far."""

    def score(self, X: FloatArray) -> FloatArray:
        """Return the scores of n points, shape (n,); what is not a number is the worst."""
        return _numbers(self.scorer(X))

    def score_candidates(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the points worth a closer look, shape (k, d), and their scores, shape (k,); all n if they are few.

        Where the scorer has a cheaper approximation, that one chooses them. Those that keep no distance from pending
        ones are left out as long as there are others.
        """
        if (is_apart := self.is_apart(X)).any():
            X = X[is_apart]
        rough = rough_of(self.scorer)
        if rough is not None and len(X) > CLOSER_LOOKS:
            X = X[np.sort(np.argsort(-_numbers(rough(X)), kind="stable")[:CLOSER_LOOKS])]
        return X, self.score(X)

    def is_apart(self, X: FloatArray) -> BoolArray:
        """Tell which of n points keep their distance from all that are pending, shape (n,)."""
        return are_apart(self.space, X, self.pending, self.separation)


def are_apart(space: SearchSpace, X: FloatArray, pending: FloatArray | None, separation: float) -> BoolArray:
    """Tell which of n points keep the distance `separation` from all that are pending, shape (n,)."""
    if pending is None or not separation or not len(pending):
        return np.ones(len(X), dtype=bool)
    steps = np.abs(X[:, None, :] - pending[None, :, :])
    needed = np.where(space.is_ordered, separation, np.finfo(float).tiny)
    is_far: BoolArray = np.any(steps >= needed, axis=2)
    return np.all(is_far, axis=1)


def _numbers(scores: FloatArray) -> FloatArray:
    return np.where(np.isnan(scores), -np.inf, scores)


@dataclass(frozen=True, slots=True, kw_only=True)
class Maximum:
    """The best new point found."""

    x: FloatArray
    """Shape (d,)."""

    score: float


class Maximizer(Protocol):
    """Options of the search."""

    def maximize(self, problem: MaximizationProblem) -> Maximum | None:
        """Return the best legal, allowed point that has not been seen; None if the space holds no other."""
        ...


def check_options(candidates: int, starts: int) -> None:
    """Raise a `ScenarioError` if the search would have nothing to do."""
    if candidates < 1:
        raise ScenarioError("$.candidates", f"there are {candidates} candidates", allowed="an integer >= 1")
    if starts < 1:
        raise ScenarioError("$.starts", f"there are {starts} starts", allowed="an integer >= 1")


def draw_candidates(problem: MaximizationProblem, n: int) -> FloatArray:
    """Return new legal, allowed points: Sobol, draws from the prior, perturbed incumbents; all of a small space.

    Returns
    -------
    FloatArray
        Shape (k, d); empty if every configuration has been seen.
    """
    space, rng = problem.space, problem.rng
    if space.n_configurations <= n:
        X = space.enumerate()
    else:
        parts = [space.draw(n, lambda k: sobol_points(k, space.dimension, rng), DRAWS * n)]
        if not problem.prior.is_uniform:
            parts.append(space.draw(max(n // PRIOR_SHARE, 1), lambda k: problem.prior.sample(k, rng), DRAWS * n))
        parts.append(space.keep_allowed(space.snap(perturb(problem.incumbents, rng, space))))
        if space.constraints and len(parts[0]) < n:
            parts.append(spread(space, n, rng))
        X = np.vstack(parts)
    X = X[space.unseen(X, problem.seen)]
    if not len(X) and space.n_configurations <= ENUMERATION_LIMIT:
        X = space.enumerate()
        X = X[space.unseen(X, problem.seen)]
    return X


def perturb(points: FloatArray, rng: Rng, space: SearchSpace) -> FloatArray:
    """Return Gaussian perturbations of k points, of all coordinates or a random half, shape (k * PERTURBATIONS, d).

    Permutations are perturbed by one to three random swaps.
    """
    X = np.repeat(points, PERTURBATIONS, axis=0)
    scales = np.resize(PERTURBATION_SCALES, len(X))[:, None]
    moved = rng.random(X.shape) < rng.choice([0.5, 1.0], size=(len(X), 1))
    perturbed = np.clip(X + scales * moved * rng.standard_normal(X.shape), 0.0, 1.0)
    for j, parameter in space.permutations.items():
        n_swaps = np.where(moved[:, j], rng.integers(1, MAX_SWAPS + 1, size=len(X)), 0)
        perturbed[:, j] = parameter.swap(X[:, j], n_swaps, rng)
    return perturbed


def choose_starts(X: FloatArray, scores: FloatArray, n: int) -> FloatArray:
    """Return the n best points that are apart from each other, shape (<= n, d), best first."""
    chosen: list[int] = []
    for i in np.argsort(-scores, kind="stable"):
        if all(np.abs(X[i] - X[j]).max() >= SEPARATION for j in chosen):
            chosen.append(int(i))
        if len(chosen) == n:
            break
    return X[chosen]


def best_unseen(problem: MaximizationProblem, X: FloatArray, scores: FloatArray) -> Maximum | None:
    """Return the best of n points that is allowed and has not been seen, apart from pending ones if there is one."""
    new = problem.space.unseen(X, problem.seen) & problem.space.is_allowed(X)
    if not new.any():
        return None
    apart = new & problem.is_apart(X)
    new = apart if apart.any() else new
    i = int(np.flatnonzero(new)[np.argmax(scores[new])])
    return Maximum(x=X[i], score=float(scores[i]))
