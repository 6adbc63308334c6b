"""Functions drawn from a Gaussian process, for Thompson sampling."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from hypermap_lite.surrogates.base import Permutations
from hypermap_lite.surrogates.linear_algebra import solve_lower
from hypermap_lite.surrogates.process import Process
from hypermap_lite.typing import FloatArray, Rng

DEGREES_OF_FREEDOM = 5
"""A Matern-5/2 kernel's spectral density is a multivariate t distribution with 2 * 5/2 degrees of freedom."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Features:
    """Random features whose products average to the kernel, a draw of their weights included.

    Cosines for the ordered axes and for the embedded permutations [1]_, of which exp(-d^2 / l) is a Gaussian kernel;
    for a categorical axis with correlation rho between different levels, a factor sqrt(rho) g + sqrt(1 - rho) g_level
    per feature, with independent standard normal g and g_level.

    References
    ----------
    .. [1] Rahimi, Recht. Random Features for Large-Scale Kernel Machines. NeurIPS 2007.
    """

    frequencies: FloatArray
    """Shape (f, d); zero along axes without order."""

    phases: FloatArray
    amplitudes: FloatArray
    """Weight of each feature, shape (f,)."""

    correlations: dict[int, float]
    """Of each categorical axis, rho."""

    seed: int
    """Source of the factors of the categorical axes."""

    permutations: Permutations = field(default_factory=dict)
    embedded_frequencies: Mapping[int, FloatArray] = field(default_factory=dict)
    """Frequencies along the embedding of each permutation axis, shape (f, k)."""

    _draws: dict[tuple[int, int], FloatArray] = field(default_factory=dict, init=False, repr=False, compare=False)

    @classmethod
    def draw(cls, process: Process, n_features: int, rng: Rng) -> Features:
        """Draw features for a process' kernel."""
        h, is_ordered = process.hyperparameters, process.kernel.is_ordered
        chi2 = rng.chisquare(DEGREES_OF_FREEDOM, size=(n_features, 1)) / DEGREES_OF_FREEDOM
        frequencies = rng.standard_normal((n_features, len(is_ordered))) / np.sqrt(chi2) / h.lengthscales
        frequencies[:, ~is_ordered] = 0.0
        permutations = process.kernel.permutations
        return cls(
            frequencies=frequencies,
            phases=rng.uniform(0, 2 * np.pi, n_features),
            amplitudes=rng.standard_normal(n_features) * math.sqrt(2 * h.output_variance / n_features),
            correlations={
                int(c): math.exp(-1 / h.lengthscales[c]) for c in np.flatnonzero(~is_ordered) if c not in permutations
            },
            seed=int(rng.integers(2**63)),
            permutations=permutations,
            embedded_frequencies={
                axis: rng.standard_normal((n_features, parameter.embed(np.zeros(1)).shape[1]))
                * math.sqrt(2 / h.lengthscales[axis])
                for axis, parameter in permutations.items()
            },
        )

    def __call__(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the drawn function at n points, shape (n,), and its gradient, shape (n, d)."""
        angles = X @ self.frequencies.T + self.phases  # (n, f)
        for axis, parameter in self.permutations.items():
            angles += parameter.embed(X[:, axis]) @ self.embedded_frequencies[axis].T
        factors = np.broadcast_to(self.amplitudes, angles.shape)
        for axis, correlation in self.correlations.items():
            factors = factors * self._level_factors(axis, correlation, X[:, axis])
        value = (np.cos(angles) * factors).sum(axis=1)
        return value, -(np.sin(angles) * factors) @ self.frequencies

    def _level_factors(self, axis: int, correlation: float, codes: FloatArray) -> FloatArray:
        """Return the factor of every feature at n codes of a categorical axis, shape (n, f)."""
        common = math.sqrt(correlation) * self._draw_once(axis, 0)
        levels, index = np.unique(codes, return_inverse=True)
        own = np.array([self._draw_once(axis, 1 + int(u * 2**40)) for u in levels])
        return common + math.sqrt(1 - correlation) * own[index]

    def _draw_once(self, axis: int, number: int) -> FloatArray:
        """Return one standard normal draw per feature, the same for the same numbers, shape (f,)."""
        if (axis, number) not in self._draws:
            rng = np.random.default_rng([self.seed, axis, number])
            self._draws[axis, number] = rng.standard_normal(len(self.amplitudes))
        return self._draws[axis, number]


@dataclass(frozen=True, slots=True)
class Path:
    """One function drawn from a posterior: a draw from the prior, corrected by the data."""

    process: Process
    features: Features
    correction: FloatArray
    """Weights of the kernel functions at the data, shape (n,)."""

    @classmethod
    def draw(cls, process: Process, n_features: int, rng: Rng) -> Path:
        """Draw a function and its noise at the data, and correct it by Matheron's rule."""
        features = Features.draw(process, n_features, rng)
        residual = process.output.values - process.mean - features(process.X)[0] - process.draw_noise(rng)
        correction = solve_lower(process.L, solve_lower(process.L, residual), transposed=True)
        return cls(process, features, correction)

    def __call__(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the function at n points in the objective's units, shape (n,), and its gradient, shape (n, d)."""
        p = self.process
        C, H = p.kernel.parts(X, p.X)
        weights = p.hyperparameters.output_variance * self.correction
        prior, gradient = self.features(X)
        value = p.mean + prior + C @ weights
        gradient = gradient + p.kernel.pull_coordinates(weights * H, X, p.X)
        return p.output.offset + p.output.scale * value, p.output.scale * gradient
