"""A black box whose answers are known beforehand: the rows of a CSV file."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hypermap_lite.errors import EvaluationError, ScenarioError
from hypermap_lite.evaluation.evaluator import EvaluationRequest
from hypermap_lite.evaluation.outcome import Outcome
from hypermap_lite.evaluation.table_index import Key, Table, key_of, keys_of, read_table, same_text
from hypermap_lite.evaluation.text_rows import outcome_of_texts
from hypermap_lite.history.csv_format import format_configuration
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.space.search_space import SearchSpace


@dataclass(frozen=True, slots=True, kw_only=True)
class Exhaustive:
    """Looks a configuration up in a table that holds the answers to all, or many, configurations.

    Columns are found by their names, and others are ignored. Values are compared by their meaning: ``1`` is ``1.0``,
    and a category may differ in upper and lower case if that leaves it unambiguous. A configuration that is not in the
    table is a failed evaluation. Of rows that repeat each other the first counts.

    Raises
    ------
    ScenarioError
        If the file cannot be read or lacks a column, or two rows of a configuration have different answers.
    """

    file: str
    """The table, a CSV file with a header."""

    objectives: Sequence[str]
    """Names of the objectives."""

    space: SearchSpace
    """What a row is looked up by."""

    feasible_output: FeasibleOutput | None = None
    """The column that says which rows are feasible, if there is one."""

    folders: Sequence[str | Path] = (".",)
    """Where the file is looked for; the first that holds it counts."""

    _table: Table = field(init=False, repr=False, compare=False)
    _index: Mapping[Key, int] = field(init=False, repr=False, compare=False)
    _n_outside: int = field(init=False, repr=False, compare=False)
    _n_repeated: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        table = read_table(self._path, (*self.space.names, *self._answers))
        keys = keys_of(self.space, table.columns(self.space.names))
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "_index", self._indexed(table, keys))
        object.__setattr__(self, "_n_outside", keys.count(None))

    def __reduce__(self) -> tuple[Callable[..., Exhaustive], tuple[Any, ...]]:
        """Pickle the file's place rather than its content."""
        return _rebuild, (self.file, self.objectives, self.space, self.feasible_output, self.folders)

    @property
    def _answers(self) -> tuple[str, ...]:
        return (*self.objectives, *([self.feasible_output.name] if self.feasible_output else []))

    @property
    def _path(self) -> Path:
        places = [Path(folder, os.path.expanduser(self.file)) for folder in self.folders]
        return next((place for place in places if place.exists()), places[0])

    @property
    def n_known(self) -> int:
        """Number of different configurations of the search space in the table."""
        return len(self._index)

    def warnings(self) -> Iterator[str]:
        """Yield what is worth knowing about the rows, and about how much of the search space they cover."""
        size = self.space.n_configurations
        if self.n_known < size:
            of = "an infinite number" if math.isinf(size) else f"{size:.0f} ({100 * self.n_known / size:.3g} %)"
            yield f"the table holds {self.n_known} configurations of {of}; any other is a failed evaluation."
        if self._n_repeated:
            yield f"{self._n_repeated} rows of the table repeat earlier ones, and are left out."
        if self._n_outside:
            yield f"{self._n_outside} rows of the table are no configurations of the search space, and are left out."

    def _indexed(self, table: Table, keys: Sequence[Key | None]) -> dict[Key, int]:
        """Return the number of the first row of each configuration."""
        index: dict[Key, int] = {}
        n_repeated = 0
        for i, key in enumerate(keys):
            if key is None:
                continue
            first = index.setdefault(key, i)
            if first != i:
                self._check_repeated(table, first, i)
                n_repeated += 1
        object.__setattr__(self, "_n_repeated", n_repeated)
        return index

    def _check_repeated(self, table: Table, first: int, second: int) -> None:
        for (one, other), name in zip(self._pairs(table, first, second), self._answers, strict=True):
            if not same_text(one, other):
                problem = f"lines {table.lines[first]} and {table.lines[second]} of '{self._path}'"
                problem += f" are of the same configuration, but '{name}' is {one} in one and {other} in the other"
                raise ScenarioError("$.file", problem, hint="Keep one of them, or their mean.")

    def _pairs(self, table: Table, first: int, second: int) -> list[tuple[str, str]]:
        places = [table.header.index(name) for name in self._answers]
        return [(table.rows[first][place], table.rows[second][place]) for place in places]

    def __call__(self, request: EvaluationRequest) -> Outcome:
        """Look a configuration up.

        Raises
        ------
        EvaluationError
            If the table has no such row, or no number in it.
        """
        number = self._index.get(key_of(self.space, request.configuration))
        if number is None:
            pairs = zip(self.space.names, format_configuration(self.space, request.configuration), strict=True)
            shown = ", ".join(f"{name}={text}" for name, text in pairs)
            raise EvaluationError(f"{self._path.name} has no row with {shown}")
        row = dict(zip(self._table.header, map(str.strip, self._table.rows[number]), strict=True))
        try:
            return outcome_of_texts(row, self.objectives, self.feasible_output)
        except ValueError as error:
            raise EvaluationError(f"line {self._table.lines[number]} of {self._path.name}: {error}") from None


def _rebuild(
    file: str,
    objectives: Sequence[str],
    space: SearchSpace,
    feasible_output: FeasibleOutput | None,
    folders: Sequence[str | Path],
) -> Exhaustive:
    return Exhaustive(file=file, objectives=objectives, space=space, feasible_output=feasible_output, folders=folders)
