"""The loop without batches: as soon as a worker is free, ask for one configuration more.

What is being evaluated counts as pending, what has finished counts at once, whatever its trial number. So a suggestion
depends on which evaluations had finished when it was made. Everything that order decides is on the disk before it has
a consequence: a call when it ends (``evaluations.csv`` keeps the order in which calls ended), a suggestion before its
first call (``suggestions.csv``). A run that goes on takes both up, evaluates what was being evaluated, and asks on.
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field

from hypermap_lite.evaluation.aggregation import summarize
from hypermap_lite.evaluation.evaluator import EvaluationRequest
from hypermap_lite.evaluation.outcome import Evaluation, Suggestion
from hypermap_lite.evaluation.racing import Race
from hypermap_lite.evaluation.runner import Runner, StopReason
from hypermap_lite.history.finishing_order import in_finishing_order, sorted_by_last_call
from hypermap_lite.history.suggestions import Asked, SuggestionLog

logger = logging.getLogger(__name__)


@dataclass(kw_only=True)
class AsynchronousRunner(Runner):
    """Drives one run with workers that never wait for each other; see `Runner`.

    Rows of ``history.csv`` still stand in the order of the trials: one whose trial is ahead of an unfinished one waits
    for it, its calls being safe in ``evaluations.csv``. ``Timestamp`` says when a configuration was finished.
    """

    _log: SuggestionLog = field(init=False)
    _open: dict[int, Suggestion] = field(init=False, default_factory=dict)
    """Suggestions that wait for calls, by trial."""

    _ahead: dict[int, Evaluation] = field(init=False, default_factory=dict)
    """Finished configurations that wait for an earlier trial, by trial."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._race = Race.against((), self.folder.objectives, None, self.replicates)
        self._log = SuggestionLog(self.folder.path, self.folder.space)

    def set_failures_aside(self) -> None:
        """Have the last failures evaluated again, and forget what was asked in their knowledge and has no call."""
        finished = self._finished_trials()
        rows, calls = len(self.folder.evaluations), set(self.folder.replicates)
        super().set_failures_aside()
        gone = {trial for trial, _ in calls - set(self.folder.replicates)}
        gone |= {*range(len(self.folder.evaluations), rows)}
        if not gone:
            return
        known = next((n for n, trial in enumerate(finished) if trial in gone), len(finished))
        begun = {trial for trial, _ in self.folder.replicates} | {e.trial for e in self.folder.evaluations}
        asked = self._log.read()
        is_kept = [a.known <= known or a.suggestion.trial in begun for a in asked]
        self._log.keep(max((n for n, keep in enumerate(is_kept, start=1) if keep), default=0))

    def _finished_trials(self) -> list[int]:
        """Return the trials on disk with all their calls, in the order in which the optimizer was told of them."""
        calls = self.folder.trials_of_calls()
        rows = {e.trial for e in self.folder.evaluations}
        if self.optimizer.history.in_order:
            return sorted(rows)
        finished = rows | {trial for trial, n in Counter(calls).items() if n >= self.replicates}
        return sorted_by_last_call(finished, calls)

    def _tell_rows(self) -> None:
        """Tell the optimizer everything that is finished in the order in which it was, and what was being evaluated."""
        rows = self.folder.evaluations
        asked = {a.suggestion.trial: self._with_recorded_configuration(a.suggestion) for a in self._log.read()}
        for trial in (trial for trial in asked if trial >= len(rows)):
            done = self._calls_if_done(asked[trial])
            if done is None:
                self._open[trial] = asked[trial]
            else:
                self._ahead[trial] = summarize(asked[trial], done, max((row.timestamp for row in rows), default=0))
        if self.optimizer.history.in_order:
            self.optimizer.history.extend(rows)
            self.optimizer.expect([asked[trial] for trial in sorted({*self._open, *self._ahead})])
            self.optimizer.tell([*self._ahead.values()])
        else:
            finished = [*rows, *self._ahead.values()]
            self.optimizer.history.extend(in_finishing_order(finished, self.folder.trials_of_calls()))
            self.optimizer.expect([*self._open.values()])

    def _tidy_up(self) -> None:
        """Write the front; the order of the calls is left as it is, for it means something."""
        self.folder.write_pareto()

    @property
    def _n_begun(self) -> int:
        return len(self.optimizer.history) + len(self.optimizer.in_flight)

    def _loop(self) -> StopReason:
        self._record_in_order()
        with closing(self.executor.run(self.evaluator, self._requests())) as finished:
            for call in finished:
                self.folder.append_replicate(call)
                self.observer.on_replicate(call)
                self._finish(call.trial)
        self._check_failures()
        self.folder.write_pareto()
        reason = self._reason_to_stop()
        if self._open and reason is not StopReason.INTERRUPTED:
            raise RuntimeError(f"trial {min(self._open)} was evaluated, but its result did not arrive")
        return StopReason.EXHAUSTED if reason is None else reason

    def _requests(self) -> Iterator[EvaluationRequest]:
        """Yield the missing calls of what has been asked for, then ask for more as long as there is a reason to."""
        for suggestion in [*self._open.values()]:
            yield from self._requests_of(suggestion)
        while self._reason_to_stop() is None:
            known = len(self.optimizer.history)
            suggestions = [self._as_recorded(s) for s in self.optimizer.ask(1)]
            if not suggestions:
                return
            (suggestion,) = suggestions
            self._log.append(Asked(suggestion=suggestion, known=known))
            self._open[suggestion.trial] = suggestion
            yield from self._requests_of(suggestion)

    def _requests_of(self, suggestion: Suggestion) -> Iterator[EvaluationRequest]:
        missing = list(self._missing([suggestion]))
        self.observer.on_suggestions([suggestion.trial], len(missing))
        if not missing:
            self._finish(suggestion.trial)
        for request in missing:
            if self.should_stop():
                return
            yield request

    def _finish(self, trial: int) -> None:
        """Tell the optimizer of a configuration if all its calls are done, and write the rows that are next."""
        done = self._calls_if_done(self._open[trial])
        if done is None:
            return
        self._ahead[trial] = summarize(self._open.pop(trial), done, self._clock.ms)
        self.optimizer.tell([self._ahead[trial]])
        self._record_in_order()

    def _record_in_order(self) -> None:
        while (evaluation := self._ahead.pop(len(self.folder.evaluations), None)) is not None:
            self._record(evaluation)
