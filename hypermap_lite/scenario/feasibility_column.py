"""The column of a CSV file that says whether a configuration is allowed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Self


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibilityColumn:
    """Name of the column and its two texts."""

    name: str
    true_value: str = "true"
    false_value: str = "false"

    @classmethod
    def of(cls, scenario: Mapping[str, Any]) -> Self | None:
        """Return the column that a canonical scenario names; None if it has none."""
        section = scenario.get("feasible_output")
        return cls(**{key: section[key] for key in ("name", "true_value", "false_value")}) if section else None

    def is_feasible(self, text: str) -> bool | None:
        """Return what a cell says, in upper or lower case; None if it is neither of the two texts."""
        yes, no = self.true_value, self.false_value
        if yes.casefold() != no.casefold():
            yes, no, text = yes.casefold(), no.casefold(), text.casefold()
        return {yes: True, no: False}.get(text)


USUAL: Final = (FeasibilityColumn(name="Valid"), FeasibilityColumn(name="feasible"))


def usual_feasibility(header: Sequence[str], taken: Sequence[str]) -> list[FeasibilityColumn]:
    """Return which columns of a file count where no scenario names one, unless they are parameters or objectives."""
    return [column for column in USUAL if column.name in header and column.name not in taken]
