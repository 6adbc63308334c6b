"""A real parameter, on a linear or logarithmic axis."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.typing import FloatArray, IntArray, Value

SIGNIFICANT_DIGITS = 12
"""Decimal digits kept of the range; what is decoded lies on this grid, so it encodes and decodes exactly."""


FEWEST_CHECKED = 3
"""Real parameters from which on it is checked what a model promises on their bounds.

With fewer the variance grows little towards bounds, and a few promises broken by noise would cost more than is saved:
on BraninCurrin with noise 0.964 of the hypervolume is reached instead of 0.973.
"""


CODE_DECIMALS = 14
"""Decimals kept of a code, so that the same point in metres and in millimetres has the same code."""


TIE = 8 * sys.float_info.epsilon
"""Error of a number of steps on the decimal grid, as a share of it."""


EXACT_POWERS = np.array([float(10**k) for k in range(23)])
"""The powers of ten that a float holds without rounding."""


LARGEST_EXACT = 2.0**53
"""The largest number up to which a float holds every whole one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RealParameter(Parameter):
    """All real numbers from `low` to `high`."""

    low: float
    high: float
    log: bool = False
    """Whether the axis is logarithmic."""

    _start: float = field(init=False, repr=False, compare=False, default=0.0)
    _span: float = field(init=False, repr=False, compare=False, default=1.0)

    def __post_init__(self) -> None:
        check_bounds(self.name, self.low, self.high, log=self.log)
        object.__setattr__(self, "_start", math.log10(self.low) if self.log else self.low)
        end = math.log10(self.high) if self.log else self.high
        object.__setattr__(self, "_span", end - self._start)

    @property
    def n_levels(self) -> int | None:
        """None: continuous."""
        return None

    def contains(self, value: object) -> bool:
        """Tell whether a value is a number within the bounds."""
        return isinstance(value, int | float) and not isinstance(value, bool) and self.low <= value <= self.high

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"a number from {self.low:g} to {self.high:g}"

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n native values, shape (n,)."""
        numbers = np.asarray(values, dtype=float)
        axis = np.log10(numbers) if self.log else numbers
        return np.round(np.clip((axis - self._start) / self._span, 0.0, 1.0), CODE_DECIMALS)

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the native values of n codes, rounded to a decimal grid far finer than any use."""
        return np.clip(self._on_grid(codes), self.low, self.high).tolist()

    def rounded(self, codes: FloatArray) -> FloatArray:
        """Return the codes of what n codes decode to, shape (n,): one for all that are the same configuration.

        As `decode` and `encode`, but without the last decimals' rounding, and beyond the ends by as much.
        """
        values = self._on_grid(codes)
        return np.asarray(((np.log10(values) if self.log else values) - self._start) / self._span)

    def _on_grid(self, codes: FloatArray) -> FloatArray:
        """Return n native values as `_rounded` rounds them one by one, shape (n,)."""
        positions = self._start + np.asarray(codes, dtype=float) * self._span
        values = 10.0**positions if self.log else positions
        digits = (
            SIGNIFICANT_DIGITS - np.ceil(np.log10(np.abs(values))).astype(int)
            if self.log
            else np.array(SIGNIFICANT_DIGITS - math.ceil(math.log10(self._span)))
        )
        size = np.minimum(np.abs(digits), len(EXACT_POWERS) - 1)
        up, down = EXACT_POWERS[np.where(digits > 0, size, 0)], EXACT_POWERS[np.where(digits < 0, size, 0)]
        steps = values * up / down
        whole = np.rint(steps)
        # A whole number and a power of ten that are exact have the quotient or product that is nearest to the decimal.
        result = whole / up * down
        is_tie = np.abs(np.abs(steps - whole) - 0.5) <= TIE * np.abs(steps)  # as near to a half as a float can tell
        hard = is_tie | (np.abs(digits) >= len(EXACT_POWERS)) | (np.abs(whole) > LARGEST_EXACT)
        result[hard] = [self._rounded(float(p)) for p in positions[hard]]
        return np.asarray(result + 0.0)  # no negative zeros

    def _rounded(self, position: float) -> float:
        value = 10.0**position if self.log else position
        magnitude = abs(value) if self.log else self._span
        return round(value, SIGNIFICANT_DIGITS - math.ceil(math.log10(magnitude)))

    def codes_of_levels(self, levels: IntArray) -> FloatArray:
        """Raise: a real parameter has no levels."""
        raise TypeError(f"'{self.name}' is continuous and has no levels")

    def bins_of_levels(self, levels: IntArray) -> tuple[FloatArray, FloatArray]:
        """Raise: a real parameter has no bins."""
        raise TypeError(f"'{self.name}' is continuous and has no bins")

    def locate(self, value: float) -> float:
        """Return where a number lies on the unit axis; below a log axis for numbers <= 0 is an error."""
        if self.log and value <= 0:
            raise ScenarioError("$", f"{value:g} has no place on the logarithmic axis of '{self.name}'", allowed="> 0")
        return ((math.log10(value) if self.log else value) - self._start) / self._span

    def scale_std(self, std: float) -> float:
        """Return a standard deviation in units of the axis; native units, or decades on a log axis."""
        return std / self._span


def check_bounds(name: str, low: object, high: object, *, log: bool) -> None:
    """Raise a `ScenarioError` unless low and high are finite numbers in order, and positive on a log axis."""
    first, last = finite_number(low, "$.values[0]", "the bound"), finite_number(high, "$.values[1]", "the bound")
    if first >= last:
        problem = "are equal" if first == last else "are reversed"
        hint = f"Make '{name}' a constant of the evaluator." if first == last else "Swap the two numbers."
        raise ScenarioError(
            "$.values", f"the bounds [{low}, {high}] {problem}", allowed="[low, high] with low < high", hint=hint
        )
    if not math.isfinite(last - first):
        raise ScenarioError("$.values", f"the range of [{low}, {high}] is not finite", allowed="a range below 1e308")
    if log and first <= 0:
        raise ScenarioError("$.values[0]", f"the lower bound {low} of a log scale is not positive", allowed="> 0")
