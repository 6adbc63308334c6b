"""The last evaluations of a budget, spent on knowing the front instead of moving it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.evaluation.outcome import CONFIRM, Evaluation, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.history.pooling import key_of, pooled
from hypermap_lite.objectives import reference_point_of
from hypermap_lite.optimizers.initial import InitialPhase
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.pareto import hypervolume_contributions, infer_reference_point
from hypermap_lite.surrogates.base import Posterior
from hypermap_lite.typing import FloatArray

DRAWS: Final = 128
"""Joint draws of the noise-free objectives over which contributions vary."""

FEWEST: Final = 2
"""Completed evaluations without which there is nothing to compare."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Confirmation:
    """Repeats the configuration of whose worth for the front the least is known.

    The worth of a configuration is the volume that it alone adds to the front: none if another dominates it, and
    much if it is the only one of its kind. Of all evaluated configurations, the one is evaluated again whose worth has
    the largest variance under the posterior of the noise-free objectives: it may be much or nothing. That is where
    membership is uncertain, where much depends on it, and where the model is not sure already; a configuration that is
    certainly on the front, or certainly off it, gains nothing from a repetition.
    """

    n: int
    """Evaluations at the end of the budget that are spent so, >= 1."""

    budget: int
    """Evaluations in all."""

    seed: int
    initial: InitialPhase
    """Is never cut short."""

    posterior: Callable[[], tuple[Posterior, FloatArray]]
    """Returns what is known after the completed evaluations, and the points it was fitted to, shape (b, d)."""

    def is_due(self, trial: int) -> bool:
        """Tell whether a trial is one of the last of the budget."""
        return max(self.budget - self.n, len(self.initial)) <= trial < self.budget

    def is_left(self, history: History, in_flight: Sequence[Suggestion]) -> bool:
        """Tell whether fewer than `n` evaluations have been spent so."""
        made = [*(e.suggestion for e in history), *in_flight]
        return sum(suggestion.phase == CONFIRM for suggestion in made) < self.n

    def suggestion(self, history: History, in_flight: Sequence[Suggestion], trial: int) -> Suggestion | None:
        """Return the configuration to repeat; None if fewer than two can be.

        One that is under way counts by its variance over the number of its evaluations to come. Of equal ones, as
        where there is no noise, that with the fewest replicates is taken, then the first.
        """
        candidates = [e for e in pooled(history) if e.is_completed]
        if len(candidates) < FEWEST:
            return None
        candidates = self._known(history, candidates)
        if len(candidates) < FEWEST:
            return None
        variance = self._variance_of_worth(history, candidates, trial)
        under_way = [key_of(s.configuration) for s in in_flight if s.phase == CONFIRM]
        n_coming = np.array([under_way.count(key_of(e.configuration)) for e in candidates])
        replicates = np.array([e.replicates for e in candidates])
        score = variance / (1 + n_coming)
        best = np.lexsort((replicates, n_coming, -score))[0]
        return Suggestion(
            trial=trial,
            configuration=candidates[best].configuration,
            phase=CONFIRM,
            acquisition_value=float(np.sqrt(variance[best])),
        )

    def _known(self, history: History, candidates: Sequence[Evaluation]) -> list[Evaluation]:
        """Return the candidates of which the model knows: not those that it takes for failures."""
        keys = history.space.keys(history.space.encode([e.configuration for e in candidates]))
        known = set(history.space.keys(self.posterior()[1]))
        return [candidate for candidate, key in zip(candidates, keys, strict=True) if key in known]

    def _variance_of_worth(self, history: History, candidates: Sequence[Evaluation], trial: int) -> FloatArray:
        """Return the variance of each candidate's worth, in shares of the box up to the reference point, shape (k,)."""
        space = history.space
        posterior, X = self.posterior()
        draws = posterior.fantasies(X[:0], DRAWS, generator(self.seed, Stream.SUGGESTION, trial)).values
        place = {key: i for i, key in reversed(list(enumerate(space.keys(X))))}
        rows = [place[key] for key in space.keys(space.encode([e.configuration for e in candidates]))]
        mean = posterior.predict(X[rows]).mean
        corner = reference_point_of(history.objectives)
        if corner is None or not (mean < corner).all(axis=1).any():
            corner = infer_reference_point(mean)
        span = corner - mean.min(axis=0)
        worth = [hypervolume_contributions((draw - corner) / span, np.zeros(len(span))) for draw in draws[:, rows]]
        return np.asarray(np.nan_to_num(np.var(worth, axis=0), nan=0.0, posinf=0.0))
