"""What a run tells whoever watches it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from hypermap_lite.evaluation.outcome import CONFIRM, Evaluation, Replicate
from hypermap_lite.history.pooling import pooled
from hypermap_lite.objectives import Objective, values_of
from hypermap_lite.pareto.dominance import non_dominated

SAID_BY_COMMAND: Final = {"is_said_by_command": True}
"""The `extra` of a log record that the command line says in its own way: for run.log, not twice for stderr."""


class RunObserver:
    """Gets word of a run's steps; this one ignores them. Override what is of interest."""

    def on_start(self, *, done: int, total: int) -> None:
        """Begin, or go on: `done` of `total` configurations are evaluated."""

    def on_suggestions(self, trials: Sequence[int], n_calls: int) -> None:
        """Some configurations were chosen, and `n_calls` calls of the black box are to be made for them."""

    def on_replicate(self, replicate: Replicate) -> None:
        """Take note of a call of the black box that ended; its row is on the disk."""

    def on_evaluation(self, evaluation: Evaluation, front: str) -> None:
        """Take note of a finished configuration and, in words, of what it did to the front; its row is on the disk."""


class FrontTracker:
    """Says what each evaluation does to the Pareto front; for one objective, to the best value."""

    def __init__(self, objectives: Sequence[Objective]) -> None:
        self.objectives = tuple(objectives)
        self._front = np.empty((0, len(self.objectives)))
        self._rows: list[Evaluation] = []

    @property
    def size(self) -> int:
        """Number of points on the front, duplicates included."""
        return len(self._front)

    def add(self, evaluation: Evaluation) -> str:
        """Take an evaluation in; return ``front +1``, ``front +1 -2``, ``best``, ``front of 5`` or nothing."""
        self._rows.append(evaluation)
        if evaluation.suggestion.phase == CONFIRM:
            return self._look_again()
        if not evaluation.is_completed:
            return ""
        points = np.vstack([self._front, values_of(self.objectives, evaluation.values)])
        is_optimal = non_dominated(points)
        dropped = int(np.sum(~is_optimal[:-1]))
        self._front = points[is_optimal]
        if not is_optimal[-1]:
            return ""
        if len(self.objectives) == 1:
            return "best" if dropped or self.size == 1 else ""
        return f"front +1 -{dropped}" if dropped else "front +1"

    def _look_again(self) -> str:
        """Work the front out anew, after a configuration was evaluated once more."""
        completed = [e for e in pooled(self._rows) if e.is_completed]
        Y = np.array([values_of(self.objectives, e.values) for e in completed])
        self._front = Y[non_dominated(Y)] if completed else self._front[:0]
        return f"front of {self.size}" if len(self.objectives) > 1 else ""


def describe(evaluation: Evaluation, front: str) -> str:
    """Return one line about an evaluation: ``trial 12 model completed 3.2 s performance=1.5, safety=-2, front +1``."""
    facts = [f"{name}={value:.4g}" for name, value in evaluation.values.items()]
    facts += [fact for fact in (front, evaluation.error) if fact]
    head = f"trial {evaluation.trial} {evaluation.suggestion.phase} {evaluation.state.value} {evaluation.seconds:.1f} s"
    return f"{head} {', '.join(facts)}".rstrip()
