"""A belief drawn by hand: how dense it is at some equally spaced values, and straight lines between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.priors.base import Axis, Density, is_numeric, on_levels
from hypermap_lite.typing import FloatArray, IntArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class PiecewisePrior:
    """Piecewise linear density through equally spaced knots, the first at the lower bound, the last at the upper one.

    On a log scale the knots are equally spaced there.
    """

    knots: Sequence[float]
    """Density at each knot, relative to the others."""

    def __post_init__(self) -> None:
        if len(self.knots) < 2:
            raise ScenarioError("$.knots", f"there are {len(self.knots)} knots", allowed="at least two numbers >= 0")
        for i, knot in enumerate(self.knots):
            if finite_number(knot, f"$.knots[{i}]", "the density") < 0:
                raise ScenarioError(f"$.knots[{i}]", f"the density is {knot}", allowed="a number >= 0")
        if not sum(self.knots) > 0:
            raise ScenarioError("$.knots", "all densities are zero", allowed="at least one number > 0")

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis.

        Raises
        ------
        ScenarioError
            If the parameter has no numeric axis.
        """
        if not is_numeric(axis):
            problem = f"'{axis.name}' has no range to draw a density over"
            raise ScenarioError("$", problem, allowed="real and integer parameters", hint="Give it weights.")
        heights = np.asarray(self.knots, dtype=float) / max(self.knots)
        return on_levels(PiecewiseLinear(heights / np.trapezoid(heights, dx=1 / (len(heights) - 1))), axis)


@dataclass(frozen=True, slots=True)
class PiecewiseLinear(Density):
    """Linear interpolation between knots on the unit interval."""

    heights: FloatArray
    """Densities at k knots, shape (k,), k >= 2; the density integrates to one."""

    @property
    def _width(self) -> float:
        """Distance of two knots."""
        return 1 / (len(self.heights) - 1)

    @property
    def _masses(self) -> FloatArray:
        """Probabilities of the k - 1 pieces."""
        masses = (self.heights[:-1] + self.heights[1:]) / 2
        return np.asarray(masses / masses.sum())

    def _place(self, u: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the piece of each point and where in it, from 0 to 1, the point lies."""
        position = np.clip(u, 0.0, 1.0) / self._width
        pieces = np.minimum(position.astype(int), len(self.heights) - 2)
        return pieces, position - pieces

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points by inversion, shape (n,)."""
        pieces = rng.choice(len(self.heights) - 1, size=n, p=self._masses)
        v = rng.random(n)
        a, b = self.heights[pieces], self.heights[pieces + 1]
        # the root of a t + (b - a) t^2 / 2 = v (a + b) / 2, written so that nothing cancels
        t = v * (a + b) / (a + np.sqrt(a**2 + v * (b**2 - a**2)))
        return np.asarray(np.clip((pieces + t) * self._width, 0.0, 1.0))

    def density(self, u: FloatArray) -> FloatArray:
        """Return the density, shape (n,)."""
        pieces, t = self._place(u)
        return np.asarray((1 - t) * self.heights[pieces] + t * self.heights[pieces + 1])

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,); -inf where it is zero."""
        with np.errstate(divide="ignore"):
            return np.log(self.density(u))

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return the derivative of the log density, shape (n,); zero where the density is."""
        pieces, _ = self._place(u)
        slope = (self.heights[pieces + 1] - self.heights[pieces]) / self._width
        density = self.density(u)
        return np.divide(slope, density, out=np.zeros(len(u)), where=density > 0)

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""
        pieces, t = self._place(u)
        a, b = self.heights[pieces], self.heights[pieces + 1]
        before = np.concatenate([[0.0], np.cumsum(self._masses)])
        return np.asarray(np.minimum(before[pieces] + self._width * t * (a + (b - a) * t / 2), 1.0))

    def mode(self) -> float:
        """Return the first of the highest knots."""
        return float(np.argmax(self.heights)) * self._width
