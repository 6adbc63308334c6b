"""The common part of ordinal and categorical parameters: a list of levels with bins of equal width."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.typing import FloatArray, IntArray, Value


@dataclass(frozen=True, slots=True, kw_only=True)
class ListedParameter(Parameter):
    """One of a list of levels."""

    @property
    @abstractmethod
    def levels(self) -> Sequence[Value]:
        """The levels in the order of their bins."""

    @property
    def n_levels(self) -> int | None:
        """Number of levels."""
        return len(self.levels)

    def contains(self, value: object) -> bool:
        """Tell whether a value is one of the levels."""
        return not isinstance(value, bool) and value in self.levels

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n levels, shape (n,)."""
        position = {level: i for i, level in enumerate(self.levels)}
        return self.level_codes()[[position[value] for value in values]]

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the levels whose bins hold the n codes."""
        return [self.levels[i] for i in self.level_index(codes)]

    def codes_of_levels(self, levels: IntArray) -> FloatArray:
        """Return the middles of the bins of some levels, shape (n,)."""
        return (np.asarray(levels) + 0.5) / len(self.levels)

    def bins_of_levels(self, levels: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper edges of the bins of some levels, both shape (n,)."""
        return np.asarray(levels) / len(self.levels), (np.asarray(levels) + 1) / len(self.levels)


def check_levels(name: str, values: Sequence[object]) -> None:
    """Raise a `ScenarioError` if the list of levels is too short or repeats one."""
    if len(values) < 2:
        problem = f"the list {list(values)} leaves '{name}' no choice"
        raise ScenarioError("$.values", problem, allowed="at least two different values")
    repeated = [value for i, value in enumerate(values) if value in values[:i]]
    if repeated:
        raise ScenarioError("$.values", f"{repeated[0]!r} stands twice", allowed="different values", hint="Drop one.")
