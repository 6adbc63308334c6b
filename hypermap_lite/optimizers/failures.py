"""The history as the model sees it: failures that are a kind of their own count as infeasible there.

What an infeasible evaluation tells, a failure tells, too: where success is likely, and, if it makes sense beside the
successes, what an objective is like there. In the files, and for anybody else, it stays what it was. What the front
needs is no failure, but may be of another kind: then there are `modes`.
"""

from __future__ import annotations

import logging
import math
from dataclasses import replace

import numpy as np

from hypermap_lite.acquisition.feasibility_weighted import FeasibilityWeighting
from hypermap_lite.evaluation.outcome import Evaluation, State
from hypermap_lite.history.history import History, objectives_of
from hypermap_lite.objectives import stated_or
from hypermap_lite.optimizers.models import Models, ToldApart, milestones
from hypermap_lite.optimizers.modes import Modes
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.pareto.hypervolume import infer_reference_point
from hypermap_lite.surrogates.base import Predictor, Surrogate
from hypermap_lite.surrogates.failures import Failures
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior, ProbitProcess
from hypermap_lite.surrogates.reported import MixtureOfModes, WithFailures
from hypermap_lite.typing import BoolArray

logger = logging.getLogger(__name__)


class SeparateModels:
    """The models of a run after so many rows of its history, whose failures are those that were known by then.

    They are worked out at the milestones of the fits and kept between them, so they are a function of the history.

    Parameters
    ----------
    history, surrogate, feasibility_weighting, seed
        As in `Models`. Without a feasibility weighting nothing would keep the search away from failures, so there are
        none.
    knows_modes
        Whether the search knows what to do with two kinds of evaluations that the front needs.
    """

    def __init__(
        self,
        history: History,
        surrogate: Surrogate,
        feasibility_weighting: FeasibilityWeighting | None,
        seed: int,
        *,
        knows_modes: bool = False,
    ) -> None:
        self._history = history
        self._surrogate = surrogate
        self._feasibility_weighting = feasibility_weighting
        self._seed = seed
        self._knows_modes = knows_modes
        self._failures: dict[int, Failures | None] = {}
        self._models: dict[tuple[Failures | None, bool], tuple[Models, ToldApart | None]] = {}
        self._announced: set[object] = set()
        self._said: tuple[int, bool] | None = None

    def after(self, n: int | None = None) -> Models:
        """Return the models by what was known of failures after the first n rows, all by default.

        They know all rows by now. If there are `modes`, they are of all evaluations.
        """
        failures = self.failures(n)
        if n is None:
            self._announce(failures)
        if failures is not None and not failures.are_needed:
            return self._of(failures)
        models = self._of(None)
        models.is_silent = self.modes() is not None
        return models

    def modes(self) -> Modes | None:
        """Return the models of two kinds of evaluations of which the front needs both; None if there are none."""
        failures = self.failures()
        if failures is None or not failures.are_needed:
            return None
        return Modes(low=self._of(failures), high=self._of(failures, of_failures=True))

    def modes_since(self) -> int:
        """Return after how many completed evaluations there began to be the modes that there are now; 0 if none."""
        growth, since = self._surrogate.warm_start_growth, 0
        for k in () if growth is None else milestones(len(self._history.completed) + 1, growth):
            failures = self._failures_at(k)
            is_needed = failures is not None and failures.are_needed
            since = (since or k) if is_needed else 0
        return since

    def _of(self, failures: Failures | None, *, of_failures: bool = False) -> Models:
        """Return the models of what does not fail, or of what does; those of all if there is nothing of the kind."""
        key = failures, of_failures
        if key not in self._models:
            told_apart, weighting, history = None, self._feasibility_weighting, self._history
            if failures is not None and weighting is not None:
                # by the approximation that told them apart; both together gained nothing on skills
                weighting = replace(weighting, approximation="laplace")
                history = History(history.space, history.objectives, in_order=history.in_order)
                told_apart = ToldApart(objective=failures.objective, trials=set())
            models = Models(
                history,
                self._surrogate,
                weighting,
                self._seed,
                failures=told_apart,
                has_tails=failures is None or not failures.are_needed,
                announced=self._announced,
            )
            self._models[key] = models, told_apart
        models, told_apart = self._models[key]
        if failures is not None and told_apart is not None:
            for evaluation in list(self._history)[len(models.history) :]:
                if evaluation.is_completed and self._fails(evaluation, failures) != of_failures:
                    told_apart.trials.add(evaluation.trial)
                    evaluation = replace(evaluation, state=State.INFEASIBLE)
                models.history.append(evaluation)
        return models

    def with_failures(self, predictor: Predictor) -> Predictor:
        """Return what predicts the objectives wherever that may be, of what does so where an evaluation succeeds."""
        failures, Y = self.failures(), self._history.Y()
        if failures is None:
            return predictor
        if (modes := self.modes()) is not None:
            return MixtureOfModes(modes.known())
        return WithFailures(predictor=predictor, success=self._success(failures), failed=Y[failures.among(Y)])

    def fail_likely(self) -> BoolArray:
        """Tell which completed evaluations fail, or did not but likely would if they were repeated, shape (n,)."""
        failures, Y = self.failures(), self._history.Y()
        if failures is None or failures.are_needed:
            return np.zeros(len(Y), dtype=bool)
        is_unlikely = self._success(failures).log_probability(self._history.X()) < math.log(0.5)
        return np.asarray(failures.among(Y) | is_unlikely)

    def _success(self, failures: Failures) -> FeasibilityPosterior:
        """Return where completed evaluations succeed."""
        space = self._history.space
        succeeds = ~failures.among(self._history.Y())
        return ProbitProcess().fit(
            self._history.X(), succeeds, is_ordered=space.is_ordered, permutations=space.permutations
        )

    def failures(self, n: int | None = None) -> Failures | None:
        """Return which evaluations fail by the first n rows of the history, all by default."""
        growth = self._surrogate.warm_start_growth
        if growth is None or self._feasibility_weighting is None:
            return None
        n_completed = sum(row.is_completed for row in list(self._history)[:n])
        known = [0, *milestones(n_completed + 1, growth)]
        return self._failures_at(known[-1])

    def _failures_at(self, k: int) -> Failures | None:
        """Return which fail by the first k completed evaluations."""
        if not k:
            return None
        if k not in self._failures:
            X, Y = self._history.X()[:k], self._history.Y()[:k]
            objectives, space, corner = self._history.objectives, self._history.space, None
            least = np.full(1, -np.inf)
            if len(objectives) > 1:
                corner = stated_or(objectives, infer_reference_point(Y))
                least = stated_or(objectives, Y[non_dominated(Y)].max(axis=0))
            self._failures[k] = self._surrogate.failures(
                X,
                Y,
                least,
                corner,
                is_ordered=space.is_ordered,
                permutations=space.permutations,
                or_needed=self._knows_modes,
            )
        return self._failures[k]

    def _announce(self, failures: Failures | None) -> None:
        """Log when there begin to be failures, or those of another objective, and when there are none any more."""
        by = None if failures is None else (failures.objective, failures.are_needed)
        if by == self._said:
            return
        self._said, n = by, len(self._history.completed)
        if failures is None:
            logger.info("after %d completed evaluations: no evaluations are told apart any more", n)
            return
        objective = self._history.objectives[failures.objective]
        if failures.are_needed:
            logger.info(
                "after %d completed evaluations: values of %s are of two kinds, above and below %.4g, and the front"
                " needs both; the model learns where each of them is to be expected, and what it is like",
                n,
                objective.name,
                objective.sign * failures.limit,
            )
            return
        logger.info(
            "after %d completed evaluations: the %d with %s %s %.4g are a kind of their own, such as failures; the"
            " model learns where they are, and from the others what to expect",
            n,
            int(failures.among(self._history.Y()).sum()),
            objective.name,
            "above" if objective.sign > 0 else "below",
            objective.sign * failures.limit,
        )

    def _fails(self, evaluation: Evaluation, failures: Failures) -> bool:
        """Tell whether an evaluation is a failure."""
        if not evaluation.is_completed:
            return False
        return bool(failures.among(objectives_of([evaluation], self._history.objectives))[0])
