"""The loop: ask for a batch, evaluate it, write it down, tell the optimizer.

A `BatchPlan` cuts the trials into batches, counted from the first one that is not of an earlier experiment, and the
optimizer sees the results of a batch only when all of it is done. So a run that goes on after a stop asks the same
questions as one that never stopped, and the number of workers does not matter.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from enum import Enum

from hypermap_lite.errors import ClientError, NoValidEvaluationError, RepeatedFailureError
from hypermap_lite.evaluation.aggregation import summarize
from hypermap_lite.evaluation.batch_plan import BatchPlan
from hypermap_lite.evaluation.evaluator import EvaluationRequest, Evaluator
from hypermap_lite.evaluation.executors import Executor
from hypermap_lite.evaluation.observer import SAID_BY_COMMAND, FrontTracker, RunObserver, describe
from hypermap_lite.evaluation.outcome import CONFIRM, EARLIER, Evaluation, Replicate, Suggestion
from hypermap_lite.evaluation.racing import Race
from hypermap_lite.evaluation.seeds import replicate_seed
from hypermap_lite.evaluation.streaks import failures_at_end, is_failure, is_too_long
from hypermap_lite.history.run_folder import RunFolder
from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.scenario.model import BudgetSpec, RacingSpec
from hypermap_lite.typing import Configuration

logger = logging.getLogger(__name__)


class StopReason(Enum):
    """Why a run ended."""

    BUDGET = "the budget of evaluations is used up"
    TIME = "the time is up"
    EXHAUSTED = "the search space holds no other configuration"
    INTERRUPTED = "it was interrupted"


class Clock:
    """Time spent on a run, over all its sessions: each goes on from the last row of the one before."""

    def __init__(self, elapsed_ms: int = 0) -> None:
        self._elapsed_ms = elapsed_ms
        self._start = time.monotonic()

    @property
    def ms(self) -> int:
        """Time since the run began, without the time between its sessions [ms]."""
        return self._elapsed_ms + round(1000 * (time.monotonic() - self._start))


@dataclass(kw_only=True)
class Runner:
    """Drives one run from wherever its folder stands to its end."""

    optimizer: Optimizer
    """With an empty history; what the folder holds is told to it."""

    evaluator: Evaluator
    executor: Executor
    folder: RunFolder
    """Open for writing."""

    budget: BudgetSpec
    seed: int
    plan: BatchPlan | None = None
    """None: batches of the budget's size."""

    replicates: int = 1
    racing: RacingSpec | None = None
    """When the replicates of a configuration are stopped; None: never."""

    max_consecutive_failures: int | None = None
    """So many configurations in a row without a usable result end the run; None: see `streaks.is_too_long`."""

    observer: RunObserver = field(default_factory=RunObserver)
    should_stop: Callable[[], bool] = lambda: False
    """Asked before every call; once true, running calls are waited for and no other is begun."""

    _plan: BatchPlan = field(init=False)
    """Of the trials that are not of an earlier experiment."""

    _n_earlier: int = field(init=False, default=0)
    _clock: Clock = field(init=False)
    _earlier_ms: int = field(init=False, default=0)
    _front: FrontTracker = field(init=False)
    _race: Race = field(init=False)
    """Of the batch that is being evaluated."""

    _failures: int = field(init=False, default=0)
    """Configurations without a usable result in a row, up to now."""

    def __post_init__(self) -> None:
        self._plan = self.plan or BatchPlan(size=self.budget.batch_size)

    def set_failures_aside(self) -> None:
        """Have the failures at the end of an earlier session evaluated again; call it before `run`."""
        if not self.folder.set_failures_aside() and any(map(is_failure, self.folder.evaluations)):
            logger.info("no failure is evaluated anew: only those after the last usable result are, and there is none")

    def run(self) -> StopReason:
        """Evaluate until the budget, the time or the search space is used up, or a stop is asked for.

        Raises
        ------
        RepeatedFailureError
            If too many configurations in a row failed or ran past the time limit.
        ClientError
            If the client that evaluates breaks the protocol or is gone.
        NoValidEvaluationError
            If the run ends and no configuration at all gave a usable result.
        RunFolderError
            If the folder cannot be written; what was finished before is kept.
        """
        self._restore()
        try:
            reason = self._loop()
        except (RepeatedFailureError, ClientError) as error:
            logger.error("the run is stopped: %s", str(error).partition("\n")[0], extra=SAID_BY_COMMAND)
            self._tidy_up()
            raise
        self._tidy_up()
        logger.info("the run ends after %d evaluations: %s", len(self.folder.evaluations), reason.value)
        if reason is not StopReason.INTERRUPTED:
            self._require_result(reason)
        return reason

    def _tidy_up(self) -> None:
        self.folder.sort_replicates()
        self.folder.write_pareto()

    def _restore(self) -> None:
        """Go on from what is on disk."""
        rows = self.folder.evaluations
        self._n_earlier = sum(row.suggestion.phase == EARLIER for row in rows)
        self._plan = (self.plan or BatchPlan(size=self.budget.batch_size)).after(self._n_earlier)
        self._tell_rows()
        self._clock = Clock(max((row.timestamp for row in rows), default=0))
        self._earlier_ms = max((row.timestamp for row in rows[: self._n_earlier]), default=0)
        self._front = FrontTracker(self.folder.objectives)
        for row in rows:
            self._front.add(row)
        # After a stop for failures the same command tries anew; after any other stop the count goes on.
        self._failures = failures_at_end(rows, self.optimizer.history.space, self.max_consecutive_failures)
        if rows or self.folder.replicates:
            n_calls = len(self.folder.replicates)
            logger.info("going on with %s: %d evaluations, %d calls are done", self.folder.path, len(rows), n_calls)
        self.observer.on_start(done=len(rows), total=self.budget.evaluations)

    def _tell_rows(self) -> None:
        """Tell the optimizer the batches that are complete on disk."""
        rows = self.folder.evaluations
        is_finished = len(rows) >= self.budget.evaluations
        n_complete = self._n_earlier + self._plan.n_in_whole_batches(len(rows) - self._n_earlier)
        self.optimizer.history.extend(rows if is_finished else rows[:n_complete])

    def _loop(self) -> StopReason:
        while (reason := self._reason_to_stop()) is None:
            done = len(self.optimizer.history)
            end = self._n_earlier + self._plan.end_of_batch(done - self._n_earlier)
            n = min(end, self.budget.evaluations) - done
            suggestions = [self._as_recorded(s) for s in self.optimizer.ask(n)]
            if not suggestions:
                return StopReason.EXHAUSTED
            self._evaluate(suggestions)
        return reason

    def _reason_to_stop(self) -> StopReason | None:
        if self.should_stop():
            return StopReason.INTERRUPTED
        if self._n_begun >= self.budget.evaluations:
            return StopReason.BUDGET
        if self.budget.minutes is not None and self._run_ms >= 60_000 * self.budget.minutes:
            return StopReason.TIME
        return None

    @property
    def _n_begun(self) -> int:
        """Configurations that count towards the budget so far."""
        return len(self.optimizer.history)

    @property
    def _run_ms(self) -> int:
        """Time spent on this run, without that of an earlier experiment [ms]."""
        return self._clock.ms - self._earlier_ms

    def _as_recorded(self, suggestion: Suggestion) -> Suggestion:
        """Return the suggestion with the configuration that was evaluated before the stop, if it was another."""
        adopted = self._with_recorded_configuration(suggestion)
        if adopted is not suggestion:
            self.optimizer.adopt(adopted)
        return adopted

    def _with_recorded_configuration(self, suggestion: Suggestion) -> Suggestion:
        """Return the suggestion, or what is known of the one that was begun: no more than its configuration says."""
        trial, rows = suggestion.trial, self.folder.evaluations
        recorded = self._recorded_configuration(trial)
        if recorded is None or recorded == suggestion.configuration:
            return suggestion
        logger.warning(
            "trial %d would now be %s, but %s has been evaluated and is kept "
            "(was the budget, the code or a library changed?)",
            *(trial, suggestion.configuration, recorded),
        )
        if trial < len(rows):
            return rows[trial].suggestion
        phase = suggestion.phase
        if any(row.configuration == recorded for row in rows):  # nothing else repeats one
            phase = CONFIRM
        elif phase == CONFIRM:
            phase = self.optimizer.phase_if_new(trial)
        return Suggestion(trial=trial, configuration=recorded, phase=phase, seconds=suggestion.seconds)

    def _recorded_configuration(self, trial: int) -> Configuration | None:
        if trial < len(self.folder.evaluations):
            return self.folder.evaluations[trial].configuration
        calls = (self.folder.replicates.get((trial, r)) for r in range(self.replicates))
        return next((call.configuration for call in calls if call is not None), None)

    def _evaluate(self, suggestions: Sequence[Suggestion]) -> None:
        """Make the calls of a batch that are missing; tell the optimizer if none is missing any more."""
        rows, objectives = list(self.optimizer.history), self.folder.objectives
        self._race = Race.against(rows, objectives, self.racing, self.replicates)
        n_calls = sum(self.replicates - len(self._calls_of(s)) for s in suggestions if self._is_open(s))
        self.observer.on_suggestions([s.trial for s in suggestions], n_calls)
        self._record_finished(suggestions)
        while missing := list(self._missing(suggestions)):
            self._make_calls(missing, suggestions)
            if any((request.trial, request.replicate) not in self.folder.replicates for request in missing):
                break
        self._check_failures()
        rows = self.folder.evaluations[suggestions[0].trial : suggestions[-1].trial + 1]
        self.folder.write_pareto(only_if_changed=True)
        if len(rows) == len(suggestions):
            self.optimizer.tell(rows)
        elif not self.should_stop():  # asking again would go on for ever
            raise RuntimeError(f"trial {suggestions[0].trial + len(rows)} was evaluated, but its result did not arrive")

    def _make_calls(self, missing: Sequence[EvaluationRequest], suggestions: Sequence[Suggestion]) -> None:
        requests = (request for request in missing if not self.should_stop())
        with closing(self.executor.run(self.evaluator, requests)) as finished:
            for call in finished:
                self.folder.append_replicate(call)
                self.observer.on_replicate(call)
                self._record_finished(suggestions)

    def _is_open(self, suggestion: Suggestion) -> bool:
        return suggestion.trial >= len(self.folder.evaluations)

    def _calls_of(self, suggestion: Suggestion) -> list[Replicate]:
        """Return the calls of a trial that are done."""
        calls = (self.folder.replicates.get((suggestion.trial, r)) for r in range(self.replicates))
        return [call for call in calls if call is not None]

    def _missing(self, suggestions: Sequence[Suggestion]) -> Iterator[EvaluationRequest]:
        """Yield the calls that are known to be needed and not done; in a race more may follow from their results."""
        for suggestion in filter(self._is_open, suggestions):
            trial = suggestion.trial
            for r in range(self._race.required(suggestion, self._calls_of(suggestion))):
                if (trial, r) not in self.folder.replicates:
                    yield EvaluationRequest(
                        trial=trial,
                        replicate=r,
                        seed=replicate_seed(self.seed, trial, r),
                        configuration=suggestion.configuration,
                        directory=self.folder.trial_folder(trial),
                    )

    def _record_finished(self, suggestions: Sequence[Suggestion]) -> None:
        """Write the rows of the configurations that are done, in order, up to the first that is not."""
        for suggestion in suggestions[len(self.folder.evaluations) - suggestions[0].trial :]:
            done = self._calls_if_done(suggestion)
            if done is None:
                return
            self._record(summarize(suggestion, done, self._clock.ms))

    def _calls_if_done(self, suggestion: Suggestion) -> list[Replicate] | None:
        """Return the calls of a configuration that count; None if one is missing."""
        done = self._calls_of(suggestion)
        needed = self._race.required(suggestion, done)
        counting = [call for call in done if call.replicate < needed]
        return None if len(counting) < needed else counting

    def _record(self, evaluation: Evaluation) -> None:
        self.folder.append_evaluation(evaluation)
        front = self._front.add(evaluation)
        logger.info("%s", describe(evaluation, front))
        self.observer.on_evaluation(evaluation, front)
        self._failures = self._failures + 1 if is_failure(evaluation) else 0
        if not self.executor.is_one_call:
            self._check_failures()

    def _check_failures(self) -> None:
        rows, space = self.folder.evaluations, self.optimizer.history.space
        if self._failures and is_too_long(rows, self._failures, space, self.max_consecutive_failures):
            raise RepeatedFailureError(
                f"the last {self._failures} configurations gave no usable result: {rows[-1].error}\n"
                f"  logs: {self.folder.trial_folder(rows[-1].trial)}\n"
                "  hint: Mend the evaluator and give the same command again with --retry-failed, which evaluates them "
                "anew; without it they count. Or, if it fails because of the parameters, set "
                "evaluator.max_consecutive_failures to more; `check` says whether the search keeps away from where it "
                "failed."
            )

    def _require_result(self, reason: StopReason) -> None:
        rows = self.folder.evaluations
        if any(row.is_completed for row in rows):
            return
        first = f"; trial 0 {rows[0].state.value}: {rows[0].error}" if rows else ""
        raise NoValidEvaluationError(
            f"none of the {len(rows)} evaluations gave a usable result{first}\n"
            f"  the run ended because {reason.value}\n  logs: {self.folder.path / 'trials'}"
        )
