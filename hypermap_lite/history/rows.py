"""What the columns of ``history.csv`` and ``evaluations.csv`` mean, and reading a history back."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import Evaluation, Outcome, Replicate, State, Suggestion
from hypermap_lite.history.csv_format import (
    format_configuration,
    format_number,
    format_record,
    parse_configuration,
    parse_rows,
    parse_values,
    read_records,
)
from hypermap_lite.objectives import FeasibleOutput, Objective
from hypermap_lite.space.search_space import SearchSpace

PRIOR_COLUMNS = ("prior_trust", "prior_of")
"""Columns after ``prior_weight`` of runs whose priors are checked, and of those whose objectives have their own."""

HISTORY_TAIL = ("prior_weight", "acquisition_value", "suggest_seconds", "evaluate_seconds", "error")
RESERVED_COLUMNS = frozenset(
    {
        "Timestamp",
        "trial",
        "phase",
        "state",
        "replicates",
        "replicate",
        "seed",
        "seconds",
        *HISTORY_TAIL,
        *PRIOR_COLUMNS,
    }
)
"""Names that parameters and objectives should not have, for then a column would have two meanings."""

METRIC_PREFIX = "result."
"""Put before the name of an extra number that would otherwise repeat another column's name."""


class HistoryFormat:
    """Columns and rows of ``history.csv`` for one search space, one list of objectives and a feasibility, if any.

    Those of `PRIOR_COLUMNS` are there where the run has something to say in them.
    """

    def __init__(
        self,
        space: SearchSpace,
        objectives: Sequence[Objective],
        feasible_output: FeasibleOutput | None = None,
        prior_columns: Sequence[str] = (),
    ) -> None:
        self.space = space
        self.names = tuple(o.name for o in objectives)
        self.flags = flags_of(feasible_output)
        self._formatted: dict[int, tuple[Evaluation, str]] = {}
        self._prior_columns = tuple(column for column in PRIOR_COLUMNS if column in prior_columns)
        self.columns: tuple[str, ...] = (
            *space.names,
            *self.names,
            *(flag.name for flag in self.flags),
            *("Timestamp", "trial", "phase", "state", "replicates"),
            *(f"{name}_sem" for name in self.names),
            *HISTORY_TAIL[:1],
            *self._prior_columns,
            *HISTORY_TAIL[1:],
        )

    def format(self, evaluation: Evaluation) -> str:
        """Return one evaluation as a record."""
        suggestion = evaluation.suggestion
        return format_record(
            [
                *format_configuration(self.space, suggestion.configuration),
                *(format_number(evaluation.values.get(name)) for name in self.names),
                *(flag.text(evaluation.state.is_feasible) for flag in self.flags),
                *(str(evaluation.timestamp), str(suggestion.trial), suggestion.phase),
                *(evaluation.state.value, str(evaluation.replicates)),
                *(format_number(evaluation.standard_errors.get(name)) for name in self.names),
                format_number(suggestion.prior_weight),
                *(_prior_text(suggestion, column) for column in self._prior_columns),
                format_number(suggestion.acquisition_value),
                f"{suggestion.seconds:.6f}",
                f"{evaluation.seconds:.6f}",
                evaluation.error,
            ]
        )

    def format_once(self, evaluation: Evaluation) -> str:
        """Return the same, made only once as long as the last evaluation of its trial is this object."""
        known = self._formatted.get(evaluation.trial)
        if known is None or known[0] is not evaluation:
            known = self._formatted[evaluation.trial] = (evaluation, self.format(evaluation))
        return known[1]

    def parse(self, record: Sequence[str]) -> Evaluation:
        """Return the evaluation that a record stands for."""
        d, m = self.space.dimension, len(self.names)
        facts = d + m + len(self.flags)
        timestamp, trial, phase, state, replicates = record[facts : facts + 5]
        weight, *of_prior = record[facts + m + 5 : -4]
        acquisition, suggest_seconds, evaluate_seconds, error = record[-4:]
        shown = dict(zip(self._prior_columns, of_prior, strict=True))
        trust = shown.get("prior_trust")
        check_flags(self.flags, record[d + m : facts], State(state))
        values = parse_values(self.names, record[d : d + m])
        suggestion = Suggestion(
            trial=int(trial),
            configuration=parse_configuration(self.space, record[:d]),
            phase=phase,
            prior_weight=float(weight) if weight else None,
            prior_trust=float(trust) if trust else None,
            prior_of=shown.get("prior_of", ""),
            acquisition_value=float(acquisition) if acquisition else None,
            seconds=float(suggest_seconds),
        )
        return Evaluation(
            suggestion=suggestion,
            state=State(state),
            values=values,
            standard_errors=self._standard_errors(values, record[facts + 5 : facts + m + 5]),
            replicates=int(replicates),
            seconds=float(evaluate_seconds),
            timestamp=int(timestamp),
            error=error,
        )

    def _standard_errors(self, values: Mapping[str, float], fields: Sequence[str]) -> dict[str, float]:
        return {
            name: float(text) if text else math.nan
            for name, text in zip(self.names, fields, strict=True)
            if name in values
        }


