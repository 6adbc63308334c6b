"""The CSV of a run: records, and text that reads back to exactly the same values.

One record ends with one newline outside quotes. So a file that was cut at any byte, by a kill or a power cut, still
holds all its records but perhaps the last, and `complete_length` says where that one starts.
"""

from __future__ import annotations

import csv
import io
import logging
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

from hypermap_lite.errors import RunFolderError
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.permutation import PermutationParameter
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Configuration, Value, as_argument

logger = logging.getLogger(__name__)

Row = TypeVar("Row")
"""What one record means."""


def format_record(fields: Sequence[str]) -> str:
    """Return one line of CSV with its newline; fields with separators or outer blanks are quoted."""
    return ",".join(map(_quote, fields)) + "\n"


def _quote(field: str) -> str:
    needs_quotes = any(c in field for c in ',"\r\n') or field != field.strip()
    return '"' + field.replace('"', '""') + '"' if needs_quotes else field


def complete_length(content: bytes) -> int:
    """Return how many bytes of a CSV file are whole records; blank lines at its end do not count."""
    end, start, is_quoted = 0, 0, False
    while (newline := content.find(b"\n", start)) >= 0:
        is_blank = not is_quoted and not content[start:newline].strip()
        is_quoted ^= content.count(b'"', start, newline) % 2 == 1
        start = newline + 1
        if not is_quoted and not is_blank:
            end = start
    return end


def read_records(path: Path) -> list[list[str]]:
    """Return the whole records of a file, header included; a torn last one is dropped with a warning.

    Returns no record if there is no such file.
    """
    if not path.exists():
        return []
    content = path.read_bytes()
    end = complete_length(content)
    if content[end:].strip():
        logger.warning("%s: the last line was cut off and is dropped: %r", path, content[end : end + 80])
    text = content[:end].decode("utf-8-sig", errors="replace")
    return list(csv.reader(io.StringIO(text, newline="")))


def parse_rows(path: Path, records: Sequence[Sequence[str]], parse: Callable[[Sequence[str]], Row]) -> list[Row]:
    """Turn the records below the header into rows.

    Raises
    ------
    RunFolderError
        If a record does not have the header's number of fields or holds an impossible value; its line is named.
    """
    rows: list[Row] = []
    for number, record in enumerate(records[1:], start=2):
        try:
            if len(record) != len(records[0]):
                raise ValueError(f"{len(record)} fields instead of {len(records[0])}")
            rows.append(parse(record))
        except (ValueError, KeyError) as error:
            raise RunFolderError(
                f"{path}: record {number} cannot be read: {error}\n"
                "  hint: Undo the change to this file, or start anew with --fresh (the old folder is kept aside)."
            ) from error
    return rows


def format_value(parameter: Parameter, value: Value) -> str:
    """Return a parameter's value as text that `parse_value` turns into an equal one."""
    if isinstance(value, str):
        return value
    if isinstance(value, tuple | list):
        return as_argument(value)
    is_whole = parameter.n_levels is not None and float(value).is_integer()
    return str(int(value)) if is_whole else repr(float(value))


def parse_value(parameter: Parameter, text: str) -> Value:
    """Return the legal value that a text stands for, in the type the parameter gives it.

    Raises
    ------
    ValueError
        If the parameter has no such value.
    """
    if isinstance(parameter, PermutationParameter):
        return parameter.parse(text)
    levels: Sequence[Value] | None = getattr(parameter, "values", None)
    value: Value
    if levels is not None:
        matching = [level for level in levels if format_value(parameter, level) == text or _equals(level, text)]
        if not matching:
            raise ValueError(f"{parameter.name} is {text!r}, which is not {parameter.allowed()}")
        return matching[0]
    value = float(text) if parameter.n_levels is None else int(text)
    if not parameter.contains(value):
        raise ValueError(f"{parameter.name} is {text}, which is not {parameter.allowed()}")
    return value


def _equals(level: Value, text: str) -> bool:
    try:
        return not isinstance(level, str) and float(text) == level
    except ValueError:
        return False


def format_number(value: float | None) -> str:
    """Return a number by its shortest exact text; nothing for None and NaN."""
    return "" if value is None or math.isnan(value) else repr(float(value))


def format_configuration(space: SearchSpace, configuration: Configuration) -> list[str]:
    """Return the values of a configuration as texts, in the order of the parameters."""
    return [format_value(p, configuration[p.name]) for p in space.parameters]


def parse_configuration(space: SearchSpace, fields: Sequence[str]) -> Configuration:
    """Return the configuration that d texts stand for."""
    return {p.name: parse_value(p, text) for p, text in zip(space.parameters, fields, strict=True)}


def parse_values(names: Sequence[str], fields: Sequence[str]) -> dict[str, float]:
    """Return the numbers among some fields by name, without the empty ones."""
    return {name: float(text) for name, text in zip(names, fields, strict=True) if text}
