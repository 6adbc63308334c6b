"""What a prior is: a belief about one parameter, or several, that becomes a density on the unit cube.

A prior as the user writes it (`MarginalPrior`, `JointPrior`) is in the parameter's own units. Placed on the axes of
the search space it becomes a `Density`, on the unit interval or cube, so units play no part from there on. The same
density is sampled and scored, and it integrates to one.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.typing import FloatArray, IntArray, Rng, Value

SMALLEST_MASS = 1e-12
"""Masses of bins below this are taken from the density instead of from a difference of probabilities."""

MAX_BINS = 10_000
"""The bins of an axis with more levels than this are not listed, but computed where they are asked for."""


class Axis(Protocol):
    """What a prior needs to know of a parameter; `hypermap_lite.space.Parameter` offers it."""

    @property
    def name(self) -> str:
        """Name of the parameter."""
        ...

    @property
    def n_levels(self) -> int | None:
        """Number of levels; None if continuous."""
        ...

    def contains(self, value: object) -> bool:
        """Tell whether a native value is legal."""
        ...

    def allowed(self) -> str:
        """Say in words which values are legal, for messages."""
        ...

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n legal native values, shape (n,)."""
        ...

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the native values of n codes in [0, 1]."""
        ...

    def locate(self, value: float) -> float:
        """Return where a native number lies on the unit axis; may be outside [0, 1]."""
        ...

    def scale_std(self, std: float) -> float:
        """Return a native standard deviation in units of the axis."""
        ...

    def bin_edges(self) -> FloatArray:
        """Return the edges of the levels' bins, shape (n_levels + 1,)."""
        ...

    def level_index(self, codes: FloatArray) -> IntArray:
        """Return which level each code decodes to, shape (n,)."""
        ...

    def codes_of_levels(self, levels: IntArray) -> FloatArray:
        """Return the codes of some levels, shape (n,)."""
        ...

    def bins_of_levels(self, levels: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper edges of the bins of some levels, both shape (n,)."""
        ...


class Density(ABC):
    """A probability density on the unit interval."""

    __slots__ = ()

    @abstractmethod
    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n,)."""

    @abstractmethod
    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density at points of [0, 1], shape (n,)."""

    @abstractmethod
    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return the derivative of the log density, shape (n,); zero within the bins of a discrete axis."""

    @abstractmethod
    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""

    @abstractmethod
    def mode(self) -> float:
        """Return a point of highest density; away from the edges where the density is unbounded there."""


class JointDensity(Protocol):
    """A probability density on the unit cube of k axes."""

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n, k)."""
        ...

    def log_density(self, U: FloatArray) -> FloatArray:
        """Return the log density at n points, shape (n, k), as shape (n,)."""
        ...

    def log_gradient(self, U: FloatArray) -> FloatArray:
        """Return the gradient of the log density at n points, shape (n, k)."""
        ...

    def mode(self) -> FloatArray:
        """Return a point of (nearly) highest density, shape (k,)."""
        ...

    def marginal(self, axes: Sequence[int]) -> JointDensity:
        """Return the density on some of the k axes, each named once, in the order given; the others integrated out."""
        ...


class MarginalPrior(Protocol):
    """A belief about one parameter, in its own units."""

    def on(self, axis: Axis) -> Density:
        """Place it on the parameter's axis."""
        ...


class JointPrior(Protocol):
    """A belief about several parameters together, in their own units."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters it speaks of."""
        ...

    def on(self, axes: Sequence[Axis]) -> JointDensity:
        """Place it on the axes of those parameters, given in the order of `names`."""
        ...


@dataclass(frozen=True, slots=True)
class Histogram(Density):
    """A piecewise constant density: what any prior becomes on a discrete axis."""

    edges: FloatArray
    """Edges of the bins, shape (k + 1,), from 0 to 1."""

    masses: FloatArray
    """Probability of each bin, shape (k,), summing to one."""

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, uniform within their bins, shape (n,)."""
        bins = rng.choice(len(self.masses), size=n, p=self.masses)
        return self.edges[bins] + rng.random(n) * np.diff(self.edges)[bins]

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,); -inf in a bin without mass."""
        bins = np.clip(np.searchsorted(self.edges, u, side="right") - 1, 0, len(self.masses) - 1)
        with np.errstate(divide="ignore"):
            return np.log(self.masses / np.diff(self.edges))[bins]

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return zeros, shape (n,)."""
        return np.zeros(len(u))

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""
        return np.interp(u, self.edges, np.concatenate([[0.0], np.cumsum(self.masses)]))

    def mode(self) -> float:
        """Return the middle of the densest bin."""
        best = int(np.argmax(self.masses / np.diff(self.edges)))
        return float((self.edges[best] + self.edges[best + 1]) / 2)


@dataclass(frozen=True, slots=True)
class ManyLevels(Density):
    """A density over an axis of many levels: constant in each bin, of the bin's mass."""

    density: Density
    axis: Axis

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n,)."""
        return self.density.sample(n, rng)

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,)."""
        low, high = self.axis.bins_of_levels(self.axis.level_index(u))
        mass = self.density.cdf(high) - self.density.cdf(low)
        with np.errstate(divide="ignore"):
            by_mass = np.log(np.maximum(mass, 0.0) / (high - low))
        # Far in a tail the difference of two probabilities near one has no digits left; there a bin is narrow.
        return np.where(mass > SMALLEST_MASS, by_mass, self.density.log_density(u))

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return zeros, shape (n,)."""
        return np.zeros(len(u))

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,), exact at the edges of the bins."""
        return self.density.cdf(u)

    def mode(self) -> float:
        """Return the code of the densest of the levels around the density's mode."""
        level = self.axis.level_index(np.array([self.density.mode()]))
        levels = np.clip(level + np.arange(-1, 2), 0, (self.axis.n_levels or 1) - 1)
        codes = self.axis.codes_of_levels(levels)
        return float(codes[np.argmax(self.log_density(codes))])


def is_numeric(axis: Axis) -> bool:
    """Tell whether distances on an axis mean something: it is that of a real or integer parameter."""
    try:
        axis.scale_std(1.0)
    except ScenarioError:
        return False
    return True


def on_levels(density: Density, axis: Axis) -> Density:
    """Turn a density on the unit interval into one over an axis' levels: constant in each bin, of the bin's mass."""
    if axis.n_levels is None:
        return density
    if axis.n_levels > MAX_BINS:
        return ManyLevels(density, axis)
    edges = axis.bin_edges()
    masses = np.maximum(np.diff(density.cdf(edges)), 0.0)
    if masses.sum() <= 0:  # all mass lies between two floating-point numbers
        masses = np.where(np.arange(axis.n_levels) == np.searchsorted(edges[1:-1], density.mode()), 1.0, 0.0)
    return Histogram(edges, masses / masses.sum())


def check_keys(options: Mapping[str, Any], path: str, *, required: Sequence[str], optional: Sequence[str] = ()) -> None:
    """Raise a `ScenarioError` if a key of a nested object is missing or unknown."""
    known = [*required, *optional]
    for key in options:
        if key not in known:
            raise ScenarioError(f"{path}.{key}", "unknown key", allowed=", ".join(known), hint=nearest(key, known))
    for key in required:
        if key not in options:
            raise ScenarioError(path, f"the key '{key}' is missing", allowed=", ".join(known))
