"""The first trials of a run: those of earlier experiments, the default configuration, then the initial design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from itertools import takewhile

import numpy as np

from hypermap_lite.design.base import InitialDesign
from hypermap_lite.design.latin_hypercube import PriorLatinHypercube
from hypermap_lite.design.prior_sampling import UNIFORM, PriorSampling
from hypermap_lite.evaluation.outcome import DESIGN, EARLIER, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Configuration, FloatArray

COMPLETIONS = 100
"""Attempts to complete a partial default to a legal configuration."""


class InitialPhase:
    """The configurations that are tried before there is a model; a function of the scenario and the earlier rows.

    Evaluations of an earlier experiment, which come first in the history, count towards the design: so many fewer
    points are drawn, none of them a repetition.

    Parameters
    ----------
    space, prior
        The search space and the belief over it.
    design
        Chooses the points.
    n
        How many, the default configuration and earlier evaluations included.
    seed
        Of the scenario.
    history
        Of the run; its first rows may be those of an earlier experiment.
    names
        Of the objectives whose priors the draws take in turn; one empty name if all share one.
    """

    def __init__(
        self,
        space: SearchSpace,
        prior: ProductPrior,
        design: InitialDesign,
        n: int,
        seed: int,
        history: History | None = None,
        names: Sequence[str] = ("",),
    ) -> None:
        self._space = space
        self._prior = prior
        self._design = design
        self._n = n
        self._seed = seed
        self._history = history
        self._names = tuple(names)
        self._origins: dict[bytes, int] = {}
        self._drawn: tuple[int, list[Configuration]] | None = None

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

    @property
    def n_earlier(self) -> int:
        """Number of evaluations of an earlier experiment."""
        return len(self._earlier())

    @property
    def n_beyond(self) -> int:
        """Number of these beyond the design: they stand for suggestions by the model."""
        return max(self.n_earlier - self._n, 0)

    def _earlier(self) -> list[Configuration]:
        rows = takewhile(lambda e: e.suggestion.phase == EARLIER, self._history or ())
        return [evaluation.configuration for evaluation in rows]

    @property
    def configurations(self) -> list[Configuration]:
        """The default, if there is one, and the points of the design; one fewer where it holds the default too."""
        earlier = self._earlier()
        if self._drawn is None or self._drawn[0] != len(earlier):
            self._drawn = len(earlier), self._draw(earlier)
        return self._drawn[1]

    def _draw(self, earlier: list[Configuration]) -> list[Configuration]:
        space, rng = self._space, generator(self._seed, Stream.DESIGN)
        taken = space.keys(space.encode(earlier))
        n = max(self._n - len(earlier), 0)
        X = space.encode([] if self.default is None else [self.default])
        X = X[space.unseen(X, taken)][:n]
        if len(X) < n:
            self._origins = self._origins_of(n - len(X))
            X = np.vstack([X, self._design.points(space, self._prior, n - len(X), rng)])
        X = X[space.unseen(X, taken)]
        if earlier and len(X) < n:  # some points are among the earlier ones, so that others take their place
            X = np.vstack([X, self._design.points(space, self._prior, n + len(earlier), rng)])
            X = X[space.unseen(X, taken)][:n]
        configurations = space.decode(X)
        if self._starts_with_default(X) and not space.contains(configurations[0]):
            configurations[0] = self.default or {}  # its last digits matter to a constraint
        return configurations

    def _origins_of(self, n: int) -> dict[bytes, int]:
        """Return where the points of the design come from, if they come from several places."""
        design = self._design
        if not isinstance(design, PriorSampling) or self._prior.is_uniform:
            return {}
        if not design.uniform_share and len(self._names) == 1:
            return {}
        return design.origins(self._space, self._prior, n, generator(self._seed, Stream.DESIGN))

    def _starts_with_default(self, X: FloatArray) -> bool:
        """Tell whether the default is the first of n points, shape (n, d)."""
        space = self._space
        return self.default is not None and space.keys(X[:1]) == space.keys(space.encode([self.default]))

    def __len__(self) -> int:
        """Return the trial at which the initial phase ends: earlier evaluations and points of the design."""
        return self.n_earlier + len(self.configurations)

    @property
    def n_guided(self) -> int:
        """Number of points of the design that are draws from a prior."""
        if self._prior.is_uniform or not isinstance(self._design, PriorSampling | PriorLatinHypercube):
            return 0
        chosen = [self.suggestion(trial) for trial in range(self.n_earlier, len(self))]
        return sum(s.phase == DESIGN and s.prior_weight != 0 for s in chosen)

    def suggestion(self, trial: int) -> Suggestion:
        """Return the suggestion of one of the first trials that are not those of an earlier experiment."""
        configuration = self.configurations[trial - self.n_earlier]
        is_first = trial == self.n_earlier
        x = self._space.encode([configuration])
        if is_first and self._starts_with_default(x):
            return Suggestion(trial=trial, configuration=configuration, phase="default")
        suggestion = Suggestion(trial=trial, configuration=configuration, phase=DESIGN)
        origin = self._origins.get(self._space.keys(x)[0])
        if origin is None:
            return suggestion
        if origin == UNIFORM:
            return replace(suggestion, prior_weight=0.0)
        return replace(suggestion, prior_weight=1.0, prior_of=self._names[origin % len(self._names)])
