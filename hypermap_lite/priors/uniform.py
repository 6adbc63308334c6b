"""No preference within a range: every part of it is as likely as any other, and nothing outside is possible."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.priors.base import Axis, Density, is_numeric, on_levels
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class UniformPrior:
    """Flat from `low` to `high`, cut off at the bounds, and zero elsewhere.

    Of an integer or ordinal parameter, the levels in the range count, the ends included.
    """

    low: float | None = None
    """Lower end of the range, in native units; None for the parameter's own."""

    high: float | None = None
    """Upper end of the range, in native units; None for the parameter's own."""

    def __post_init__(self) -> None:
        for name, value in (("low", self.low), ("high", self.high)):
            if value is not None:
                finite_number(value, f"$.{name}", f"the end '{name}' of the range")
        if self.low is not None and self.high is not None and self.low >= self.high:
            problem = f"the range from {self.low} to {self.high} is {'empty' if self.low == self.high else 'reversed'}"
            hint = "" if self.low == self.high else "Swap the two numbers."
            raise ScenarioError("$.low", problem, allowed="low < high", hint=hint)

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis.

        Raises
        ------
        ScenarioError
            If it has a range and the parameter has no order, or no part of the range lies within the bounds.
        """
        if self.low is None and self.high is None:
            return UniformDensity()
        start, end = self._on_numeric(axis) if is_numeric(axis) else self._on_levels(axis)
        if start >= end:
            low, high = ("the bound" if end is None else f"{end:g}" for end in (self.low, self.high))
            problem = f"the range from {low} to {high} has no value of '{axis.name}' in it"
            raise ScenarioError("$", problem, allowed=axis.allowed())
        return on_levels(UniformDensity(start, end), axis)

    def _on_numeric(self, axis: Axis) -> tuple[float, float]:
        """Return the ends on the axis of a real or integer parameter."""
        low, high = self.low, self.high
        if axis.n_levels is not None:  # whole bins of the integers in the range
            low = None if low is None else math.ceil(low) - 0.5
            high = None if high is None else math.floor(high) + 0.5
        return (0.0 if low is None else _locate(axis, low)), (1.0 if high is None else _locate(axis, high))

    def _on_levels(self, axis: Axis) -> tuple[float, float]:
        """Return the ends on the axis of an ordinal parameter."""
        edges = axis.bin_edges()
        values = axis.decode((edges[:-1] + edges[1:]) / 2)
        if any(isinstance(value, str | tuple) for value in values):
            problem = f"'{axis.name}' has no order for a range"
            raise ScenarioError("$", problem, allowed="a uniform prior without low and high", hint="Give it weights.")
        low = -math.inf if self.low is None else self.low
        high = math.inf if self.high is None else self.high
        inside = [i for i, value in enumerate(values) if not isinstance(value, tuple) and low <= float(value) <= high]
        return (float(edges[inside[0]]), float(edges[inside[-1] + 1])) if inside else (0.0, 0.0)


def _locate(axis: Axis, value: float) -> float:
    """Return where a number lies on the axis, or the bound nearest to it."""
    try:
        return min(max(axis.locate(value), 0.0), 1.0)
    except ScenarioError:  # a logarithmic axis begins above zero
        return 0.0


@dataclass(frozen=True, slots=True)
class UniformDensity(Density):
    """The flat density on a part of the unit interval."""

    start: float = 0.0
    end: float = 1.0

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n,)."""
        return self.start + rng.random(n) * (self.end - self.start)

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,); -inf outside."""
        return np.where((u >= self.start) & (u <= self.end), -math.log(self.end - self.start), -np.inf)

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return zeros, shape (n,)."""
        return np.zeros(len(u))

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""
        return np.clip((u - self.start) / (self.end - self.start), 0.0, 1.0)

    def mode(self) -> float:
        """Return the middle."""
        return (self.start + self.end) / 2
