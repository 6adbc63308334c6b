"""A categorical parameter: one of several names without an order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.space.ordinal import check_levels
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.typing import FloatArray, Value


@dataclass(frozen=True, slots=True, kw_only=True)
class CategoricalParameter(Parameter):
    """One of a list of names, in the order given."""

    values: tuple[str, ...]
    is_ordered: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_levels(self.name, self.values)

    @property
    def n_levels(self) -> int | None:
        """Number of categories."""
        return len(self.values)

    def contains(self, value: object) -> bool:
        """Tell whether a value is one of the categories."""
        return value in self.values

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"one of {', '.join(map(repr, self.values))}"

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n categories, shape (n,)."""
        return self.level_codes()[[self.values.index(str(v)) for v in values]]

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the categories whose bins hold the n codes."""
        return [self.values[i] for i in self.level_index(codes)]

    def level_codes(self) -> FloatArray:
        """Return the codes of all categories in order, shape (n_levels,)."""
        return (np.arange(len(self.values)) + 0.5) / len(self.values)

    def bin_edges(self) -> FloatArray:
        """Return the edges of the bins, shape (n_levels + 1,)."""
        return np.arange(len(self.values) + 1) / len(self.values)
