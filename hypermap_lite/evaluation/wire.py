"""HyperMapper's wire protocol as text: requests, and the rows of a reply.

A request is a line ``Request K``, a line with the names of the parameters, and K lines with their values. The reply is
a header and K rows: the parameters again, the objectives, the feasibility where there is one, and anything else.

References
----------
.. [1] Nardi, Koeplinger, Olukotun. Practical Design Space Exploration. MASCOTS 2019 (HyperMapper).
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from hypermap_lite.errors import ClientError, nearest
from hypermap_lite.evaluation.outcome import Outcome
from hypermap_lite.evaluation.text_rows import outcome_of_texts
from hypermap_lite.history.csv_format import format_configuration, format_record
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Configuration

END: Final = "End of HyperMapper"
"""Line that ends the exchange."""


def request_lines(space: SearchSpace, configurations: Sequence[Configuration]) -> Iterator[str]:
    """Yield the lines that ask for some configurations."""
    yield f"Request {len(configurations)}"
    yield _line(space.names)
    for configuration in configurations:
        yield _line(format_configuration(space, configuration))


def _line(fields: Sequence[str]) -> str:
    return format_record(fields).removesuffix("\n")


def fields_of(line: str) -> list[str]:
    """Return the fields of a line, without outer blanks."""
    try:
        return [field.strip() for field in next(csv.reader([line]), [])]
    except csv.Error as error:
        raise ClientError(f"a line of the client cannot be read: {error}: {line[:80]!r}") from None


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplyFormat:
    """What the columns of a reply mean."""

    parameters: Sequence[str]
    objectives: Sequence[str]
    feasible: FeasibleOutput | None = None
    """None where the client does not answer on feasibility."""

    @property
    def required(self) -> tuple[str, ...]:
        """Names of the columns that must be there."""
        return (*self.parameters, *self.objectives, *([self.feasible.name] if self.feasible else []))

    def check_header(self, header: Sequence[str]) -> None:
        """Raise a `ClientError` unless a header has every column that is needed, and once."""
        if fault := self._fault_of(header):
            given, needed = ",".join(header), ",".join(self.required)
            raise ClientError(f"{fault}\n  header: {given}\n  needed: {needed}, in any order; others may be there")

    def _fault_of(self, header: Sequence[str]) -> str:
        for name in self.required:
            if name not in header:
                guess = nearest(name, header)
                return f"the header of the client's reply has no column '{name}'" + (f". {guess}" if guess else "")
            if header.count(name) > 1:
                return f"the header of the client's reply has the column '{name}' twice"
        return ""

    def outcome(self, row: Mapping[str, str]) -> Outcome:
        """Return what a row says; see `outcome_of_texts`.

        Raises
        ------
        ClientError
            If an objective is no number, or the feasibility neither of its two texts.
        """
        extras = [name for name in row if name and name not in self.required]
        try:
            return outcome_of_texts(row, self.objectives, self.feasible, extras)
        except ValueError as error:
            raise ClientError(f"in the client's reply, {error}") from None
