"""Expectation propagation for a Gaussian process observed through yes and no."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import log_ndtr

from hypermap_lite.surrogates.linear_algebra import safe_cholesky, solve_lower
from hypermap_lite.typing import FloatArray

MAX_STEPS: Final = 200
"""Updates of all sites; twenty are usual, a hundred where one label in many differs and lengthscales are long."""

DAMPING: Final = 0.8
"""Share of an update that is made. Whole ones of all sites at once may swing for ever where labels are sharp."""

PATIENCE: Final = 50
"""Every so many steps the share is halved."""

SMALL_CHANGE: Final = 1e-6
"""Of the latent means, that ends the search."""

SMALLEST: Final = 1e-10
"""Precision of a site, and of what is known without it, at least."""

LOG_SQRT_2PI: Final = 0.9189385332046727


@dataclass(frozen=True, slots=True)
class ExpectationPropagation:
    """Normal sites in place of n labels, p(y | f) = Phi(y f), that leave the latent values' moments [1]_.

    Where labels are one-sided the latent values' posterior is skewed, and its mode, which the Laplace approximation
    takes for the mean, too close to zero [2]_: of a point among thirty infeasible ones it says that it is feasible with
    a probability of a tenth.

    References
    ----------
    .. [1] Rasmussen, Williams. Gaussian Processes for Machine Learning, sec. 3.6. MIT Press, 2006.
    .. [2] Kuss, Rasmussen. Assessing Approximate Inference for Binary Gaussian Process Classification. Journal of
       Machine Learning Research, 2005.
    """

    latent: FloatArray
    """Posterior means of the latent values, shape (n,)."""

    slope: FloatArray
    """K^-1 times these means, shape (n,)."""

    root: FloatArray
    """Square root of the sites' precisions, shape (n,)."""

    L: FloatArray
    """Cholesky factor of I + root K root, shape (n, n)."""

    @classmethod
    def at(cls, K: FloatArray, labels: FloatArray) -> ExpectationPropagation:
        """Update all sites at once, by part of what each lacks, until the means stay where they are.

        Parameters
        ----------
        K
            Prior covariance, shape (n, n).
        labels
            +1 or -1, shape (n,).
        """
        precision, shift, share = np.zeros(len(labels)), np.zeros(len(labels)), DAMPING
        found = cls._given(K, precision, shift)
        for step in range(1, MAX_STEPS + 1):
            wanted_precision, wanted_shift = found._wanted(K, labels, precision, shift)
            precision = precision + share * (wanted_precision - precision)
            shift = shift + share * (wanted_shift - shift)
            before, found = found, cls._given(K, precision, shift)
            if np.abs(found.latent - before.latent).max(initial=0.0) < SMALL_CHANGE:
                break
            if step % PATIENCE == 0:
                share *= 0.5
        return found

    @classmethod
    def _given(cls, K: FloatArray, precision: FloatArray, shift: FloatArray) -> ExpectationPropagation:
        """Return the posterior by sites of these precisions and precisions times means, shape (n,) each."""
        root = np.sqrt(precision)
        B = root[:, None] * K * root
        B.flat[:: len(B) + 1] += 1.0
        L = safe_cholesky(B)
        assert L is not None, "a matrix whose eigenvalues are 1 or more has a factor"
        pull = solve_lower(L, solve_lower(L, root * (K @ shift)), transposed=True)
        slope = shift - root * pull
        return cls(K @ slope, slope, root, L)

    def _wanted(
        self, K: FloatArray, labels: FloatArray, precision: FloatArray, shift: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the sites that each label asks for, given what is known of its latent value by the others."""
        half = solve_lower(self.L, self.root[:, None] * K)
        variance = np.diag(K) - np.einsum("ij,ij->j", half, half)
        without = np.maximum(1 / variance - precision, SMALLEST)
        mean, variance = (self.latent / variance - shift) / without, 1 / without
        width = np.sqrt(1 + variance)
        z = labels * mean / width
        ratio = np.exp(-0.5 * z * z - LOG_SQRT_2PI - log_ndtr(z))
        mean_with = mean + labels * variance * ratio / width
        variance_with = variance - variance**2 * ratio * (z + ratio) / (1 + variance)
        return np.maximum(1 / variance_with - without, SMALLEST), mean_with / variance_with - mean * without
