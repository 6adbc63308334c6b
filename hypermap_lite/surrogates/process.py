"""One objective's Gaussian process, conditioned on its data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hypermap_lite.surrogates.base import NO_PERMUTATIONS, Permutations
from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.surrogates.linear_algebra import inverse_from_cholesky, safe_cholesky, solve_lower
from hypermap_lite.surrogates.marginal_likelihood import (
    SMALLEST_KNOWN,
    Hyperparameters,
    constant_mean,
)
from hypermap_lite.surrogates.offsets import Offsets
from hypermap_lite.typing import BoolArray, FloatArray, Rng

NEXT_TO_ZERO = 1e-150
"""Outputs below this size are zero: their squares vanish."""

CONSTANT = 1e-12
"""Outputs whose relative standard deviation is below this are constant."""

LARGEST_NOISE = 1e6
"""Noise variance, in units of the standardized outputs, at which an output says nothing."""

STD_FLOOR = 1e-9
"""Smallest predicted standard deviation, in units of the standardized outputs."""


@dataclass(frozen=True, slots=True)
class Standardized:
    """Outputs of one objective with mean 0 and standard deviation 1."""

    values: FloatArray
    """Shape (n,)."""

    offset: float
    scale: float

    @classmethod
    def without(cls, y: FloatArray, is_outlier: BoolArray) -> Standardized:
        """Standardize n outputs by those that are no outliers; these have the value 0."""
        others = cls.of(y[~is_outlier])
        values = np.zeros(len(y))
        values[~is_outlier] = others.values
        return replace(others, values=values)

    @classmethod
    def of(cls, y: FloatArray) -> Standardized:
        """Standardize n outputs, at most 1e150 in size; constant ones, and next to zero ones, keep scale 1."""
        magnitude = float(np.abs(y).max())
        if magnitude < NEXT_TO_ZERO:
            return cls(np.zeros(len(y)), 0.0, 1.0)
        small = y / magnitude
        offset, spread = float(small.mean()), float(small.std())
        if spread < CONSTANT:
            return cls(np.zeros(len(y)), offset * magnitude, 1.0)
        return cls((small - offset) / spread, offset * magnitude, spread * magnitude)

    def also(self, y: FloatArray) -> Standardized:
        """Return these outputs followed by others, in the same units."""
        return replace(self, values=np.append(self.values, (y - self.offset) / self.scale))

    def noise(self, variance: FloatArray) -> FloatArray:
        """Return noise variances, shape (n,), in units of the standardized outputs, none below `SMALLEST_KNOWN`."""
        with np.errstate(over="ignore"):
            return np.clip((np.sqrt(variance) / self.scale) ** 2, SMALLEST_KNOWN, LARGEST_NOISE)


@dataclass(frozen=True, slots=True)
class Process:
    """One objective's process given its data, in standardized outputs."""

    X: FloatArray
    output: Standardized
    hyperparameters: Hyperparameters
    kernel: MaternHammingKernel
    mean: float
    L: FloatArray
    """Cholesky factor of the covariance of the data, noise included, shape (n, n)."""

    alpha: FloatArray
    """K^-1 (y - mean), shape (n,)."""

    known_noise: FloatArray | None = None
    """As in `MarginalLikelihood`."""

    offsets: Offsets | None = None
    """As in `MarginalLikelihood`."""

    inverse: FloatArray | None = None
    """Of the covariance of the data, if it has been worked out, shape (n, n)."""

    @property
    def noise_variances(self) -> FloatArray:
        """Noise variance of each output, shape (n,)."""
        relative = np.ones(len(self.X)) if self.known_noise is None else self.known_noise
        return self.hyperparameters.noise_variance * relative

    def draw_noise(self, rng: Rng) -> FloatArray:
        """Draw what the outputs are off by, shape (n,): noise, and the offsets of those beside."""
        noise: FloatArray = rng.standard_normal(len(self.X)) * np.sqrt(self.noise_variances)
        return noise if self.offsets is None else noise + self.offsets.draw(rng)

    @classmethod
    def condition(
        cls,
        X: FloatArray,
        output: Standardized,
        h: Hyperparameters,
        is_ordered: BoolArray,
        permutations: Permutations = NO_PERMUTATIONS,
        known_noise: FloatArray | None = None,
        offsets: Offsets | None = None,
    ) -> Process:
        """Condition a process with known hyperparameters on the data.

        If the covariance cannot be factorized even with jitter, the data count as pure noise, so that the
        prediction is their mean with the full output variance.
        """
        kernel = MaternHammingKernel(h.lengthscales, is_ordered, permutations)
        K = h.output_variance * kernel(X, X)
        K.flat[:: len(X) + 1] += h.noise_variance if known_noise is None else h.noise_variance * known_noise
        if offsets is not None:
            K += offsets.covariance
        L = safe_cholesky(K)
        if L is None:
            L = np.eye(len(X)) * 1e6
        inverse = inverse_from_cholesky(L)
        mean = constant_mean(inverse, output.values)
        residual = output.values - mean
        alpha = solve_lower(L, solve_lower(L, residual), transposed=True)
        return cls(X, output, h, kernel, mean, L, alpha, known_noise, offsets, inverse)

    def left_out(self) -> tuple[FloatArray, FloatArray]:
        """Return how far each output is from what all others predict of it, and the std of that, both shape (n,).

        In closed form, with the mean unknown and the hyperparameters of all outputs [1]_, which have seen the output
        left out.

        References
        ----------
        .. [1] Dubrule. Cross Validation of Kriging in a Unique Neighborhood. Mathematical Geology, 1983.
        """
        free_of_mean = self.precision()
        precision = np.diag(free_of_mean)
        return (free_of_mean @ self.output.values) / precision, 1 / np.sqrt(precision)

    def precision(self) -> FloatArray:
        """Return the inverse covariance of the outputs with the mean unknown, shape (n, n); singular along ones."""
        inverse = inverse_from_cholesky(self.L) if self.inverse is None else self.inverse
        pull = inverse.sum(axis=0)
        return np.asarray(inverse - np.outer(pull, pull) / pull.sum())

    def explained(self, counts: BoolArray) -> float:
        """Return which share of its outputs' variance the process explains if it predicts each from all others.

        The share is too large by what the hyperparameters owe to the output that is `left_out`, the more so the more
        axes there are. At most 1; where it is 0 or less, the mean of the others predicts an output as well. 1 if the
        outputs are equal. Outputs that say nothing are not asked for.

        Parameters
        ----------
        counts
            Which of the n outputs are to be explained, shape (n,), at least two.
        """
        if self.offsets is not None:
            counts = counts & self.offsets.says_something
        y, n = self.output.values[counts], int(counts.sum())
        by_mean = (y - y.mean()) * n / (n - 1)
        if not by_mean.any():
            return 1.0
        by_process = self.left_out()[0][counts]
        return float(1.0 - (by_process @ by_process) / (by_mean @ by_mean))

    def field_given(self, base: FloatArray, L: FloatArray, weights: FloatArray) -> ProcessField:
        """Return predictions mean + k(x, base) weights, with the variance left by the factor L."""
        return ProcessField(self, base, L, weights)

    def joint(self, B: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean, shape (b,), and covariance, shape (b, b), of the noise-free outputs at b points."""
        s2 = self.hyperparameters.output_variance
        cross = s2 * self.kernel(self.X, B)
        v = solve_lower(self.L, cross)
        return self.mean + cross.T @ self.alpha, s2 * self.kernel(B, B) - v.T @ v


@dataclass(frozen=True, slots=True)
class ProcessField:
    """Predictions of one objective at new points, in S scenarios that differ in their weights only."""

    process: Process
    base: FloatArray
    """Points conditioned on, shape (b, d)."""

    L: FloatArray
    """Cholesky factor of their covariance, shape (b, b)."""

    weights: FloatArray
    """Covariance^-1 times the centred values of each scenario, shape (b, S)."""

    def __call__(self, X: FloatArray) -> tuple[FloatArray, FloatArray, Callable[[FloatArray, FloatArray], FloatArray]]:
        """Return mean (S, n), std (n,) in the objective's units, and the pullback of their derivatives to X."""
        p = self.process
        s2, scale = p.hyperparameters.output_variance, p.output.scale
        C, H = p.kernel.parts(X, self.base)
        v = solve_lower(self.L, s2 * C.T)  # (b, n)
        std = np.sqrt(np.maximum(s2 - np.einsum("bn,bn->n", v, v), STD_FLOOR**2))
        mean = p.output.offset + scale * (p.mean + s2 * (C @ self.weights).T)

        def pullback(by_mean: FloatArray, by_std: FloatArray) -> FloatArray:
            u = solve_lower(self.L, v, transposed=True).T  # (n, b): K^-1 k
            by_k = scale * (by_mean.T @ self.weights.T - (by_std / std)[:, None] * u)
            return p.kernel.pull_coordinates(s2 * by_k * H, X, self.base)

        return mean, scale * std, pullback
