"""The base of all parameter types: one named axis of the unit cube."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.typing import FloatArray, IntArray, Value


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter(ABC):
    """One axis of the search space.

    A value has a code in [0, 1]. A discrete parameter with k levels cuts the unit interval into k bins; every
    point of a bin decodes to the bin's level, and the level's own code lies inside its bin. So a density on the
    unit interval is at once a distribution over the levels.
    """

    name: str
    default: Value | None = None
    """Value tried first."""

    is_ordered: ClassVar[bool] = True
    """Whether close codes mean similar values."""

    @property
    @abstractmethod
    def n_levels(self) -> int | None:
        """Number of values it can take; None if continuous."""

    @abstractmethod
    def contains(self, value: object) -> bool:
        """Tell whether a native value is legal."""

    @abstractmethod
    def allowed(self) -> str:
        """Say in words which values are legal, for messages."""

    @abstractmethod
    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n legal native values, shape (n,)."""

    @abstractmethod
    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the native values of n codes in [0, 1]."""

    def level_codes(self) -> FloatArray:
        """Return the codes of all levels in order, shape (n_levels,); an error if continuous."""
        return self.codes_of_levels(np.arange(self.n_levels or 0))

    def bin_edges(self) -> FloatArray:
        """Return the edges of the bins, shape (n_levels + 1,), from 0 to 1; an error if continuous."""
        return np.append(self.bins_of_levels(np.arange(self.n_levels or 0))[0], 1.0)

    @abstractmethod
    def codes_of_levels(self, levels: IntArray) -> FloatArray:
        """Return the codes of some levels, counted from 0, without listing all; an error if continuous."""

    @abstractmethod
    def bins_of_levels(self, levels: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper edges of the bins of some levels, without listing all; an error if continuous."""

    def snap(self, codes: FloatArray) -> FloatArray:
        """Move codes in [0, 1] to the nearest legal ones: those of their level, or themselves if continuous."""
        if self.n_levels is None:
            return codes
        return self.codes_of_levels(self.level_index(codes))

    def rounded(self, codes: FloatArray) -> FloatArray:
        """Return codes in [0, 1] rounded as the values are that they decode to, shape (n,)."""
        return self.snap(codes)

    def level_index(self, codes: FloatArray) -> IntArray:
        """Return which level each code decodes to, counted from 0, shape (n,)."""
        inner = self.bin_edges()[1:-1]
        return np.searchsorted(inner, codes, side="right")

    def locate(self, value: float) -> float:
        """Return where a number lies on the unit axis, which may be outside [0, 1].

        Raises
        ------
        ScenarioError
            If the parameter has no numeric axis.
        """
        raise ScenarioError("$", f"'{self.name}' has no numeric axis to place {value} on")

    def scale_std(self, std: float) -> float:
        """Return a standard deviation, given in native units (in decades on a log scale), in units of the axis."""
        raise ScenarioError("$", f"'{self.name}' has no numeric axis to measure {std} on")
