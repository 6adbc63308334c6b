"""``suggestions.csv``: what an asynchronous run has asked for, written before it is evaluated.

With workers that do not wait for each other a suggestion rests on whatever had finished when it was made. So it is
recorded with that number: what a run asks after a stop, and what it has asked before, follows from its files.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hypermap_lite.evaluation.outcome import Suggestion
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
from hypermap_lite.history.rows import check_header
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
        self._columns = (
            *space.names,
            *("trial", "phase", "prior_weight", "acquisition_value", "suggest_seconds", "known"),
        )

    def read(self) -> list[Asked]:
        """Return all rows; a torn last one is dropped, for its calls had not begun.

        Raises
        ------
        RunFolderError
            If its columns are not those of this space, or a record cannot be read.
        """
        records = read_records(self.path)
        if not records:
            return []
        check_header(self.path, records[0], self._columns)
        with explained(self.path):
            content = self.path.read_bytes()
        if (end := complete_length(content)) < len(content):
            truncate(self.path, end)
        return parse_rows(self.path, records, self._parse)

    def append(self, asked: Asked) -> None:
        """Add a row; it is on the disk when this returns.

        Raises
        ------
        RunFolderError
            If the file cannot be written.
        """
        row = self._format(asked)
        if self.path.exists():
            append_durably(self.path, row)
        else:
            write_atomically(self.path, format_record(self._columns) + row)

    def _format(self, asked: Asked) -> str:
        suggestion = asked.suggestion
        return format_record(
            [
                *format_configuration(self._space, suggestion.configuration),
                *(str(suggestion.trial), suggestion.phase),
                *(format_number(suggestion.prior_weight), format_number(suggestion.acquisition_value)),
                *(f"{suggestion.seconds:.6f}", str(asked.known)),
            ]
        )

    def _parse(self, record: Sequence[str]) -> Asked:
        d = self._space.dimension
        trial, phase, weight, acquisition, seconds, known = record[d:]
        suggestion = Suggestion(
            trial=int(trial),
            configuration=parse_configuration(self._space, record[:d]),
            phase=phase,
            prior_weight=float(weight) if weight else None,
            acquisition_value=float(acquisition) if acquisition else None,
            seconds=float(seconds),
        )
        return Asked(suggestion=suggestion, known=int(known))
