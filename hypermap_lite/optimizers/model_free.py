"""Optimizers that search by evaluations alone: no surrogate, and no state but the history."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from hypermap_lite.design.prior_sampling import PriorSampling
from hypermap_lite.design.random_sampling import RandomSampling
from hypermap_lite.evaluation.outcome import RANDOM, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.optimizers.fitness import Fitness
from hypermap_lite.optimizers.initial import InitialPhase
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchState:
    """All a search may know when it chooses the configuration of one trial."""

    space: SearchSpace
    prior: ProductPrior
    fitness: Fitness
    X: FloatArray
    """Finished evaluations in the order of their trials, shape (n, d)."""

    Y: FloatArray
    """Their objectives to be minimized, shape (n, m); infinite unless completed."""

    phases: Sequence[str]
    """The phases of the finished evaluations, then those of the ones on their way."""

    taken: frozenset[bytes]
    """Keys of all configurations that are finished or on their way."""

    n_initial: int
    """Trials before the search began."""

    trial: int
    seed: int

    def generator(self, stream: Stream, *numbers: int) -> Rng:
        """Return the generator of a stream."""
        return generator(self.seed, stream, *numbers)

    def is_new(self, x: FloatArray) -> bool:
        """Tell whether a point, shape (d,), is a legal configuration that was never suggested."""
        is_taken = self.space.keys(x[None])[0] in self.taken
        return not is_taken and self.space.contains(self.space.decode(x[None])[0])


class Search(Protocol):
    """Options of a search without a model."""

    phase: ClassVar[str]
    """Written into the history."""

    @property
    def n_initial(self) -> int:
        """Number of points, those of the initial design included, it begins with."""
        ...

    @property
    def weights(self) -> Sequence[float] | None:
        """Weights of the objectives in the fitness; None for equal ones."""
        ...

    def check(self, space: SearchSpace) -> None:
        """Raise a `ScenarioError` if it cannot search this space."""
        ...

    def next_point(self, state: SearchState) -> FloatArray | None:
        """Return a legal point that is new, shape (d,); None to have one drawn."""
        ...


class ModelFreeOptimizer(Optimizer):
    """Suggests the next point of a search, which is worked out from the history each time.

    Draws stand in where the search has none: from the prior and uniformly, in turn, so that no prior rules a place out.
    """

    def __init__(
        self,
        history: History,
        *,
        prior: ProductPrior,
        initial: InitialPhase,
        search: Search,
        fitness: Fitness,
        seed: int,
    ) -> None:
        super().__init__(history)
        self._prior = prior
        self._initial = initial
        self._search = search
        self._fitness = fitness
        self._seed = seed

    def _suggest(self, trial: int) -> Suggestion | None:
        if trial < len(self._initial):
            return self._initial.suggestion(trial)
        state = self._state(trial)
        x = None if trial < self._search.n_initial else self._search.next_point(state)
        phase = RANDOM if x is None else self._search.phase
        if x is None:
            x = self._drawn(state)
        if x is None:
            return None
        return Suggestion(trial=trial, configuration=self.history.space.decode(x[None])[0], phase=phase)

    def _state(self, trial: int) -> SearchState:
        completed = np.array([e.is_completed for e in self.history], dtype=bool)
        Y = np.full((len(completed), len(self.history.objectives)), np.inf)
        Y[completed] = self.history.Y()
        earlier = [*(e.suggestion for e in self.history), *self.in_flight]
        return SearchState(
            space=self.history.space,
            prior=self._prior,
            fitness=self._fitness,
            X=self.history.X_all(),
            Y=Y,
            phases=[suggestion.phase for suggestion in earlier],
            taken=frozenset(self.taken_keys()),
            n_initial=max(len(self._initial), self._search.n_initial),
            trial=trial,
            seed=self._seed,
        )

    def _drawn(self, state: SearchState) -> FloatArray | None:
        design = PriorSampling() if state.trial % 2 else RandomSampling()
        rng = state.generator(Stream.EXPLORATION, state.trial)
        # One draw more than is taken: at least one of them is new, unless the space is exhausted.
        X = design.points(state.space, state.prior, len(state.taken) + 1, rng)
        new = X[state.space.unseen(X, state.taken)]
        return new[0] if len(new) else None
