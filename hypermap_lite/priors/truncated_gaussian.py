"""A Gaussian belief about a real or integer parameter, cut off at the bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.special import log_ndtr, ndtri_exp

from hypermap_lite.errors import ScenarioError, finite_number, positive_number
from hypermap_lite.priors.base import Axis, Density, is_numeric, on_levels
from hypermap_lite.typing import FloatArray, Rng

LOG_SQRT_2PI = 0.5 * math.log(2 * math.pi)

NARROWEST = 1e-12
"""Smallest standard deviation, in units of the axis."""

FLATTEST = 1e6
"""Largest standard deviation, in units of the axis: the density is uniform to twelve digits."""

FARTHEST = 1e6
"""Largest distance of the mean, in standard deviations: nearly all mass is in the last millionth of the axis."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GaussianPrior:
    """Gaussian truncated to the bounds and normalized; the mean may lie outside them.

    On a log scale it is a Gaussian over the decimal logarithm: `mean` is still a native value, `std` is in decades.
    """

    mean: float
    """Most likely value, in native units."""

    std: float
    """Standard deviation before truncation, in native units (decades on a log scale)."""

    def __post_init__(self) -> None:
        finite_number(self.mean, "$.mean", "the mean")
        positive_number(self.std, "$.std", "the standard deviation")

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis.

        Raises
        ------
        ScenarioError
            If the parameter has no numeric axis, or the mean no place on it.
        """
        return on_levels(gaussian_on(axis, self.mean, self.std), axis)


def gaussian_on(axis: Axis, mean: float, std: float) -> TruncatedNormal:
    """Return the truncated normal density of a native mean and standard deviation, levels not yet considered."""
    try:
        location, scale = axis.locate(mean), min(max(axis.scale_std(std), NARROWEST), FLATTEST)
    except ScenarioError as error:
        hint = error.hint if is_numeric(axis) else "Give ordinal and categorical parameters 'weights'."
        raise ScenarioError("$.mean", error.problem, allowed=error.allowed, hint=hint) from None
    return TruncatedNormal(min(max(location, -FARTHEST * scale), 1 + FARTHEST * scale), scale)


@dataclass(frozen=True, slots=True)
class TruncatedNormal(Density):
    """Normal density on the unit interval, exact however far the location lies outside."""

    location: float
    scale: float
    _log_mass: float = field(init=False, repr=False, compare=False)
    """Log of the probability that the untruncated normal lies in [0, 1]."""

    def __post_init__(self) -> None:
        low, high, _ = self._tail()
        object.__setattr__(self, "_log_mass", float(log_difference(log_ndtr(high), log_ndtr(low))))

    def _tail(self) -> tuple[float, float, float]:
        """Return the bounds in standard units, mirrored if need be so that the interval is not in the upper tail."""
        a, b = -self.location / self.scale, (1 - self.location) / self.scale
        return (-b, -a, -1.0) if a > 0 else (a, b, 1.0)

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points by inversion, shape (n,)."""
        low, high, sign = self._tail()
        v = rng.random(n)
        log_p = log_ndtr(high) + np.log(v + (1 - v) * np.exp(log_ndtr(low) - log_ndtr(high)))
        return np.clip(self.location + sign * self.scale * ndtri_exp(log_p), 0.0, 1.0)

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,)."""
        z = (u - self.location) / self.scale
        return -0.5 * z * z - LOG_SQRT_2PI - math.log(self.scale) - self._log_mass

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return the derivative of the log density, shape (n,)."""
        return -(u - self.location) / self.scale**2

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""
        low, high, sign = self._tail()
        z = sign * (np.clip(u, 0.0, 1.0) - self.location) / self.scale
        edge = low if sign > 0 else high
        part = log_difference(np.maximum(log_ndtr(z), log_ndtr(edge)), np.minimum(log_ndtr(z), log_ndtr(edge)))
        return np.exp(part - self._log_mass)

    def mode(self) -> float:
        """Return the location, or the bound nearest to it."""
        return min(max(self.location, 0.0), 1.0)


def log_difference(larger: FloatArray, smaller: FloatArray) -> FloatArray:
    """Return log(exp(larger) - exp(smaller)) without overflow; -inf where they are equal."""
    with np.errstate(divide="ignore"):
        return larger + np.log(-np.expm1(smaller - larger))
