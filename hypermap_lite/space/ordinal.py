"""An ordinal parameter: a sorted list of numbers, equally spaced on the axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from hypermap_lite.errors import finite_number
from hypermap_lite.space.listed import ListedParameter, check_levels
from hypermap_lite.typing import Value


@dataclass(frozen=True, slots=True, kw_only=True)
class OrdinalParameter(ListedParameter):
    """One of a list of numbers in which only the order counts."""

    values: tuple[float, ...]
    """Its levels; kept in rising order."""

    def __post_init__(self) -> None:
        check_levels(self.name, self.values)
        for i, value in enumerate(self.values):
            finite_number(value, f"$.values[{i}]", "the level")
        object.__setattr__(self, "values", tuple(sorted(self.values)))

    @property
    def levels(self) -> Sequence[Value]:
        """The numbers in rising order."""
        return self.values

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"one of {', '.join(f'{v:g}' for v in self.values)}"
