"""The first trials of a run: the default configuration, then the initial design."""

from __future__ import annotations

import numpy as np

from hypermap_lite.design.base import InitialDesign
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace


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
        X = design.points(space, prior, n, generator(seed, Stream.DESIGN)) if n else np.empty((0, space.dimension))
        self.has_default = space.default is not None
        if space.default is not None:
            X = np.vstack([space.encode([space.default]), X])
        self._configurations = space.decode(X[space.unseen(X, ())][:n])

    def __len__(self) -> int:
        return len(self._configurations)

    def suggestion(self, trial: int) -> Suggestion:
        """Return the suggestion of one of the first trials."""
        phase = "default" if self.has_default and trial == 0 else "design"
        return Suggestion(trial=trial, configuration=self._configurations[trial], phase=phase)