def _prior_text(suggestion: Suggestion, column: str) -> str:
    return suggestion.prior_of if column == "prior_of" else format_number(suggestion.prior_trust)


class EvaluationsFormat:
    """Columns and rows of ``evaluations.csv``, which grow by a column per extra number (metric) that turns up."""

    def __init__(
        self,
        space: SearchSpace,
        objectives: Sequence[Objective],
        metrics: Sequence[str] = (),
        *,
        feasible_output: FeasibleOutput | None = None,
    ) -> None:
        self.space = space
        self.names = tuple(o.name for o in objectives)
        self.metrics = tuple(metrics)
        self.flags = flags_of(feasible_output)
        flags = (flag.name for flag in self.flags)
        self._head = ("trial", "replicate", "seed", "state", *space.names, *self.names, *flags)

    @property
    def columns(self) -> tuple[str, ...]:
        """Header of the file."""
        return (*self._head, *map(self._column_of, self.metrics), "seconds", "error")

    def _column_of(self, metric: str) -> str:
        is_taken = metric in self._head or metric in RESERVED_COLUMNS or metric.startswith(METRIC_PREFIX)
        return METRIC_PREFIX + metric if is_taken else metric

    def metrics_in(self, header: Sequence[str]) -> tuple[str, ...]:
        """Return the names of the extra numbers that a file's header holds."""
        return tuple(column.removeprefix(METRIC_PREFIX) for column in header[len(self._head) : -2])

    def format(self, replicate: Replicate) -> str:
        """Return one replicate as a record."""
        outcome = replicate.outcome
        return format_record(
            [
                *(str(replicate.trial), str(replicate.replicate), str(replicate.seed), outcome.state.value),
                *format_configuration(self.space, replicate.configuration),
                *(format_number(outcome.values.get(name)) for name in self.names),
                *(flag.text(outcome.state.is_feasible) for flag in self.flags),
                *(format_number(outcome.metrics.get(name)) for name in self.metrics),
                f"{replicate.seconds:.6f}",
                outcome.error,
            ]
        )

    def parse(self, record: Sequence[str]) -> Replicate:
        """Return the replicate that a record stands for."""
        start = 4 + self.space.dimension
        end = start + len(self.names)
        rest = len(self._head)
        check_flags(self.flags, record[end:rest], State(record[3]))
        outcome = Outcome(
            state=State(record[3]),
            values=parse_values(self.names, record[start:end]),
            metrics=parse_values(self.metrics, record[rest:-2]),
            error=record[-1],
        )
        return Replicate(
            trial=int(record[0]),
            replicate=int(record[1]),
            seed=int(record[2]),
            configuration=parse_configuration(self.space, record[4:start]),
            outcome=outcome,
            seconds=float(record[-2]),
        )


def flags_of(feasible_output: FeasibleOutput | None) -> tuple[FeasibleOutput, ...]:
    """Return the feasibility as the columns it makes: one or none."""
    return () if feasible_output is None else (feasible_output,)


def check_flags(flags: Sequence[FeasibleOutput], fields: Sequence[str], state: State) -> None:
    """Raise a `ValueError` if a record's feasibility is not that of its state."""
    for flag, text in zip(flags, fields, strict=True):
        if text != flag.text(state.is_feasible):
            raise ValueError(f"{flag.name} is {text!r}, but the state is {state.value}")


def read_history(
    path: str | Path,
    space: SearchSpace,
    objectives: Sequence[Objective],
    feasible_output: FeasibleOutput | None = None,
) -> list[Evaluation]:
    """Read a ``history.csv``, given itself or its run folder; an absent file has no rows.

    A file without the column of the feasibility, or with those of other priors, is read all the same.

    Raises
    ------
    RunFolderError
        If its columns are not those of this space and these objectives, a record cannot be read, or trials are missing.
    """
    file = Path(path)
    file = file / "history.csv" if file.is_dir() else file
    records = read_records(file)
    if not records:
        return []
    if feasible_output is not None and feasible_output.name not in records[0]:
        feasible_output = None
    form = HistoryFormat(space, objectives, feasible_output, records[0])
    check_header(file, records[0], form.columns)
    rows = parse_rows(file, records, form.parse)
    for number, row in enumerate(rows):
        if row.trial != number:
            raise RunFolderError(f"{file}: record {number + 2} is trial {row.trial}, but trial {number} was expected")
    return rows


def check_header(path: Path, header: Sequence[str], expected: Sequence[str]) -> None:
    """Raise a `RunFolderError` if a file has other columns than expected."""
    if tuple(header) != tuple(expected):
        raise RunFolderError(
            f"{path}: its columns are not those of this scenario\n  found:    {json.dumps(list(header))}\n"
            f"  expected: {json.dumps(list(expected))}\n  hint: Choose another folder with --output-dir."
        )
