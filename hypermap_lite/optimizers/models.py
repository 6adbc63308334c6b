"""What the history teaches: a model of the objectives, and one of the feasibility."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hypermap_lite.acquisition.feasibility_weighted import FeasibilityWeighting
from hypermap_lite.evaluation.outcome import Evaluation, Suggestion
from hypermap_lite.history.history import History, Samples, objectives_of
from hypermap_lite.history.replicate_noise import shrunk_variances
from hypermap_lite.objectives import reference_point_of, stated_or
from hypermap_lite.optimizers.beside import MOST, telling, values_of_failures
from hypermap_lite.optimizers.prior_trust import Evidence
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.surrogates.base import Posterior, Surrogate
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.surrogates.reported import AsReported
from hypermap_lite.surrogates.tails import Tails, compress, slopes
from hypermap_lite.typing import FloatArray

logger = logging.getLogger(__name__)

MIN_COMPLETED = 2
"""With fewer completed evaluations there is no objective to model."""

FIRST_MILESTONE = 8
"""Hyperparameters are fitted on the first 8 evaluations, then at numbers that grow by the surrogate's factor.

The warm start of any fit is that of the milestone below, never that of the last call, so it is a function of the
history and a resumed run fits as the uninterrupted one did. A milestone's own fit starts anew, too: an optimum of a few
evaluations in which noise passes for a rough function can otherwise be kept for good.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToldApart:
    """Failures among the infeasible evaluations of a history."""

    objective: int
    """The one by which they are failures."""

    trials: set[int]
    """Which they are; it may grow."""


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
    failures
        Which infeasible evaluations of the history are failures in fact, if there are any.
    has_tails
        Whether tails may be compressed.
    announced
        What the log has said already; it is added to.
    """

    def __init__(
        self,
        history: History,
        surrogate: Surrogate,
        feasibility_weighting: FeasibilityWeighting | None,
        seed: int,
        failures: ToldApart | None = None,
        has_tails: bool = True,
        announced: set[object] | None = None,
    ) -> None:
        self._history = history
        self._surrogate = surrogate
        self._feasibility_weighting = feasibility_weighting
        self._seed = seed
        self._failures = failures
        self._has_tails = has_tails
        self._warm_starts: dict[int, Any] = {}
        self._tails: dict[int, Tails] = {}
        self.is_silent = False
        """Whether the log is not told what these models make of the evaluations."""
        self._announced = set() if announced is None else announced
        self._posterior_of: tuple[tuple[int, ...], Posterior] | None = None
        self._feasibility_of: tuple[int, FeasibilityPosterior] | None = None

    @property
    def history(self) -> History:
        """The evaluations."""
        return self._history

    def observed(self, n: int | None = None) -> tuple[FloatArray, FloatArray]:
        """Return what the surrogate is fitted to: the completed evaluations, or one row per distinct configuration.

        With n, those of the first n rows of the history. Their `tails` are compressed, as they are in all posteriors.
        """
        X, Y = self._reported(n)
        return X, compress(Y, self.tails(n))

    def n_observed(self, n: int | None = None) -> int:
        """Return the number of rows of `observed`."""
        return len(self._reported(n)[0]) if self._surrogate.noise_from_replicates else self._n_completed(n)

    def _n_completed(self, n: int | None) -> int:
        """Return how many of the first n rows of the history completed, of all by default."""
        return sum(row.is_completed for row in list(self._history)[:n])

    def told(self) -> FloatArray:
        """Return the objectives of all completed evaluations with their tails compressed, shape (n, m)."""
        return compress(self._history.Y(), self.tails())

    def as_told(self, y: FloatArray) -> FloatArray:
        """Return objectives, shape (m,), as the model would be told them, with nothing worse than the worst success."""
        y = compress(y[None], self.tails())[0].copy()
        if self._failures is not None:
            k = self._failures.objective
            y[k] = min(y[k], self.told()[:, k].max())
        return y

    def _reported(self, n: int | None = None) -> tuple[FloatArray, FloatArray]:
        """Return the same with the values as they are."""
        if self._surrogate.noise_from_replicates:
            samples = self._history.samples(n)
            return samples.X, samples.Y
        k = self._n_completed(n)
        return self._history.X()[:k], self._history.Y()[:k]

    def tails(self, n: int | None = None) -> Tails:
        """Return how the surrogate wants the objectives' tails compressed, by the first n rows of the history.

        That is worked out at the milestones and kept between them, so that promises can be compared with what came of
        them.
        """
        growth, found = self._surrogate.warm_start_growth, self._tails_at(0)
        for k in () if growth is None else milestones(self.n_observed(n) + 1, growth):
            found = self._tails_at(k)
        return found

    def _tails_at(self, k: int) -> Tails:
        if k not in self._tails:
            self._tails[k] = self._tails_after(k)
        return self._tails[k]

    def _tails_after(self, k: int) -> Tails:
        """Return the tails by the first k evaluations, or distinct configurations."""
        objectives = self._history.objectives
        if not k or not self._has_tails:
            return (None,) * len(objectives)
        if self._surrogate.noise_from_replicates:
            X, Y = self._reported(self._history.ends_of_samples()[k - 1])
        else:
            X, Y = self._history.X()[:k], self._history.Y()[:k]
        least = np.full(1, -np.inf)
        if len(objectives) > 1:
            least = stated_or(objectives, Y[non_dominated(Y)].max(axis=0))
        space = self._history.space
        tails = self._surrogate.tails(X, Y, least, is_ordered=space.is_ordered, permutations=space.permutations)
        self._announce(tails, k)
        return tails

    def _announce(self, tails: Tails, k: int) -> None:
        """Log, once per objective, that it has a tail."""
        for objective, tail in zip(self._history.objectives, tails, strict=True):
            if tail is not None and objective.name not in self._announced and not self.is_silent:
                self._announced.add(objective.name)
                logger.info(
                    "after %d completed evaluations: values of %s %s %.4g are far beyond the rest; the model learns"
                    " from their logarithm",
                    k,
                    objective.name,
                    "above" if objective.sign > 0 else "below",
                    objective.sign * tail.limit,
                )

    def posterior(self) -> Posterior:
        """Return what is known of the objectives after the completed evaluations, of which there must be one."""
        n = len(self._history)
        beside = self._beside(n)
        # a row that did not complete changes what is pooled, and what is known beside, but nothing else
        rows = n if self._surrogate.noise_from_replicates else len(self._history.completed)
        key = (rows, *(row.suggestion.trial for row in beside))
        if self._posterior_of is None or self._posterior_of[0] != key:
            self._posterior_of = (key, self._posterior_after(n, beside))
            self._announce_outliers(self._posterior_of[1])
            self._announce_doubts(self._posterior_of[1])
        return self._posterior_of[1]

    def _announce_doubts(self, posterior: Posterior) -> None:
        """Log, once per objective, that a model without noise takes the place of one with noise."""
        for objective, is_doubted in zip(self._history.objectives, posterior.lacks_noise, strict=True):
            if is_doubted and ("noise", objective.name) not in self._announced and not self.is_silent:
                self._announced.add(("noise", objective.name))
                logger.info(
                    "after %d completed evaluations: %s is more likely rough than noisy; the model goes without noise"
                    " as long as that is so",
                    len(self._history.completed),
                    objective.name,
                )

    def _announce_outliers(self, posterior: Posterior) -> None:
        """Log, once per evaluation and objective, that it is set aside."""
        outliers = None if self.is_silent else posterior.outliers()
        for row, k in () if outliers is None else np.argwhere(outliers):
            evaluation, objective = self._history.completed[row], self._history.objectives[k]
            if (evaluation.trial, objective.name) not in self._announced:
                self._announced.add((evaluation.trial, objective.name))
                prediction = AsReported(posterior=posterior, tails=self.tails()).predict(
                    self._history.space.encode([evaluation.configuration])
                )
                logger.info(
                    "trial %d: %s is %.4g, where the other evaluations foretell %.4g +- %.2g; the model sets it aside"
                    " until one near it is as bad",
                    evaluation.trial,
                    objective.name,
                    evaluation.values[objective.name],
                    objective.sign * prediction.mean[0, k],
                    prediction.std[0, k],
                )

    def _beside(self, n: int) -> list[Evaluation]:
        """Return what else the surrogate learns from among the first n rows: infeasible evaluations, then failures."""
        if not self._surrogate.learn_infeasible:
            return []
        rows = list(self._history)[:n]
        failed = [row for row in rows if self._is_failure(row)][-MOST:]
        infeasible = [row for row in rows if not self._is_failure(row)]
        return [*telling(infeasible, self._history.objectives, self.tails(n)), *failed]

    def _is_failure(self, row: Evaluation) -> bool:
        return self._failures is not None and row.trial in self._failures.trials

    def _values_beside(self, n: int, beside: list[Evaluation]) -> FloatArray:
        """Return what they report, shape (k, m), NaN where that means nothing; tails are compressed."""
        objectives, tails = self._history.objectives, self.tails(n)
        failed = [row for row in beside if self._is_failure(row)]
        Y = objectives_of(beside[: len(beside) - len(failed)], objectives)
        if self._failures is not None and failed:
            completed = [row for row in list(self._history)[:n] if row.is_completed]
            Y = np.vstack([Y, values_of_failures(failed, completed, objectives, self._failures.objective, tails)])
        return compress(Y, tails)

    def _posterior_after(self, n: int, beside: list[Evaluation]) -> Posterior:
        """Return the posterior given the first n rows of the history, of which some only inform."""
        X = self._history.space.encode([row.configuration for row in beside])
        known = X, self._values_beside(n, beside)
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
        feasibility = self.feasibility(n=self._n_judged(n))
        return Evidence(
            posterior=self.posterior() if n == len(self._history) else self._posterior_after(n, self._beside(n)),
            X=X,
            X_all=self._history.X_all()[:n],
            reference_point=reference_point_of(self._history.objectives),
            log_probability=None if feasibility is None else feasibility.log_probability,
        )

    def _n_judged(self, n: int) -> int:
        """Return how many of the first n rows of the history tell of feasibility."""
        weighting = self._feasibility_weighting
        if weighting is not None and weighting.learn_failed:
            return n
        return sum(row.state.is_feasible is not None for row in list(self._history)[:n])

    def feasibility(
        self, searching: Sequence[Suggestion] | None = None, n: int | None = None
    ) -> FeasibilityPosterior | None:
        """Return what is known of the feasibility, or what the first n told of it; None if none was infeasible.

        While there is nothing but this to go by, the pending suggestions are given as `searching`: they count as
        infeasible, so that a batch spreads.
        """
        weighting = self._feasibility_weighting
        if weighting is None:
            return None
        X, is_feasible = (known[:n] for known in self._history.feasibility(learn_failed=weighting.learn_failed))
        if is_feasible.all():
            return None
        if self._feasibility_of is None or self._feasibility_of[0] != len(X) or searching is not None:
            space = self._history.space
            pending = space.encode([s.configuration for s in searching or ()])
            known = np.append(is_feasible, np.zeros(len(pending), dtype=bool))
            posterior = weighting.fit(np.vstack([X, pending]), known, space.is_ordered, space.permutations)
            self._feasibility_of = (len(X), posterior)
        return self._feasibility_of[1]

    def _fit(self, X: FloatArray, Y: FloatArray, beside: tuple[FloatArray, FloatArray]) -> Posterior:
        """Fit to n completed evaluations and what is known beside; milestones, to completed ones alone."""
        n, start, growth = len(X), None, self._surrogate.warm_start_growth
        for k in () if growth is None else milestones(n, growth):
            if k not in self._warm_starts:
                first = compress(self._history.Y()[:k], self._tails_at(k))
                self._warm_starts[k] = self._fit_from(X[:k], first, start, anew=True).start
            start = self._warm_starts[k]
        posterior = self._fit_from(X, Y, start, beside=beside, anew=is_milestone(n, growth))
        if is_milestone(n, growth) and not len(beside[0]):
            self._warm_starts[n] = posterior.start  # what a later call would work out again
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
                Y, noise_variance = compressed(first, self.tails(ends[k - 1]))
                fitted = self._fit_from(first.X, Y, start, noise_variance, anew=True)
                self._warm_starts[k] = fitted.start
            start = self._warm_starts[k]
        anew = is_milestone(len(samples.X), growth)
        Y, noise_variance = compressed(samples, self.tails(n))
        return self._fit_from(samples.X, Y, start, noise_variance, beside=beside, anew=anew)

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


def compressed(samples: Samples, tails: Tails) -> tuple[FloatArray, FloatArray | None]:
    """Return the objectives of k configurations with their tails compressed, and what noise that leaves of theirs."""
    if samples.variances is None or not any(tails):
        return compress(samples.Y, tails), samples.noise_variance
    # before they are shrunk: what a penalty among replicates makes of one variance is not usual for the others
    own = samples.own_variances * slopes(samples.Y, tails) ** 2
    shrunk = replace(samples, variances=shrunk_variances(own, samples.freedom))
    return compress(samples.Y, tails), shrunk.noise_variance


def is_milestone(n: int, growth: float | None) -> bool:
    """Tell whether the fit to n evaluations starts later ones; without a growth none does."""
    return growth is not None and n in milestones(n + 1, growth)


def milestones(n: int, growth: float) -> Iterator[int]:
    """Yield the numbers of evaluations below n whose fits start the later ones."""
    k = float(FIRST_MILESTONE)
    while k < n:
        yield int(k)
        k *= growth
