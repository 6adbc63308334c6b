"""Cholesky factors that do not fail."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from hypermap_lite.typing import FloatArray

JITTERS = (0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
"""Multiples of the mean diagonal that are added, one after the other, until the factorization succeeds."""


def safe_cholesky(K: FloatArray, smallest_jitter: float = 0.0) -> FloatArray | None:
    """Return the lower Cholesky factor of a covariance, shape (n, n), with as little jitter as will do.

    Parameters
    ----------
    K
        Symmetric matrix, shape (n, n).
    smallest_jitter
        First jitter to try, as a multiple of the mean diagonal.

    Returns
    -------
    FloatArray | None
        The factor; None if the largest jitter does not help either.
    """
    if not np.isfinite(K).all():
        return None
    size = float(np.mean(np.diag(K))) or 1.0
    for jitter in JITTERS:
        if jitter < smallest_jitter:
            continue
        shifted = K.copy()
        shifted.flat[:: len(K) + 1] += jitter * size
        try:
            return np.asarray(cholesky(shifted, lower=True, check_finite=False))
        except np.linalg.LinAlgError:
            continue
    return None


def solve_lower(L: FloatArray, B: FloatArray, *, transposed: bool = False) -> FloatArray:
    """Return L^-1 B, or L^-T B, for a lower triangular L."""
    return np.asarray(solve_triangular(L, B, lower=True, trans=1 if transposed else 0, check_finite=False))
