"""What the history teaches: a model of the objectives, and one of the feasibility."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from hypermap_lite.acquisition.feasibility_weighted import FeasibilityWeighting
from hypermap_lite.evaluation.outcome import Evaluation, Suggestion
from hypermap_lite.history.history import History, objectives_of
from hypermap_lite.objectives import reference_point_of
from hypermap_lite.optimizers.beside import telling
from hypermap_lite.optimizers.prior_trust import Evidence
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.surrogates.base import Posterior, Surrogate
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.typing import FloatArray

MIN_COMPLETED = 2
"""With fewer completed evaluations there is no objective to model."""

FIRST_MILESTONE = 8
"""Hyperparameters are fitted on the first 8 evaluations, then at numbers that grow by the surrogate's factor.

The warm start of any fit is that of the milestone below, never that of the last call, so it is a function of the
history and a resumed run fits as the uninterrupted one did. A milestone's own fit starts anew, too: an optimum of a few
evaluations in which noise passes for a rough function can otherwise be kept for good.
"""


class Models:
    """Fits what is asked for once per length of the history.

    Parameters
    ----------
    history
        The evaluations; it may grow.
    surrogate
        Of the objectives.
    feasibility_weighting
        None learns nothing of the feasibility.
    seed
        Of the scenario.
    """

    def __init__(
        self, history: History, surrogate: Surrogate, feasibility_weighting: FeasibilityWeighting | None, seed: int
    ) -> None:
        self._history = history
        self._surrogate = surrogate
        self._feasibility_weighting = feasibility_weighting
        self._seed = seed
        self._warm_starts: dict[int, Any] = {}
        self._posterior_of: tuple[tuple[int, ...], Posterior] | None = None
        self._feasibility_of: tuple[int, FeasibilityPosterior] | None = None

    def observed(self, n: int | None = None) -> tuple[FloatArray, FloatArray]:
        """Return what the surrogate is fitted to: the completed evaluations, or one row per distinct configuration.

        With n, those of the first n rows of the history.
        """
        if self._surrogate.noise_from_replicates:
            samples = self._history.samples(n)
            return samples.X, samples.Y
        k = sum(row.is_completed for row in list(self._history)[:n])
        return self._history.X()[:k], self._history.Y()[:k]

    def posterior(self) -> Posterior:
        """Return what is known of the objectives after the completed evaluations, of which there must be one."""
        n = len(self._history)
        beside = self._beside(n)
        # a row that did not complete changes what is pooled, and what is known beside, but nothing else
        rows = n if self._surrogate.noise_from_replicates else len(self._history.completed)
        key = (rows, *(row.suggestion.trial for row in beside))
        if self._posterior_of is None or self._posterior_of[0] != key:
            self._posterior_of = (key, self._posterior_after(n, beside))
        return self._posterior_of[1]

    def _beside(self, n: int) -> list[Evaluation]:
        """Return what else the surrogate learns from among the first n rows: infeasible evaluations."""
        return telling(list(self._history)[:n], self._history.objectives) if self._surrogate.learn_infeasible else []

    def _posterior_after(self, n: int, beside: list[Evaluation]) -> Posterior:
        """Return the posterior given the first n rows of the history, of which some only inform."""
        X = self._history.space.encode([row.configuration for row in beside])
        known = X, objectives_of(beside, self._history.objectives)
        return (
            self._fit_samples(n, known)
            if self._surrogate.noise_from_replicates
            else self._fit(*self.observed(n), known)
        )

    def evidence(self, n: int) -> Evidence | None:
        """Return what was known when the history had n rows; None if next to nothing."""
        X, _ = self.observed(n)
        if len(X) < MIN_COMPLETED:
            return None
        n_judged = sum(row.state.is_feasible is not None for row in list(self._history)[:n])
        feasibility = self.feasibility(n=n_judged)
        return Evidence(
            posterior=self.posterior() if n == len(self._history) else self._posterior_after(n, self._beside(n)),
            X=X,
            X_all=self._history.X_all()[:n],
            reference_point=reference_point_of(self._history.objectives),
            log_probability=None if feasibility is None else feasibility.log_probability,
        )

    def feasibility(
        self, searching: Sequence[Suggestion] | None = None, n: int | None = None
    ) -> FeasibilityPosterior | None:
        """Return what is known of the feasibility, or what the first n told of it; None if none was infeasible.

        While there is nothing but this to go by, the pending suggestions are given as `searching`: they count as
        infeasible, so that a batch spreads.
        """
        X, is_feasible = (known[:n] for known in self._history.feasibility())
        if self._feasibility_weighting is None or is_feasible.all():
            return None
        if self._feasibility_of is None or self._feasibility_of[0] != len(X) or searching is not None:
            space = self._history.space
            pending = space.encode([s.configuration for s in searching or ()])
            known = np.append(is_feasible, np.zeros(len(pending), dtype=bool))
            posterior = self._feasibility_weighting.fit(
                np.vstack([X, pending]), known, space.is_ordered, space.permutations
            )
            self._feasibility_of = (len(X), posterior)
        return self._feasibility_of[1]

    def _fit(self, X: FloatArray, Y: FloatArray, beside: tuple[FloatArray, FloatArray]) -> Posterior:
        """Fit to n completed evaluations and what is known beside; milestones, to completed ones alone."""
        n, start, growth = len(X), None, self._surrogate.warm_start_growth
        for k in () if growth is None else milestones(n, growth):
            if k not in self._warm_starts:
                self._warm_starts[k] = self._fit_from(X[:k], Y[:k], start, anew=True).hyperparameters
            start = self._warm_starts[k]
        posterior = self._fit_from(X, Y, start, beside=beside, anew=is_milestone(n, growth))
        if is_milestone(n, growth) and not len(beside[0]):
            self._warm_starts[n] = posterior.hyperparameters  # what a later call would work out again
        return posterior

    def _fit_samples(self, n: int, beside: tuple[FloatArray, FloatArray]) -> Posterior:
        """Fit to one row per distinct configuration among the first n rows, with the noise of its mean.

        The warm start of a milestone comes from the rows up to its last new configuration: later ones may repeat an
        earlier configuration, which changes the mean and all variances, but not what a milestone was fitted to.
        """
        start, samples, ends = None, self._history.samples(n), self._history.ends_of_samples()
        growth = self._surrogate.warm_start_growth
        for k in () if growth is None else milestones(len(samples.X), growth):
            if k not in self._warm_starts:
                first = self._history.samples(ends[k - 1])
                fitted = self._fit_from(first.X, first.Y, start, first.noise_variance, anew=True)
                self._warm_starts[k] = fitted.hyperparameters
            start = self._warm_starts[k]
        anew = is_milestone(len(samples.X), growth)
        return self._fit_from(samples.X, samples.Y, start, samples.noise_variance, beside=beside, anew=anew)

    def _fit_from(
        self,
        X: FloatArray,
        Y: FloatArray,
        start: Any,
        noise_variance: FloatArray | None = None,
        *,
        beside: tuple[FloatArray, FloatArray] | None = None,
        anew: bool = False,
    ) -> Posterior:
        rng = generator(self._seed, Stream.SUGGESTION, 0, len(X))
        space, n_beside = self._history.space, 0
        if beside is not None and (n_beside := len(beside[0])):
            X, Y = np.vstack([X, beside[0]]), np.vstack([Y, beside[1]])
            if noise_variance is not None:
                usual = np.median(noise_variance, axis=0)
                noise_variance = np.vstack([noise_variance, np.broadcast_to(usual, (n_beside, len(usual)))])
        return self._surrogate.fit(
            X,
            Y,
            is_ordered=space.is_ordered,
            rng=rng,
            start=start,
            anew=anew,
            permutations=space.permutations,
            noise_variance=noise_variance,
            n_beside=n_beside,
        )


def is_milestone(n: int, growth: float | None) -> bool:
    """Tell whether the fit to n evaluations starts later ones; without a growth none does."""
    return growth is not None and n in milestones(n + 1, growth)


def milestones(n: int, growth: float) -> Iterator[int]:
    """Yield the numbers of evaluations below n whose fits start the later ones."""
    k = float(FIRST_MILESTONE)
    while k < n:
        yield int(k)
        k *= growth
