"""The first trials of a run: the default configuration, then the initial design."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from hypermap_lite.design.base import InitialDesign
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Configuration

COMPLETIONS = 100
"""Attempts to complete a partial default to a legal configuration."""


class InitialPhase:
    """The configurations that are tried before there is a model; a function of the scenario alone.

    Parameters
    ----------
    space, prior
        The search space and the belief over it.
    design
        Chooses the points.
    n
        How many, the default configuration included.
    seed
        Of the scenario.
    """

    def __init__(self, space: SearchSpace, prior: ProductPrior, design: InitialDesign, n: int, seed: int) -> None:
        self._space = space
        self._prior = prior
        self._design = design
        self._n = n
        self._seed = seed

    @cached_property
    def default(self) -> Configuration | None:
        """The default configuration, parameters without one completed by a draw of the design; None without any."""
        space = self._space
        given = {p.name: p.default for p in space.parameters if p.default is not None}
        if len(given) in (0, space.dimension):
            return space.default
        rng = generator(self._seed, Stream.DESIGN, 1)
        for _ in range(COMPLETIONS):
            for drawn in space.decode(self._design.points(space, self._prior, 1, rng)):
                if space.contains(completed := {**drawn, **given}):
                    return completed
        return None

    @cached_property
    def configurations(self) -> list[Configuration]:
        """The default, if there is one, and the points of the design; one fewer where it holds the default too."""
        space, rng = self._space, generator(self._seed, Stream.DESIGN)
        X = space.encode([] if self.default is None else [self.default])[: self._n]
        if len(X) < self._n:
            X = np.vstack([X, self._design.points(space, self._prior, self._n - len(X), rng)])
        return space.decode(X[space.unseen(X, ())])

    def __len__(self) -> int:
        return len(self.configurations)

    def suggestion(self, trial: int) -> Suggestion:
        """Return the suggestion of one of the first trials."""
        phase = "default" if self.default is not None and trial == 0 else "design"
        return Suggestion(trial=trial, configuration=self.configurations[trial], phase=phase)
