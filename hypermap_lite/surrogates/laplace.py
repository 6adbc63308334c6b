"""The Laplace approximation of a Gaussian process observed through yes and no."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import log_ndtr

from hypermap_lite.surrogates.linear_algebra import safe_cholesky, solve_lower
from hypermap_lite.typing import FloatArray

MAX_STEPS: Final = 30
"""Of Newton's method; ten are many."""

SMALL_GAIN: Final = 1e-6
"""An improvement of the log posterior that ends the search for its mode."""

LOG_SQRT_2PI: Final = 0.9189385332046727


@dataclass(frozen=True, slots=True)
class Laplace:
    """The most likely latent values f of n labels, p(y | f) = Phi(y f), and the curvature around them [1]_.

    References
    ----------
    .. [1] Rasmussen, Williams. Gaussian Processes for Machine Learning, sec. 3.4. MIT Press, 2006.
    """

    K: FloatArray
    """Prior covariance of the latent values, shape (n, n)."""

    latent: FloatArray
    """The mode, shape (n,)."""

    slope: FloatArray
    """Derivative of the log likelihood there, shape (n,): K^-1 times the mode."""

    root: FloatArray
    """Square root of minus the second derivative, shape (n,)."""

    L: FloatArray
    """Cholesky factor of I + root K root, shape (n, n)."""

    log_evidence: float
    """Log of the approximate probability of the labels."""

    third: FloatArray
    """Third derivative of the log likelihood, shape (n,)."""

    @classmethod
    def at(cls, K: FloatArray, labels: FloatArray) -> Laplace:
        """Find the mode by Newton's method [1]_, algorithm 3.1, halving steps that lead down.

        Parameters
        ----------
        K
            Prior covariance, shape (n, n).
        labels
            +1 or -1, shape (n,).
        """
        n = len(labels)
        a, f = np.zeros(n), np.zeros(n)
        value = float(log_ndtr(labels * f).sum())
        for _ in range(MAX_STEPS):
            slope, curvature, _ = derivatives(f, labels)
            root = np.sqrt(curvature)
            L = _factor(K, root)
            b = curvature * f + slope
            target = b - root * _solve(L, root * (K @ b))
            step, gain = 1.0, -1.0
            while gain < 0 and step > 1e-3:
                a_new = a + step * (target - a)
                f_new = K @ a_new
                gain = float(log_ndtr(labels * f_new).sum() - 0.5 * a_new @ f_new) - value
                step *= 0.5
            if gain > 0:
                a, f, value = a_new, f_new, value + gain
            if gain < SMALL_GAIN:
                break
        slope, curvature, third = derivatives(f, labels)
        root = np.sqrt(curvature)
        L = _factor(K, root)
        return cls(K, f, slope, root, L, value - float(np.log(np.diag(L)).sum()), third)

    def log_left_out(self, labels: FloatArray) -> FloatArray:
        """Return the log probability of each label by all others, the latent values' prior being that of all [1]_.

        Shape (n,). A label's part in the approximate posterior is taken out of it.

        References
        ----------
        .. [1] Vehtari, Mononen, Tolvanen, Sivula, Winther. Bayesian Leave-One-Out Cross-Validation Approximations for
           Gaussian Latent Variable Models. Journal of Machine Learning Research, 2016, sec. 3.5.
        """
        C = solve_lower(self.L, self.root[:, None] * self.K)
        variance = np.diag(self.K) - np.einsum("ij,ij->j", C, C)
        curvature = self.root**2
        rest = np.maximum(1.0 - variance * curvature, np.finfo(float).eps)
        mean = (self.latent - variance * (self.latent * curvature + self.slope)) / rest
        return np.asarray(log_ndtr(labels * mean / np.sqrt(1.0 + variance / rest)))

    def evidence_weights(self) -> FloatArray:
        """Return the symmetric matrix M with d log_evidence = sum(M * dK), shape (n, n) [1]_, algorithm 5.1."""
        half = solve_lower(self.L, np.diag(self.root))
        R = half.T @ half
        C = solve_lower(self.L, self.root[:, None] * self.K)
        by_latent = 0.5 * (np.diag(self.K) - np.einsum("ij,ij->j", C, C)) * self.third
        u = by_latent - R @ (self.K @ by_latent)
        M = 0.5 * (np.outer(self.slope, self.slope) - R)
        cross = np.outer(u, self.slope)
        return M + 0.5 * (cross + cross.T)


def derivatives(f: FloatArray, labels: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return first, minus second, and third derivative of log Phi(y f) by f, each of shape (n,)."""
    z = labels * f
    ratio = np.exp(-0.5 * z * z - LOG_SQRT_2PI - log_ndtr(z))
    curvature = np.maximum(ratio * (ratio + z), 1e-12)
    return labels * ratio, curvature, labels * (ratio * (ratio + z) * (2 * ratio + z) - ratio)


def _factor(K: FloatArray, root: FloatArray) -> FloatArray:
    B = root[:, None] * K * root
    B.flat[:: len(B) + 1] += 1.0
    L = safe_cholesky(B)
    assert L is not None, "a matrix whose eigenvalues are 1 or more has a factor"
    return L


def _solve(L: FloatArray, b: FloatArray) -> FloatArray:
    return solve_lower(L, solve_lower(L, b), transposed=True)
