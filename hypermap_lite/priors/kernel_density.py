"""A belief from data: the density of good configurations found before, in a simulation say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number, positive_number
from hypermap_lite.priors.base import Axis, JointDensity, is_numeric
from hypermap_lite.priors.kernels import BinnedGaussians, Kernels, SmoothedLevels, TruncatedGaussians
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.typing import FloatArray, Rng, Value

SINGLE_POINT_STD = 0.1
"""Standard deviation, in units of the axis, that stands in for the one a single point does not have."""

NARROWEST = 0.01
"""Smallest bandwidth, in units of the axis, so that no axis becomes a spike."""

FLATTEST = 1e3
"""Largest bandwidth, in units of the axis: the density is as good as uniform."""

BLOCK = 2_000_000
"""Pairs of a place and a point that are looked at together; bounds the memory."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KernelDensityPrior:
    """Kernel density estimate over the rows of a CSV file, which the loader has read into `points` [1]_ [2]_ [3]_.

    A product of one kernel per axis around each point, with Scott's bandwidths: the axis' standard deviation times
    n ** (-1 / (d + 4)), where n is the effective number of points, (sum w) ** 2 / sum w ** 2, and d the number of axes.

    References
    ----------
    .. [1] Scott. Multivariate Density Estimation: Theory, Practice, and Visualization. Wiley, 1992.
    .. [2] Souza et al. Bayesian Optimization with a Prior for the Optimum. ECML-PKDD 2021.
    .. [3] Mayr et al. Learning Skill-based Industrial Robot Tasks with User Priors. CASE 2022.
    """

    file: str | None = None
    """Where the points come from; not read here."""

    rows: str = "non_dominated"
    """Which rows of the file became points: ``non_dominated``, ``best`` or ``all``."""

    quantile: float | None = None
    """Share of the rows that ``best`` took."""

    weights: str | None = None
    """Column the points' weights come from."""

    bandwidth_factor: float = 1.0
    """Times Scott's bandwidth; above 1 for a vaguer belief."""

    independent: bool = False
    """Whether it is the product of one-dimensional densities, as HyperMapper has it, instead of a joint density."""

    parameters: Sequence[str] | None = None
    """Parameters that were taken from the file; None for all without a prior of their own."""

    points: Mapping[str, Sequence[Value]] | None = None
    """Values of each parameter at the n points, in native units."""

    point_weights: Sequence[float] | None = None
    """Weights of the n points, >= 0; None for equal ones."""

    def __post_init__(self) -> None:
        positive_number(self.bandwidth_factor, "$.bandwidth_factor", "the factor")
        if not self.points:
            hint = "load_scenario reads the points from the file." if self.file else ""
            raise ScenarioError("$.points", "there are no points", allowed="a list per parameter", hint=hint)
        n = len(next(iter(self.points.values())))
        for name, values in self.points.items():
            if not len(values) or len(values) != n:
                allowed = "one value per point, as many as every other" if n else "at least one point"
                raise ScenarioError(f"$.points.{name}", f"there are {len(values)} values", allowed=allowed)
        if self.point_weights is not None:
            _check_weights(self.point_weights, n)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters it speaks of."""
        return tuple(self.points or ())

    def on(self, axes: Sequence[Axis]) -> JointDensity:
        """Place it on the axes of its parameters, in the order of `names`.

        Raises
        ------
        ScenarioError
            If a value is none of its parameter's.
        """
        X = np.column_stack([self._codes(axis) for axis in axes])
        weights = np.ones(len(X)) if self.point_weights is None else np.array(self.point_weights, dtype=float)
        weights /= weights.max()
        weights /= weights.sum()
        X, weights = X[weights > 0], weights[weights > 0]
        if np.ptp(X, axis=0).max() == 0:  # however often it stands there, it is a single point
            X, weights = X[:1], np.ones(1)
        d = 1 if self.independent else len(axes)
        kernels = [self._kernels(axis, X[:, j], weights, d) for j, axis in enumerate(axes)]
        if not self.independent:
            return KernelDensity(tuple(kernels), weights)
        return ProductPrior(len(axes), tuple(((j,), KernelDensity((one,), weights)) for j, one in enumerate(kernels)))

    def _codes(self, axis: Axis) -> FloatArray:
        values = (self.points or {})[axis.name]
        for i, value in enumerate(values):
            if not axis.contains(value):
                path = f"$.points.{axis.name}[{i}]"
                raise ScenarioError(path, f"{value!r} is no value of '{axis.name}'", allowed=axis.allowed())
        return axis.encode(values)

    def _kernels(self, axis: Axis, codes: FloatArray, weights: FloatArray, d: int) -> Kernels:
        n = 1 / float(np.sum(weights**2))  # effective number of points
        if not is_numeric(axis):
            return SmoothedLevels(codes, min(1.0, self.bandwidth_factor * n ** (-2 / (d + 4))), axis)
        bandwidth = self.bandwidth_factor * _std(codes, weights) * n ** (-1 / (d + 4))
        bandwidth = min(max(bandwidth, NARROWEST), FLATTEST)
        if axis.n_levels is None:
            return TruncatedGaussians(codes, bandwidth)
        return BinnedGaussians(codes, bandwidth, axis)


@dataclass(frozen=True)
class KernelDensity:
    """Weighted sum over n points of products of kernels on k axes."""

    kernels: tuple[Kernels, ...]
    """The n kernels of each axis."""

    weights: FloatArray
    """Probability of each point, shape (n,), summing to one."""

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n, k)."""
        rows = rng.choice(len(self.weights), size=n, p=self.weights)
        return np.column_stack([one.sample(rows, rng) for one in self.kernels])

    def log_density(self, U: FloatArray) -> FloatArray:
        """Return the log density at m points, shape (m, k), as shape (m,)."""
        logs = np.empty(len(U))
        for block in self._blocks(len(U)):
            terms = self._log_terms(U[block])
            highest = terms.max(axis=1)
            logs[block] = highest + np.log(np.exp(terms - highest[:, None]).sum(axis=1))
        return logs

    def log_gradient(self, U: FloatArray) -> FloatArray:
        """Return the gradient of the log density, shape (m, k): the kernels' own, by their part of the density."""
        gradient = np.empty(U.shape)
        for block in self._blocks(len(U)):
            terms = self._log_terms(U[block])
            shares = np.exp(terms - terms.max(axis=1)[:, None])
            shares /= shares.sum(axis=1)[:, None]
            for j, one in enumerate(self.kernels):
                gradient[block, j] = one.mean_slope(U[block, j], shares)
        return gradient

    def mode(self) -> FloatArray:
        """Return the densest of the points, shape (k,)."""
        return self._mode.copy()

    @cached_property
    def _mode(self) -> FloatArray:
        centres = np.unique(np.column_stack([one.centres for one in self.kernels]), axis=0)
        return np.asarray(centres[np.argmax(self.log_density(centres))])

    def marginal(self, axes: Sequence[int]) -> KernelDensity:
        """Return the density on some axes: a product kernel just drops the others."""
        return KernelDensity(tuple(self.kernels[j] for j in axes), self.weights)

    def _blocks(self, m: int) -> list[slice]:
        size = max(BLOCK // len(self.weights), 1)
        return [slice(start, start + size) for start in range(0, m, size)]

    def _log_terms(self, U: FloatArray) -> FloatArray:
        """Return the log of each point's part of the density at m places, shape (m, n)."""
        terms = np.tile(np.log(self.weights), (len(U), 1))
        for j, one in enumerate(self.kernels):
            terms += one.log_densities(U[:, j])
        return terms


def _std(codes: FloatArray, weights: FloatArray) -> float:
    """Return the weighted standard deviation, unbiased as SciPy's ``gaussian_kde`` has it; weights sum to one."""
    if len(codes) == 1:
        return SINGLE_POINT_STD
    variance = weights @ (codes - weights @ codes) ** 2 / (weights @ (1 - weights))
    return float(np.sqrt(variance))


def _check_weights(weights: Sequence[float], n: int) -> None:
    if len(weights) != n:
        problem = f"there are {len(weights)} weights for {n} points"
        raise ScenarioError("$.point_weights", problem, allowed=f"{n} numbers >= 0")
    for i, weight in enumerate(weights):
        if finite_number(weight, f"$.point_weights[{i}]", "the weight") < 0:
            raise ScenarioError(f"$.point_weights[{i}]", f"the weight is {weight}", allowed="a number >= 0")
    if not sum(weights) > 0:
        raise ScenarioError("$.point_weights", "all weights are zero", allowed="at least one weight > 0")
