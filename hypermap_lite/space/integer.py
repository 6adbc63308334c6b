"""An integer parameter, on a linear or logarithmic axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.real import check_bounds
from hypermap_lite.typing import FloatArray, IntArray, Value

LARGEST = 2**51
"""Largest size of a bound: all numbers between two such bounds, and halfway between them, are exact floats."""


@dataclass(frozen=True, slots=True, kw_only=True)
class IntegerParameter(Parameter):
    """All integers from `low` to `high`, both included.

    The bin of a value v reaches from v - 1/2 to v + 1/2 on the (linear or logarithmic) axis.
    """

    low: int
    high: int
    log: bool = False
    """Whether the axis is logarithmic."""

    _start: float = field(init=False, repr=False, compare=False, default=0.0)
    _span: float = field(init=False, repr=False, compare=False, default=1.0)

    def __post_init__(self) -> None:
        for i, bound in enumerate((self.low, self.high)):
            number = finite_number(bound, f"$.values[{i}]", "the bound")
            if abs(number) > LARGEST:
                raise ScenarioError(f"$.values[{i}]", f"the bound {bound} is too large", allowed="up to 2^51 in size")
            if not number.is_integer():
                raise ScenarioError(f"$.values[{i}]", f"the bound {bound} is not whole", allowed="an integer")
        check_bounds(self.name, self.low, self.high, log=self.log)
        object.__setattr__(self, "low", int(self.low))
        object.__setattr__(self, "high", int(self.high))
        start, end = self._axis(np.array([self.low - 0.5, self.high + 0.5]))
        object.__setattr__(self, "_start", float(start))
        object.__setattr__(self, "_span", float(end - start))

    def _axis(self, values: FloatArray) -> FloatArray:
        return np.log10(values) if self.log else values

    def _codes_of(self, values: FloatArray) -> FloatArray:
        return (self._axis(values) - self._start) / self._span

    @property
    def n_levels(self) -> int | None:
        """Number of integers within the bounds."""
        return self.high - self.low + 1

    def contains(self, value: object) -> bool:
        """Tell whether a value is a whole number within the bounds."""
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        return is_number and float(value).is_integer() and self.low <= value <= self.high  # type: ignore[arg-type,operator]

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"an integer from {self.low} to {self.high}"

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n native values, shape (n,)."""
        return self._codes_of(np.asarray(values, dtype=float))

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the integers whose bins hold the n codes."""
        return [self.low + int(i) for i in self.level_index(codes)]

    def level_index(self, codes: FloatArray) -> IntArray:
        """Return which integer each code decodes to, counted from 0, shape (n,)."""
        position = self._start + np.asarray(codes) * self._span
        values = np.floor((10.0**position if self.log else position) + 0.5)
        return np.clip(values - self.low, 0, self.high - self.low).astype(np.int64)

    def codes_of_levels(self, levels: IntArray) -> FloatArray:
        """Return the codes of some integers, counted from `low`, shape (n,)."""
        return self._codes_of(self.low + np.asarray(levels, dtype=float))

    def bins_of_levels(self, levels: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper edges of the bins of some integers, counted from `low`, both shape (n,)."""
        values = self.low + np.asarray(levels, dtype=float)
        low, high = self._codes_of(values - 0.5), self._codes_of(values + 0.5)
        return np.where(values == self.low, 0.0, low), np.where(values == self.high, 1.0, high)

    def locate(self, value: float) -> float:
        """Return where a number lies on the unit axis; below a log axis for numbers <= 0 is an error."""
        if self.log and value <= 0:
            raise ScenarioError("$", f"{value:g} has no place on the logarithmic axis of '{self.name}'", allowed="> 0")
        return float(self._codes_of(np.array(value, dtype=float)))

    def scale_std(self, std: float) -> float:
        """Return a standard deviation in units of the axis; native units, or decades on a log axis."""
        return std / self._span
