"""What every optimizer offers: ask for configurations, tell their evaluations."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cache
from time import process_time
from typing import Final

import numpy as np
from threadpoolctl import ThreadpoolController

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import RANDOM, Evaluation, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.confirmation import Confirmation

KEPT_NUMBERS: Final = 2_000_000
"""Size of the array that tells the C library how much memory to keep."""


@cache
def _thread_pools() -> ThreadpoolController:
    _keep_memory()
    return ThreadpoolController()


def _keep_memory() -> None:
    """Have the C library keep the memory of temporary arrays instead of returning it to the system each time.

    The GNU library returns what is freed at the end of the heap beyond a threshold, 128 KiB at first, and gets it back
    page by page: a fit to 200 evaluations takes twice as long. The threshold grows, to twice its size, when an array
    that was taken from the system directly is freed (mallopt(3), M_MMAP_THRESHOLD). Elsewhere this does nothing.
    """
    np.empty(KEPT_NUMBERS)


def single_threaded() -> AbstractContextManager[object]:
    """Return a context in which linear algebra uses one thread.

    Matrices of a few hundred rows gain nothing from more, and lose a factor of several where threads compete.
    """
    return _thread_pools().limit(limits=1)


class Optimizer(ABC):
    """Suggests configurations from the history of a run.

    The only state is the history and the pending suggestions: what `ask` returns is a function of the scenario,
    the completed evaluations and the pending ones, so a run that is told a stored history goes on as if it had
    never stopped.
    """

    def __init__(self, history: History) -> None:
        self.history = history
        self._pending: dict[int, Suggestion] = {}
        self._told: dict[int, Evaluation] = {}
        self.confirmation: Confirmation | None = None
        """What chooses the last evaluations of the budget, if they shall confirm the front."""

    @property
    def pending(self) -> list[Suggestion]:
        """Suggestions that wait for their result, in the order of their trials."""
        return [self._pending[trial] for trial in sorted(self._pending)]

    @property
    def in_flight(self) -> list[Suggestion]:
        """Suggestions that are not in the history: pending ones, and those told before an earlier one."""
        waiting = self._pending | {trial: evaluation.suggestion for trial, evaluation in self._told.items()}
        return [waiting[trial] for trial in sorted(waiting)]

    def ask(self, n: int = 1) -> list[Suggestion]:
        """Return up to n new suggestions; fewer only when a finite space holds no other configuration.

        Raises
        ------
        UsageError
            If n is not positive.
        """
        if n < 1:
            raise UsageError(f"ask({n}): the number of suggestions must be at least 1")
        suggestions: list[Suggestion] = []
        try:
            with single_threaded():
                while len(suggestions) < n:
                    start = process_time()
                    suggestion = self._next(self._next_trial())
                    if suggestion is None:
                        break
                    suggestion = replace(suggestion, seconds=process_time() - start)
                    self._pending[suggestion.trial] = suggestion
                    suggestions.append(suggestion)
        except BaseException:
            for suggestion in suggestions:  # nobody got them, so nobody could ever tell them
                del self._pending[suggestion.trial]
            raise
        return suggestions

    def _next_trial(self) -> int:
        """Return the first free number; a history in any order may have gaps, left by what was pending at its end."""
        n = len(self.history) + len(self.in_flight)
        if self.history.in_order:
            return n
        taken = {*self._pending, *(e.trial for e in self.history)}
        return next(trial for trial in range(n + 1) if trial not in taken)

    def _next(self, trial: int) -> Suggestion | None:
        """Return the suggestion of a trial; None if no configuration is left to explore, nor to confirm."""
        confirmation = self.confirmation
        if confirmation is None:
            return self._suggest(trial)
        if confirmation.is_due(trial):
            if not confirmation.is_left(self.history, self.in_flight) and self._is_exhausted(trial):
                return None
            return confirmation.suggestion(self.history, self.in_flight, trial) or self._suggest(trial)
        suggestion = self._suggest(trial)
        if suggestion is None and confirmation.is_left(self.history, self.in_flight):
            suggestion = confirmation.suggestion(self.history, self.in_flight, trial)
        return suggestion

    def _is_exhausted(self, trial: int) -> bool:
        """Tell whether a finite space holds no configuration that is new."""
        return math.isfinite(self.history.space.n_configurations) and self._suggest(trial) is None

    def tell(self, evaluations: Sequence[Evaluation]) -> None:
        """Record finished evaluations of pending suggestions, in any order.

        They enter the history in the order of their trials, so a later one waits for the earlier ones; at once, where
        the history is in any order.

        Raises
        ------
        UsageError
            If a trial was never asked for, or was told before, or an evaluation does not fit the history. Then nothing
            is recorded, and everything is still pending.
        """
        for i, evaluation in enumerate(evaluations):
            self._require_pending(evaluation.trial, "tell")
            if evaluation.trial in [other.trial for other in evaluations[:i]]:
                raise UsageError(f"tell: trial {evaluation.trial} is told twice")
            self.history.check(evaluation)
        for evaluation in evaluations:
            del self._pending[evaluation.trial]
            if self.history.in_order:
                self._told[evaluation.trial] = evaluation
            else:
                self.history.append(evaluation)
        while (following := self._told.pop(len(self.history), None)) is not None:
            self.history.append(following)

    def adopt(self, suggestion: Suggestion) -> None:
        """Replace the pending suggestion of the same trial, as when part of it has been evaluated before a stop.

        Raises
        ------
        UsageError
            If the trial is not pending.
        """
        self._require_pending(suggestion.trial, "adopt")
        self._pending[suggestion.trial] = suggestion

    def phase_if_new(self, trial: int) -> str:
        """Return the phase of a trial that does not confirm an earlier one, though it may be time for that."""
        with single_threaded():
            suggestion = self._suggest(trial)
        return RANDOM if suggestion is None else suggestion.phase

    def expect(self, suggestions: Sequence[Suggestion]) -> None:
        """Take up suggestions that an earlier session made and whose results are still to come."""
        self._pending |= {suggestion.trial: suggestion for suggestion in suggestions}

    def _require_pending(self, trial: int, verb: str) -> None:
        if trial not in self._pending:
            known = ", ".join(map(str, sorted(self._pending))) or "none; call ask() first"
            raise UsageError(f"{verb}: trial {trial} is not pending (pending: {known})")

    def taken_keys(self) -> list[bytes]:
        """Return the keys of all configurations that are in the history or on their way to it."""
        space = self.history.space
        in_flight = space.encode([s.configuration for s in self.in_flight])
        return space.keys(np.vstack([self.history.X_all(), in_flight]))

    @abstractmethod
    def _suggest(self, trial: int) -> Suggestion | None:
        """Choose the configuration of one trial from the history and the pending ones; None if none is left."""
