"""``samples_file`` and ``pareto_file``: the run in HyperMapper's format, beside its run folder.

The columns are those of ``history.csv`` up to ``Timestamp``: inputs, objectives, the feasibility column if the scenario
has one, and whole milliseconds since the start. Lines end in a plain newline. ``history.csv`` is the record; these
files follow from it, and are made to agree with it whenever the run folder is opened. What stands in the way is kept
aside.
"""

from __future__ import annotations

import csv
import io
import logging
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final

from hypermap_lite.errors import RunFolderError
from hypermap_lite.evaluation.outcome import CONFIRM, Evaluation, State
from hypermap_lite.history.backups import keep_copies
from hypermap_lite.history.csv_format import complete_length, format_record
from hypermap_lite.history.files import append_durably, encode, explained, make_folder, truncate, write_atomically
from hypermap_lite.history.pooling import pooled
from hypermap_lite.history.rows import HistoryFormat

logger = logging.getLogger(__name__)

LAST_COLUMN: Final = "Timestamp"
"""The last column that HyperMapper's files have."""


class Exports:
    """The two files of one run; either may be left out.

    Parameters
    ----------
    form
        Columns and rows of the run's ``history.csv``.
    samples_file
        A row per evaluation, in their order. Failed ones have no row, for the format has no way to say so; infeasible
        ones have none unless the scenario has a feasibility column.
    pareto_file
        The rows on the Pareto front.
    """

    def __init__(
        self, form: HistoryFormat, *, samples_file: Path | None = None, pareto_file: Path | None = None
    ) -> None:
        self._form = form
        self._samples_file = None if samples_file is None else samples_file.absolute()
        self._pareto_file = None if pareto_file is None else pareto_file.absolute()
        self._n_columns = form.columns.index(LAST_COLUMN) + 1
        self._has_feasibility = self._n_columns - 1 > form.space.dimension + len(form.names)
        self._header = format_record(form.columns[: self._n_columns])
        self._text = self._header
        """All that the samples file shall hold."""
        self._length = 0
        """Of the samples file as it was last written [bytes]."""
        self._is_disturbed = False

    def restore(self, evaluations: Sequence[Evaluation]) -> None:
        """Make both files hold these evaluations of the run, and nothing else; files of other runs are kept aside.

        Raises
        ------
        RunFolderError
            If a file cannot be written.
        """
        self._text = self._header + "".join(self._rows(evaluations))
        if self._samples_file is not None:
            make_folder(self._samples_file.parent)
            self._complete(self._samples_file)
        if self._pareto_file is not None:
            make_folder(self._pareto_file.parent)
            self._make_way(self._pareto_file, self._pooled_rows(evaluations))

    def append(self, evaluation: Evaluation) -> None:
        """Add one evaluation to the samples file; it is on the disk when this returns.

        Raises
        ------
        RunFolderError
            If the file cannot be written, or something else writes it again and again.
        """
        added = "".join(self._rows([evaluation]))
        self._text += added
        if self._samples_file is None or not added:
            return
        with explained(self._samples_file):
            is_as_left = self._samples_file.exists() and self._samples_file.stat().st_size == self._length
        if is_as_left:
            append_durably(self._samples_file, added)
            self._length += len(encode(added))
        elif self._is_disturbed:
            raise RunFolderError(
                f"{self._samples_file}: something else writes this file too\n"
                "  hint: Give each run an output.samples_file of its own; history.csv in the run folder is complete."
            )
        else:
            self._is_disturbed = True
            self._complete(self._samples_file)

    def write_front(self, evaluations: Iterable[Evaluation]) -> None:
        """Replace the pareto file by these rows."""
        if self._pareto_file is not None:
            write_atomically(self._pareto_file, self._header + "".join(self._rows(evaluations)))

    def _rows(self, evaluations: Iterable[Evaluation]) -> Iterator[str]:
        for evaluation in evaluations:
            if evaluation.is_completed or (evaluation.state is State.INFEASIBLE and self._has_feasibility):
                (fields,) = csv.reader(io.StringIO(self._form.format_once(evaluation), newline=""))
                yield format_record(fields[: self._n_columns])

    def _complete(self, path: Path) -> None:
        """Write what is missing at the end of the samples file; set it aside if it does not begin as this run does."""
        content, expected = _content(path), encode(self._text)
        whole = content[: complete_length(content)]
        if whole and expected.startswith(whole):
            if len(whole) < len(content):
                truncate(path, len(whole))
            if len(whole) < len(expected):
                append_durably(path, expected[len(whole) :].decode())
        else:
            _set_aside(path, content)
            write_atomically(path, self._text)
        self._length = len(expected)

    def _pooled_rows(self, evaluations: Sequence[Evaluation]) -> Iterator[str]:
        """Yield what stood on the front for a confirmed configuration at any time."""
        for i, evaluation in enumerate(evaluations):
            if evaluation.suggestion.phase == CONFIRM:
                yield from self._rows(pooled(evaluations[: i + 1]))

    def _make_way(self, path: Path, pooled_rows: Iterable[str]) -> None:
        """Set the pareto file aside unless each of its lines is one of this run."""
        content = _content(path)
        if not set(content.splitlines()) <= set(encode(self._text + "".join(pooled_rows)).splitlines()):
            _set_aside(path, content)
            write_atomically(path, self._header)


def _content(path: Path) -> bytes:
    with explained(path):
        return path.read_bytes() if path.exists() else b""


def _set_aside(path: Path, content: bytes) -> None:
    if content.strip():
        number = keep_copies([path])
        logger.warning("%s: it held something else than rows of this run, now in %s.bak-%d", path, path.name, number)
