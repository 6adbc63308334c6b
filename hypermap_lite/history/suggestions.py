"""``suggestions.csv``: what an asynchronous run has asked for, written before it is evaluated.

With workers that do not wait for each other a suggestion rests on whatever had finished when it was made. So it is
recorded with that number: what a run asks after a stop, and what it has asked before, follows from its files.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.history.backups import keep_copies
from hypermap_lite.history.csv_format import (
    complete_length,
    format_configuration,
    format_number,
    format_record,
    parse_configuration,
    parse_rows,
    read_records,
)
from hypermap_lite.history.files import append_durably, explained, truncate, write_atomically
from hypermap_lite.history.rows import PRIOR_COLUMNS, check_header
from hypermap_lite.space.search_space import SearchSpace

NAME = "suggestions.csv"


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """A suggestion and what it rests on."""

    suggestion: Suggestion
    known: int
    """Finished configurations it rests on: the first so many, in the order in which they finished (for a search without
    a model: in that of their trials)."""


class SuggestionLog:
    """The file, one row per suggestion, appended to before its first call.

    Parameters
    ----------
    folder
        The run folder; whoever writes holds its lock.
    space
        What the columns mean.
    """

    def __init__(self, folder: Path, space: SearchSpace) -> None:
        self.path = folder / NAME
        self._space = space
        tail = ("acquisition_value", "suggest_seconds", "known")
        self._former_columns = (*space.names, "trial", "phase", "prior_weight", *tail)
        self._columns = (*space.names, "trial", "phase", "prior_weight", *PRIOR_COLUMNS, *tail)

    def read(self) -> list[Asked]:
        """Return all rows; a torn last one is dropped, for its calls had not begun.

        A file from before there were `PRIOR_COLUMNS` gets them, empty, so that the next rows have a place for them.

        Raises
        ------
        RunFolderError
            If its columns are not those of this space, or a record cannot be read.
        """
        records = read_records(self.path)
        if not records:
            return []
        is_former = tuple(records[0]) == self._former_columns
        check_header(self.path, records[0], self._former_columns if is_former else self._columns)
        with explained(self.path):
            content = self.path.read_bytes()
        if (end := complete_length(content)) < len(content):
            truncate(self.path, end)
        rows = parse_rows(self.path, records, self._parse)
        if is_former:
            self._write(rows)
        return rows

    def append(self, asked: Asked) -> None:
        """Add a row; it is on the disk when this returns.

        Raises
        ------
        RunFolderError
            If the file cannot be written.
        """
        if self.path.exists():
            append_durably(self.path, self._format(asked))
        else:
            self._write([asked])

    def keep(self, n: int) -> None:
        """Drop all rows but the first n; the file as it was is kept as ``suggestions.csv.bak-N``."""
        rows = self.read()
        if n < len(rows):
            keep_copies([self.path])
            self._write(rows[:n])

    def _write(self, rows: Iterable[Asked]) -> None:
        write_atomically(self.path, format_record(self._columns) + "".join(map(self._format, rows)))

    def _format(self, asked: Asked) -> str:
        suggestion = asked.suggestion
        return format_record(
            [
                *format_configuration(self._space, suggestion.configuration),
                *(str(suggestion.trial), suggestion.phase),
                *(format_number(suggestion.prior_weight), format_number(suggestion.prior_trust), suggestion.prior_of),
                *(format_number(suggestion.acquisition_value), f"{suggestion.seconds:.6f}", str(asked.known)),
            ]
        )

    def _parse(self, record: Sequence[str]) -> Asked:
        d = self._space.dimension
        trial, phase, weight, *of_prior = record[d:-3]
        trust, prior_of = of_prior or ("", "")
        acquisition, seconds, known = record[-3:]
        suggestion = Suggestion(
            trial=int(trial),
            configuration=parse_configuration(self._space, record[:d]),
            phase=phase,
            prior_weight=float(weight) if weight else None,
            prior_trust=float(trust) if trust else None,
            prior_of=prior_of,
            acquisition_value=float(acquisition) if acquisition else None,
            seconds=float(seconds),
        )
        return Asked(suggestion=suggestion, known=int(known))
