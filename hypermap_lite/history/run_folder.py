"""A run on disk: locked, appended to row by row, and read back after a stop."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

import numpy as np

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import EARLIER, Evaluation, Replicate, State
from hypermap_lite.history.backups import keep_copies
from hypermap_lite.history.csv_format import complete_length, format_record, parse_rows, read_records
from hypermap_lite.history.exports import Exports
from hypermap_lite.history.files import append_durably, explained, truncate, write_atomically
from hypermap_lite.history.lock import FolderLock
from hypermap_lite.history.pooling import pooled
from hypermap_lite.history.rows import EvaluationsFormat, HistoryFormat, check_header, read_history
from hypermap_lite.history.run_log import run_log
from hypermap_lite.history.scenario_record import check_scenario, write_scenario
from hypermap_lite.objectives import FeasibleOutput, Objective, values_of
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.space.search_space import SearchSpace

logger = logging.getLogger(__name__)

FAILURES: Final = frozenset({State.FAILED, State.TIMEOUT})
"""States of evaluations that another try may mend."""


class RunFolder:
    """One run's files, open for writing as a context manager.

    A row is on the disk when the call that appends it returns. Whole files are only ever replaced at once.

    Parameters
    ----------
    path
        The folder; created with its parents.
    space, objectives
        What the columns mean.
    canonical
        The effective scenario as JSON, written beside the results and compared with what is there.
    function
        Name of the Python function that is called in place of the scenario's evaluator, if one was passed.
    feasible_output
        The column that says which configurations are feasible, if there is one.
    prior_columns
        Columns that say more of the priors than their weight, of `PRIOR_COLUMNS`.
    samples_file, pareto_file
        Files in HyperMapper's format that are kept up to date with it; see `Exports`.
    first_rows
        Asked for the evaluations of an earlier experiment that come first, if there are no rows yet.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        space: SearchSpace,
        objectives: Sequence[Objective],
        canonical: Mapping[str, Any],
        function: str | None = None,
        feasible_output: FeasibleOutput | None = None,
        prior_columns: Sequence[str] = (),
        samples_file: Path | None = None,
        pareto_file: Path | None = None,
        first_rows: Callable[[], Sequence[Evaluation]] = tuple,
    ) -> None:
        self.path = Path(path).absolute()
        self.space = space
        self.objectives = tuple(objectives)
        self.canonical = canonical
        self.function = function
        self.evaluations: list[Evaluation] = []
        """Rows of ``history.csv``, trial 0 first."""
        self.replicates: dict[tuple[int, int], Replicate] = {}
        """Rows of ``evaluations.csv`` by trial and replicate."""
        self.feasible_output = feasible_output
        self._history = HistoryFormat(space, objectives, feasible_output, prior_columns)
        self._calls = EvaluationsFormat(space, objectives, feasible_output=feasible_output)
        self._exports = Exports(self._history, samples_file=samples_file, pareto_file=pareto_file)
        self._first_rows = first_rows
        self._front_written: list[Evaluation] | None = None
        self._open = ExitStack()

    @property
    def history_path(self) -> Path:
        """``history.csv``: a row per configuration."""
        return self.path / "history.csv"

    @property
    def evaluations_path(self) -> Path:
        """``evaluations.csv``: a row per replicate."""
        return self.path / "evaluations.csv"

    @property
    def pareto_path(self) -> Path:
        """``pareto.csv``: the non-dominated rows of ``history.csv``, those of a confirmed configuration as one."""
        return self.path / "pareto.csv"

    @property
    def posterior_front_path(self) -> Path:
        """``posterior_front.csv``: the configurations that are best by the surrogate."""
        return self.path / "posterior_front.csv"

    @property
    def scenario_path(self) -> Path:
        """``scenario.json``: the effective scenario and the versions in use."""
        return self.path / "scenario.json"

    def trial_folder(self, trial: int) -> Path:
        """Return where the logs and files of one trial go; it may not exist yet."""
        return self.path / "trials" / f"{trial:04d}"

    def __enter__(self) -> Self:
        """Lock the folder, check that it belongs to the scenario, and read what is there.

        Raises
        ------
        RunFolderError
            If another process writes it, its scenario differs, a file is damaged, or it cannot be written.
        """
        with ExitStack() as stack:
            stack.enter_context(FolderLock(self.path))
            self._check_owner()
            stack.enter_context(run_log(self.path / "run.log"))
            self._load()
            write_scenario(self.scenario_path, self.canonical, self.function)
            self._begin()
            self._exports.restore(self.evaluations)
            self._open = stack.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the log and release the lock."""
        self._open.close()

    def _check_owner(self) -> None:
        if not self.scenario_path.exists() and self.history_path.exists():
            raise RunFolderError(
                f"{self.path}: has a history.csv but no scenario.json, so it is not known what its rows mean\n"
                "  hint: Choose another folder with --output-dir, or --fresh to start anew (this one is kept aside)."
            )
        check_scenario(self.scenario_path, self.canonical, self.function)

    def _load(self) -> None:
        for path in (self.history_path, self.evaluations_path):
            self._drop_torn_line(path)
        self.evaluations = read_history(self.history_path, self.space, self.objectives, self.feasible_output)
        records = read_records(self.evaluations_path)
        if records:
            self._calls.metrics = self._calls.metrics_in(records[0])
            check_header(self.evaluations_path, records[0], self._calls.columns)
        rows = parse_rows(self.evaluations_path, records, self._calls.parse)
        self.replicates = {(row.trial, row.replicate): row for row in rows}
        self._warn_of_missing_calls()

    def _begin(self) -> None:
        """Write the rows that a new run begins with, all at once and before any other file is touched."""
        if not self.evaluations and (rows := list(self._first_rows())):
            text = "".join(map(self._history.format, rows))
            write_atomically(self.history_path, format_record(self._history.columns) + text)
            self.evaluations = rows
            logger.info("the first %d rows are those of an earlier experiment", len(rows))

    def _warn_of_missing_calls(self) -> None:
        counts = Counter(trial for trial, _ in self.replicates)
        own = [e for e in self.evaluations if e.suggestion.phase != EARLIER]
        incomplete = [e.trial for e in own if counts[e.trial] < e.replicates]
        if incomplete:
            logger.warning(
                "%s: calls of %d finished trials are missing, the first of trial %d (was the file cut or deleted?); "
                "their rows in history.csv stand, and are not evaluated again",
                *(self.evaluations_path.name, len(incomplete), incomplete[0]),
            )

    def _drop_torn_line(self, path: Path) -> None:
        if path.exists():
            with explained(path):
                content = path.read_bytes()
            if (end := complete_length(content)) < len(content):
                if content[end:].strip():
                    logger.warning("%s: the last line was cut off and is dropped: %r", path.name, content[end:][:80])
                truncate(path, end)

    def trials_of_calls(self) -> list[int]:
        """Return the trial of each row of ``evaluations.csv``, in its order."""
        return [trial for trial, _ in self.replicates]

    def append_replicate(self, replicate: Replicate) -> None:
        """Add a finished call of the black box to ``evaluations.csv``.

        A new extra number gets its column by rewriting the file.
        """
        is_first = not self.replicates
        self.replicates[replicate.trial, replicate.replicate] = replicate
        new = [name for name in replicate.outcome.metrics if name not in self._calls.metrics]
        if new or is_first:
            self._calls.metrics = (*self._calls.metrics, *new)
            self._rewrite_calls(self.replicates.values())
        else:
            append_durably(self.evaluations_path, self._calls.format(replicate))

    def append_evaluation(self, evaluation: Evaluation) -> None:
        """Add the next configuration's row to ``history.csv``.

        Raises
        ------
        RunFolderError
            If it is not the next trial, or the file cannot be written.
        """
        if evaluation.trial != len(self.evaluations):
            raise RunFolderError(f"{self.history_path}: trial {evaluation.trial} is not the next one")
        row = self._history.format(evaluation)
        if self.evaluations:
            append_durably(self.history_path, row)
        else:
            write_atomically(self.history_path, format_record(self._history.columns) + row)
        self.evaluations.append(evaluation)
        self._exports.append(evaluation)

    def set_failures_aside(self) -> int:
        """Take the failures at the end out of the files, so that they are evaluated again; return their number.

        These are the last rows in a row that failed or ran out of time, with their calls, and the failed calls of
        configurations that have no row yet. The files as they were are kept as ``history.csv.bak-N`` and
        ``evaluations.csv.bak-N``.
        """
        n_kept = len(self.evaluations) - failures_at_end(self.evaluations)
        n_dropped = len(self.evaluations) - n_kept
        calls = {
            key: call
            for key, call in self.replicates.items()
            if key[0] < n_kept or (key[0] >= n_kept + n_dropped and call.outcome.state not in FAILURES)
        }
        if not n_dropped and len(calls) == len(self.replicates):
            return 0
        keep_copies([self.history_path, self.evaluations_path])
        self.evaluations = self.evaluations[:n_kept]
        rows = "".join(map(self._history.format, self.evaluations))
        # History first: should we be killed in between, its rows are made again from the calls that are still there.
        write_atomically(self.history_path, format_record(self._history.columns) + rows)
        self.replicates = calls
        self._rewrite_calls(calls.values())
        logger.info("%d failed evaluations at the end are set aside, to be called again", n_dropped)
        return n_dropped

    def write_pareto(self, *, only_if_changed: bool = False) -> None:
        """Rewrite ``pareto.csv`` from the rows so far; on request only if the front is another than the last time."""
        front = self.pareto_front()
        if only_if_changed and self._front_written is not None and _are_same(front, self._front_written):
            return
        self._front_written = front
        rows = "".join(map(self._history.format_once, front))
        write_atomically(self.pareto_path, format_record(self._history.columns) + rows)
        self._exports.write_front(front)

    def pareto_front(self) -> list[Evaluation]:
        """Return the non-dominated completed evaluations, confirmed ones pooled, in the order of the trials."""
        completed = [e for e in pooled(self.evaluations) if e.is_completed]
        if not completed:
            return []
        is_optimal = non_dominated(np.array([values_of(self.objectives, e.values) for e in completed]))
        return [e for e, keep in zip(completed, is_optimal, strict=True) if keep]

    def write_posterior_front(self, text: str | None) -> None:
        """Replace ``posterior_front.csv``; None takes it away, as it is not that of the rows any more.

        A folder in which that cannot be done only gets a warning: the file says nothing that was not known.
        """
        try:
            with explained(self.posterior_front_path):
                if text is None:
                    self.posterior_front_path.unlink(missing_ok=True)
                else:
                    write_atomically(self.posterior_front_path, text)
        except RunFolderError as error:
            logger.warning("%s", str(error).splitlines()[0])

    def sort_replicates(self) -> None:
        """Rewrite ``evaluations.csv`` in the order of trials and replicates, whichever finished first."""
        ordered = [self.replicates[key] for key in sorted(self.replicates)]
        self._calls.metrics = tuple(dict.fromkeys(name for row in ordered for name in row.outcome.metrics))
        if ordered:
            self._rewrite_calls(ordered)

    def _rewrite_calls(self, rows: Iterable[Replicate]) -> None:
        text = format_record(self._calls.columns) + "".join(map(self._calls.format, rows))
        write_atomically(self.evaluations_path, text)


def _are_same(first: Sequence[Evaluation], second: Sequence[Evaluation]) -> bool:
    """Tell whether two lists hold the same objects; equal ones will not do, for a standard error may be undefined."""
    return len(first) == len(second) and all(a is b for a, b in zip(first, second, strict=True))


def failures_at_end(evaluations: Sequence[Evaluation]) -> int:
    """Return how many of the last evaluations in a row failed or ran out of time."""
    return next((n for n, e in enumerate(reversed(evaluations)) if e.state not in FAILURES), len(evaluations))
