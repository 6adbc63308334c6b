"""Finding the row of a CSV file that is about a configuration, whatever way its values are written."""

from __future__ import annotations

import contextlib
import csv
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.history.csv_format import parse_value
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.search_space import KEY_DECIMALS, SearchSpace
from hypermap_lite.typing import Configuration, Value

Key = tuple[Hashable, ...]
"""What a configuration is found by: its values, reals rounded as everywhere."""

NOT_LEGAL: Final = object()
"""Stands for a text that is no value of its parameter."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A CSV file: its header, and rows of texts with the number of the line each ends at."""

    header: tuple[str, ...]
    rows: Sequence[Sequence[str]]
    lines: Sequence[int]

    def columns(self, names: Iterable[str]) -> list[list[str]]:
        """Return the texts of some columns without outer blanks."""
        places = [self.header.index(name) for name in names]
        return [[row[place].strip() for row in self.rows] for place in places]


def read_table(path: Path, needed: Sequence[str]) -> Table:
    """Read a CSV file that has some columns.

    Raises
    ------
    ScenarioError
        If there is no such file, it cannot be read, lacks a column or has it twice, or a row has another number of
        fields than the header.
    """
    try:
        with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
            reader = csv.reader(file)
            header = tuple(name.strip() for name in next(reader, ()))
            numbered = [(reader.line_num, row) for row in reader if row]
    except FileNotFoundError:
        others = [other.name for other in path.parent.glob("*.csv")] if path.parent.is_dir() else []
        raise ScenarioError("$.file", f"there is no file '{path}'", hint=nearest(path.name, others)) from None
    except (OSError, csv.Error) as error:
        raise ScenarioError("$.file", f"'{path}' cannot be read: {error}") from None
    _check_columns(path, header, needed)
    for line, row in numbered:
        if len(row) != len(header):
            raise ScenarioError("$.file", f"{path}, line {line}: {len(row)} fields, but the header has {len(header)}")
    return Table(header=header, rows=[row for _, row in numbered], lines=[line for line, _ in numbered])


def _check_columns(path: Path, header: Sequence[str], needed: Sequence[str]) -> None:
    for name in needed:
        if header.count(name) != 1:
            problem = "has no column" if name not in header else "has more than one column"
            found = ", ".join(header) or "none"
            hint = nearest(name, header) if name not in header else ""
            raise ScenarioError("$.file", f"'{path}' {problem} '{name}' (it has: {found})", hint=hint)


def keys_of(space: SearchSpace, columns: Sequence[Sequence[str]]) -> list[Key | None]:
    """Return the key of each row, given the texts of each parameter's column; None outside the search space."""
    tokens = [_tokens(p, column) for p, column in zip(space.parameters, columns, strict=True)]
    return [None if NOT_LEGAL in row else row for row in zip(*tokens, strict=True)]


def key_of(space: SearchSpace, configuration: Configuration) -> Key:
    """Return the key of a legal configuration."""
    values = [(p, configuration[p.name]) for p in space.parameters]
    return tuple(_rounded(p, [value])[0] if p.n_levels is None else value for p, value in values)


def _tokens(parameter: Parameter, column: Sequence[str]) -> list[Hashable]:
    """Return what stands for each text in a key; `NOT_LEGAL` for one that is no value of the parameter."""
    values = {text: value_of(parameter, text) for text in dict.fromkeys(column)}
    legal = {text: value for text, value in values.items() if value is not None}
    tokens: dict[str, Hashable] = dict(legal)
    if parameter.n_levels is None:
        tokens = dict(zip(legal, _rounded(parameter, list(legal.values())), strict=True))
    return [tokens.get(text, NOT_LEGAL) for text in column]


def _rounded(parameter: Parameter, values: Sequence[Value]) -> list[float]:
    return (np.round(parameter.rounded(parameter.encode(values)), KEY_DECIMALS) + 0.0).tolist()  # no negative zeros


def value_of(parameter: Parameter, text: str) -> Value | None:
    """Return the legal value that a text means, if any: ``1.0`` may be ``1``, and ``False`` may be ``false``."""
    for candidate in (text, _as_integer(text), _in_other_case(parameter, text)):
        with contextlib.suppress(ValueError):
            return parse_value(parameter, candidate)
    return None


def _as_integer(text: str) -> str:
    try:
        number = float(text)
        return str(int(number)) if number == int(number) else text
    except (ValueError, OverflowError):
        return text


def _in_other_case(parameter: Parameter, text: str) -> str:
    """Return the one level that a text is but for upper and lower case, or the text."""
    levels = [v for v in getattr(parameter, "values", ()) if isinstance(v, str) and v.lower() == text.lower()]
    return levels[0] if len(levels) == 1 else text


def same_text(one: str, other: str) -> bool:
    """Tell whether two texts mean the same number, or are the same but for outer blanks."""
    one, other = one.strip(), other.strip()
    try:
        return one == other or float(one) == float(other)
    except ValueError:
        return False
