"""Reading a CSV file that a scenario names, whoever wrote it: a header, and texts below it."""

from __future__ import annotations

import csv
import io
import logging
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hypermap_lite.errors import ScenarioError, nearest

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Table:
    """The content of a CSV file."""

    name: str
    """What messages call the file."""

    header: tuple[str, ...]
    """Names of the columns, without blanks around them."""

    records: tuple[Sequence[str], ...]
    """Texts of each record below the header, one per column."""

    numbers: tuple[int, ...]
    """Number of each record in the file, as messages count them; the header is record 1."""

    def column(self, name: str) -> list[str]:
        """Return the texts of one column, without blanks around them."""
        j = self.header.index(name)
        return [record[j].strip() for record in self.records]


def find_file(file: str, folders: Sequence[Path]) -> Path:
    """Return where a CSV file or run folder is that a scenario names: in the first of some folders that has it.

    Raises
    ------
    ScenarioError
        If none has it; the message offers the nearest name.
    """
    written = Path(os.path.expanduser(file))
    path = next((folder / written for folder in folders if (folder / written).exists()), None)
    if path is None:
        places = dict.fromkeys((folder / written).parent for folder in folders)
        others = [other.name for place in places if place.is_dir() for other in place.iterdir()]
        allowed = "a CSV file or run folder, relative to the file that says it or to the working directory"
        raise ScenarioError("$", f"there is no file '{file}'", allowed=allowed, hint=nearest(written.name, others))
    return path


def read_table(path: Path, name: str) -> Table:
    """Return the content of a CSV file; `name` is what messages call it.

    A last line without newline counts if it has all its fields; else it was cut off, and is dropped with a warning.

    Raises
    ------
    ScenarioError
        If the file cannot be read, or is no CSV: no header, a column twice, a record of another length.
    """
    text = _read_text(path, name)
    try:
        records = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise _no_csv(name, str(error)) from None
    numbered = [(number, record) for number, record in enumerate(records, start=1) if any(map(str.strip, record))]
    if not numbered:
        raise ScenarioError("$", f"{name} is empty", allowed="a CSV file with a header")
    header, *rows = numbered
    columns = tuple(column.strip() for column in header[1])
    repeated = [column for i, column in enumerate(columns) if column in columns[:i]]
    if repeated:
        raise _no_csv(name, f"two columns are called '{repeated[0]}'")
    if rows and len(rows[-1][1]) < len(columns) and not text.endswith(("\n", "\r")):
        logger.warning("%s: the last line was cut off and is dropped", name)
        rows.pop()
    for number, record in rows:
        if len(record) != len(columns):
            raise _no_csv(name, f"record {number} has {len(record)} fields, the header {len(columns)}")
    return Table(name, columns, tuple(record for _, record in rows), tuple(number for number, _ in rows))


def _read_text(path: Path, name: str) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _no_csv(name, f"byte {error.start} is not UTF-8") from None
    except OSError as error:
        raise ScenarioError("$", f"{name} cannot be read: {error.strerror or error}") from None


def _no_csv(name: str, what: str) -> ScenarioError:
    return ScenarioError("$", f"{name} is not a table: {what}", allowed="a CSV file: UTF-8, commas, a header")
