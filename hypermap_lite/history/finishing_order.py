"""The order in which the configurations of an asynchronous run finished, which its files keep."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from hypermap_lite.evaluation.outcome import Evaluation
from hypermap_lite.history.csv_format import parse_rows, read_records
from hypermap_lite.history.history import History
from hypermap_lite.history.rows import read_history
from hypermap_lite.objectives import FeasibleOutput


def in_finishing_order(evaluations: Iterable[Evaluation], trials: Iterable[int]) -> list[Evaluation]:
    """Return evaluations as they finished: each with its last call, of equals the lower trial first.

    Parameters
    ----------
    evaluations
        In any order. Those without calls, as of an earlier experiment, come first.
    trials
        The trial of every call, in the order in which calls ended: that of ``evaluations.csv``.
    """
    by_trial = {e.trial: e for e in evaluations}
    return [by_trial[trial] for trial in sorted_by_last_call(by_trial, trials)]


def sorted_by_last_call(trials: Iterable[int], calls: Iterable[int]) -> list[int]:
    """Return trials in the order of their last calls, those without one first; of equals the lower one first.

    Parameters
    ----------
    trials
        In any order.
    calls
        The trial of every call, in the order in which calls ended.
    """
    last_calls = {trial: k for k, trial in enumerate(calls)}
    return sorted(trials, key=lambda trial: (last_calls.get(trial, -1), trial))


def as_learnt(history: History, evaluations: Sequence[Evaluation], trials: Iterable[int]) -> list[Evaluation]:
    """Return the evaluations of a run, given in the order of the trials, in that in which its optimizer has them.

    The fit of a model depends on it in the last digits, and by its warm starts in more.

    Parameters
    ----------
    history
        Says which order that is.
    evaluations, trials
        See `in_finishing_order`.
    """
    return list(evaluations) if history.in_order else in_finishing_order(evaluations, trials)


def read_as_learnt(folder: Path, history: History, feasible_output: FeasibleOutput | None = None) -> list[Evaluation]:
    """Return the rows of a run folder in the order in which the optimizer of the run has them; see `as_learnt`.

    Raises
    ------
    RunFolderError
        If ``history.csv`` or ``evaluations.csv`` cannot be read.
    """
    rows = read_history(folder, history.space, history.objectives, feasible_output)
    calls = folder / "evaluations.csv"
    return as_learnt(history, rows, parse_rows(calls, read_records(calls), lambda record: int(record[0])))
