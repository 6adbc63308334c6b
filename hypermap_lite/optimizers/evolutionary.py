"""Evolution: a population, tournaments, mutation and crossover."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.maximizers.neighbours import REAL_STEPS, axis_neighbours
from hypermap_lite.optimizers.model_free import SearchState
from hypermap_lite.optimizers.streams import Stream
from hypermap_lite.pareto.ranking import crowding_distances, non_dominated_ranks
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, IntArray, Rng

ATTEMPTS = 100
"""Children that are tried until one is a new configuration."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Evolution:
    """Steady-state evolution: the best of a tournament has a child, and one member of the population dies for it.

    With several objectives, better is a lower front, and on the same front the lonelier place (NSGA-II [1]_).
    The population of any moment follows from the evaluations in the order of their trials. Evaluations without a usable
    result are worse than any other.

    References
    ----------
    .. [1] Deb, Pratap, Agarwal, Meyarivan. A Fast and Elitist Multiobjective Genetic Algorithm: NSGA-II. IEEE Trans.
       Evolutionary Computation, 2002.
    .. [2] Real, Aggarwal, Huang, Le. Regularized Evolution for Image Classifier Architecture Search. AAAI 2019.
    """

    population_size: int = 20
    """Members; the first are the points of the initial design, and draws if those are fewer."""

    tournament_size: int = 5
    """Members, drawn at random, the best of which is the parent."""

    mutation_rate: int = 1
    """Parameters that differ between a child and what it inherits."""

    crossover: bool = False
    """Whether the second best of the tournament is a parent too: each parameter is from either with probability 1/2."""

    regularized: bool = False
    """Whether the oldest member dies [2]_, instead of the worst of the tournament."""

    phase: ClassVar[str] = "evolution"
    weights: ClassVar[None] = None

    def __post_init__(self) -> None:
        if self.population_size < 2:
            problem = f"there are {self.population_size} members"
            raise ScenarioError("$.population_size", problem, allowed="an integer >= 2")
        if not 2 <= self.tournament_size <= self.population_size:
            problem = f"a tournament has {self.tournament_size} members"
            raise ScenarioError("$.tournament_size", problem, allowed=f"an integer from 2 to {self.population_size}")
        if self.mutation_rate < 1:
            problem = f"{self.mutation_rate} parameters are changed"
            raise ScenarioError("$.mutation_rate", problem, allowed="an integer >= 1")

    @property
    def n_initial(self) -> int:
        """The population."""
        return self.population_size

    def check(self, space: SearchSpace) -> None:
        """Raise a `ScenarioError` if there are fewer parameters than a mutation changes."""
        if self.mutation_rate > space.dimension:
            problem = f"a mutation changes {self.mutation_rate} parameters, and there are {space.dimension}"
            raise ScenarioError("$.mutation_rate", problem, allowed=f"an integer from 1 to {space.dimension}")

    def next_point(self, state: SearchState) -> FloatArray | None:
        """Return a new child; None if none is found."""
        members = self.population(state)
        if len(members) < self.tournament_size:
            return None
        rng = state.generator(Stream.SUGGESTION, state.trial)
        first, second = self._tournament(state, members, rng)[:2]
        for _ in range(ATTEMPTS):
            child = state.X[first].copy()
            if self.crossover:
                child = np.where(rng.random(len(child)) < 0.5, child, state.X[second])
            child = state.space.snap(self.mutated(child, state, rng)[None])[0]
            if state.is_new(child):
                return child
        return None

    def population(self, state: SearchState) -> IntArray:
        """Return the trials that are alive after all finished evaluations, the oldest first."""
        members: list[int] = []
        for trial in range(len(state.X)):
            if len(members) == self.population_size:
                dies = members[0]
                if not self.regularized:
                    rng = state.generator(Stream.SUGGESTION, trial)
                    dies = int(self._tournament(state, np.array(members), rng)[-1])
                members.remove(dies)
            members.append(trial)
        return np.array(members, dtype=np.int64)

    def _tournament(self, state: SearchState, members: IntArray, rng: Rng) -> IntArray:
        """Return random members, the best first."""
        chosen = rng.choice(len(members), size=self.tournament_size, replace=False)
        position = np.empty(len(members), dtype=np.int64)
        position[best_first(state.Y[members])] = np.arange(len(members))
        return members[chosen[np.argsort(position[chosen])]]

    def mutated(self, child: FloatArray, state: SearchState, rng: Rng) -> FloatArray:
        """Return a point with new values of `mutation_rate` different parameters, near or drawn from the prior."""
        child = child.copy()
        for j in rng.choice(len(child), size=self.mutation_rate, replace=False):
            parameter, code = state.space.parameters[j], np.array([child[j]])
            drawn = state.prior.sample(1, rng)[:, j]
            is_far = rng.random() < 0.5
            if parameter.n_levels is None:
                near = np.clip(code + rng.choice(REAL_STEPS) * rng.standard_normal(1), 0.0, 1.0)
                child[j] = (drawn if is_far else near)[0]
            elif is_far and parameter.level_index(drawn)[0] != parameter.level_index(code)[0]:
                child[j] = drawn[0]
            else:
                child[j] = rng.choice(axis_neighbours(parameter, float(code[0])))
        return child


def best_first(Y: FloatArray) -> IntArray:
    """Return the rows of Y, shape (n, m) and to be minimized, from the best to the worst, shape (n,)."""
    if Y.shape[1] == 1:
        return np.argsort(Y[:, 0], kind="stable")
    ranks = non_dominated_ranks(Y)
    return np.lexsort((-crowding_distances(Y, ranks), ranks))
