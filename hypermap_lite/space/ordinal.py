"""An ordinal parameter: a sorted list of numbers, equally spaced on the axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.typing import FloatArray, Value


@dataclass(frozen=True, slots=True, kw_only=True)
class OrdinalParameter(Parameter):
    """One of a list of numbers in which only the order counts."""

    values: tuple[float, ...]
    """Its levels; kept in rising order."""

    def __post_init__(self) -> None:
        check_levels(self.name, self.values)
        for i, value in enumerate(self.values):
            finite_number(value, f"$.values[{i}]", "the level")
        object.__setattr__(self, "values", tuple(sorted(self.values)))

    @property
    def n_levels(self) -> int | None:
        """Number of levels."""
        return len(self.values)

    def contains(self, value: object) -> bool:
        """Tell whether a value is one of the levels."""
        return not isinstance(value, bool) and value in self.values

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"one of {', '.join(f'{v:g}' for v in self.values)}"

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n native values, shape (n,)."""
        return self.level_codes()[[self.values.index(float(v)) for v in values]]

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the levels whose bins hold the n codes."""
        return [self.values[i] for i in self.level_index(codes)]

    def level_codes(self) -> FloatArray:
        """Return the codes of all levels in order, shape (n_levels,)."""
        return (np.arange(len(self.values)) + 0.5) / len(self.values)

    def bin_edges(self) -> FloatArray:
        """Return the edges of the bins, shape (n_levels + 1,)."""
        return np.arange(len(self.values) + 1) / len(self.values)


def check_levels(name: str, values: Sequence[object]) -> None:
    """Raise a `ScenarioError` if the list of levels is too short or repeats one."""
    if len(values) < 2:
        raise ScenarioError(
            "$.values", f"the list {list(values)} leaves '{name}' no choice", allowed="at least two different values"
        )
    repeated = [value for i, value in enumerate(values) if value in values[:i]]
    if repeated:
        raise ScenarioError("$.values", f"{repeated[0]!r} stands twice", allowed="different values", hint="Drop one.")
