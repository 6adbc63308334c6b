"""Optimizers without a model: random search and prior sampling, the floors any method has to beat."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.design.base import InitialDesign
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.optimizers.initial import InitialPhase
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.priors.product import ProductPrior


@dataclass(frozen=True, slots=True, kw_only=True)
class SamplingPhase:
    """What follows the initial design when there is no model."""

    design: InitialDesign
    """Draws one further point at a time."""

    name: str
    """Phase written into the history."""


class SamplingOptimizer(Optimizer):
    """Suggests independent draws, never the same configuration twice."""

    def __init__(
        self, history: History, *, prior: ProductPrior, initial: InitialPhase, sampling: SamplingPhase, seed: int
    ) -> None:
        super().__init__(history)
        self._prior = prior
        self._initial = initial
        self._sampling = sampling
        self._seed = seed

    def _suggest(self, trial: int) -> Suggestion | None:
        if trial < len(self._initial):
            return self._initial.suggestion(trial)
        space = self.history.space
        rng = generator(self._seed, Stream.SUGGESTION, trial)
        taken = self.taken_keys()
        # One draw more than is taken: at least one of them is new, unless the space is exhausted.
        X = self._sampling.design.points(space, self._prior, len(taken) + 1, rng)
        new = X[space.unseen(X, taken)]
        if not len(new):
            return None
        return Suggestion(trial=trial, configuration=space.decode(new[:1])[0], phase=self._sampling.name)
