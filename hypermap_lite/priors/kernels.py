"""Kernels around points of one axis, all at once: what a kernel density estimate multiplies and adds up.

Each kernel integrates to one over the axis by itself. On real axes it is a Gaussian truncated to [0, 1]; on integer
axes the same, integrated over each level's bin; on ordinal and categorical axes the point's own level with most of the
mass, and the rest spread evenly over all levels.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtr, ndtri

from hypermap_lite.priors.base import Axis
from hypermap_lite.priors.truncated_gaussian import LOG_SQRT_2PI, log_difference
from hypermap_lite.typing import FloatArray, IntArray, Rng

NARROW_BIN = 1e-6
"""A bin narrower than this, in standard deviations of the kernel, has the mass of the density in its middle."""


class Kernels(ABC):
    """One kernel around each of n points of an axis."""

    __slots__ = ()

    centres: FloatArray
    """Codes of the points, shape (n,)."""

    @abstractmethod
    def log_densities(self, u: FloatArray) -> FloatArray:
        """Return the log density of each of the n kernels at m places, shape (m, n)."""

    @abstractmethod
    def mean_slope(self, u: FloatArray, shares: FloatArray) -> FloatArray:
        """Return the mean slope of the log kernels at m places, shape (m,), by each kernel's share, shape (m, n)."""

    @abstractmethod
    def sample(self, rows: IntArray, rng: Rng) -> FloatArray:
        """Draw a place from the kernel of each of some rows, shape (len(rows),)."""


@dataclass(frozen=True, slots=True)
class TruncatedGaussians(Kernels):
    """Gaussians on a real axis, each cut off at 0 and 1 and normalized by itself."""

    centres: FloatArray
    bandwidth: float
    """Standard deviation before truncation, in units of the axis."""

    def log_densities(self, u: FloatArray) -> FloatArray:
        """Return the log density of each kernel at m places, shape (m, n)."""
        z = (u[:, None] - self.centres) / self.bandwidth
        z *= z  # in place, for there may be millions
        z *= -0.5
        z -= LOG_SQRT_2PI + math.log(self.bandwidth) + self.log_masses()
        return z

    def log_masses(self) -> FloatArray:
        """Return the log of each Gaussian's probability of [0, 1], shape (n,)."""
        return np.log(ndtr((1 - self.centres) / self.bandwidth) - ndtr(-self.centres / self.bandwidth))

    def mean_slope(self, u: FloatArray, shares: FloatArray) -> FloatArray:
        """Return the mean slope of the log kernels at m places, shape (m,)."""
        return (shares @ self.centres - u) / self.bandwidth**2

    def sample(self, rows: IntArray, rng: Rng) -> FloatArray:
        """Draw by inversion, shape (len(rows),)."""
        centres = self.centres[rows]
        low, high = ndtr(-centres / self.bandwidth), ndtr((1 - centres) / self.bandwidth)
        return np.clip(centres + self.bandwidth * ndtri(low + rng.random(len(rows)) * (high - low)), 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class BinnedGaussians(Kernels):
    """Truncated Gaussians on an integer axis: constant within each level's bin, of the bin's mass."""

    centres: FloatArray
    bandwidth: float
    """Standard deviation before truncation, in units of the axis."""

    axis: Axis

    def log_densities(self, u: FloatArray) -> FloatArray:
        """Return the log density of each kernel at m places, shape (m, n); bins are computed where they are asked for.

        So an axis of any number of levels costs the same.
        """
        levels, places = np.unique(self.axis.level_index(u), return_inverse=True)
        return self._log_densities_in(levels)[places]

    def _log_densities_in(self, levels: IntArray) -> FloatArray:
        """Return the log density of each kernel in the bins of m levels, shape (m, n)."""
        low, high = self.axis.bins_of_levels(levels)
        gaussians = TruncatedGaussians(self.centres, self.bandwidth)
        at_middle = gaussians.log_densities((low + high) / 2)
        is_wide = high - low > NARROW_BIN * self.bandwidth
        low, high = low[is_wide], high[is_wide]
        a, b = ((edge[:, None] - self.centres) / self.bandwidth for edge in (low, high))
        # A bin in the upper tail is mirrored into the lower one, where differences keep their digits.
        a, b = np.where(a > 0, -b, a), np.where(a > 0, -a, b)
        masses = log_difference(log_ndtr(b), log_ndtr(a)) - gaussians.log_masses()
        at_middle[is_wide] = masses - np.log(high - low)[:, None]
        return at_middle

    def mean_slope(self, u: FloatArray, shares: FloatArray) -> FloatArray:
        """Return zeros, shape (m,)."""
        return np.zeros(len(u))

    def sample(self, rows: IntArray, rng: Rng) -> FloatArray:
        """Draw a level by its mass, and a place in its bin evenly, shape (len(rows),)."""
        drawn = TruncatedGaussians(self.centres, self.bandwidth).sample(rows, rng)
        return _within_bins(self.axis, self.axis.level_index(drawn), rng)


@dataclass(frozen=True, slots=True)
class SmoothedLevels(Kernels):
    """Smoothed frequencies on an ordinal or categorical axis of k levels [1]_.

    Mass 1 - s on the point's own level, plus s / k on each of the k levels.

    References
    ----------
    .. [1] Aitchison, Aitken. Multivariate Binary Discrimination by the Kernel Method. Biometrika, 1976.
    """

    centres: FloatArray
    smoothing: float
    """Share s of the mass that is spread over all levels, in (0, 1]."""

    axis: Axis

    def log_densities(self, u: FloatArray) -> FloatArray:
        """Return the log density of each kernel at m places, shape (m, n)."""
        n_levels = self.axis.n_levels
        assert n_levels is not None
        is_own = self.axis.level_index(u)[:, None] == self.axis.level_index(self.centres)
        spread = self.smoothing / n_levels
        # bins of width 1 / k turn a mass into k times that density
        return np.where(is_own, math.log(1 - self.smoothing + spread), math.log(spread)) + math.log(n_levels)

    def mean_slope(self, u: FloatArray, shares: FloatArray) -> FloatArray:
        """Return zeros, shape (m,)."""
        return np.zeros(len(u))

    def sample(self, rows: IntArray, rng: Rng) -> FloatArray:
        """Draw a level by its mass, and a place in its bin evenly, shape (len(rows),)."""
        own = self.axis.level_index(self.centres[rows])
        is_spread = rng.random(len(rows)) < self.smoothing
        levels = np.where(is_spread, rng.integers(self.axis.n_levels or 1, size=len(rows)), own)
        return _within_bins(self.axis, levels, rng)


def _within_bins(axis: Axis, levels: IntArray, rng: Rng) -> FloatArray:
    """Draw a place in the bin of each level, evenly, shape (n,)."""
    low, high = axis.bins_of_levels(levels)
    return low + rng.random(len(levels)) * (high - low)
