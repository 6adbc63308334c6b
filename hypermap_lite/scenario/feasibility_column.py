"""The column of a CSV file that says whether a configuration is allowed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Self


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibilityColumn:
    """Name of the column and its texts."""

    name: str
    yes: tuple[str, ...] = ("true", "1", "1.0", "yes")
    no: tuple[str, ...] = ("false", "0", "0.0", "no")

    @classmethod
    def of(cls, scenario: Mapping[str, Any]) -> Self | None:
        """Return the column that a canonical scenario names; None if it has none."""
        section = scenario.get("feasible_output")
        if not section:
            return None
        return cls(name=section["name"], yes=(section["true_value"],), no=(section["false_value"],))

    def is_feasible(self, text: str) -> bool | None:
        """Return what a cell says, in upper or lower case; None if it is none of the texts."""
        texts = dict.fromkeys(self.yes, True) | dict.fromkeys(self.no, False)
        folded = {known.casefold(): meaning for known, meaning in texts.items()}
        return folded.get(text.casefold()) if len(folded) == len(texts) else texts.get(text)


USUAL: Final = (FeasibilityColumn(name="Valid"), FeasibilityColumn(name="feasible"))


def usual_feasibility(header: Sequence[str], taken: Sequence[str]) -> list[FeasibilityColumn]:
    """Return which columns of a file count where no scenario names one, unless they are parameters or objectives."""
    return [column for column in USUAL if column.name in header and column.name not in taken]
