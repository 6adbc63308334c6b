"""Cholesky factors that do not fail."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotri, dtrtrs

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
    for jitter in JITTERS:
        if jitter < smallest_jitter:
            continue
        shifted = K
        if jitter:
            shifted = K.copy()
            shifted.flat[:: len(K) + 1] += jitter * (float(np.mean(np.diag(K))) or 1.0)
        L, status = dpotrf(shifted, lower=1, clean=1)
        if status == 0:
            return np.asarray(L)
    return None


def inverse_from_cholesky(L: FloatArray) -> FloatArray:
    """Return (L L')^-1, shape (n, n), for a lower triangular L whose other half is zero."""
    lower, status = dpotri(L, lower=1)
    if status != 0:
        half = solve_lower(L, np.eye(len(L)))
        return half.T @ half
    inverse: FloatArray = lower + lower.T
    inverse.flat[:: len(L) + 1] = np.diag(lower)
    return inverse


def solve_lower(L: FloatArray, B: FloatArray, *, transposed: bool = False) -> FloatArray:
    """Return L^-1 B, or L^-T B, for a lower triangular L."""
    if not B.size:
        return np.zeros(B.shape)
    if L.flags.f_contiguous:
        X, status = dtrtrs(L, B, lower=1, trans=int(transposed))
    else:  # LAPACK sees the transpose, without a copy
        X, status = dtrtrs(L.T, B, lower=0, trans=int(not transposed))
    if status != 0:
        raise np.linalg.LinAlgError(f"row {status} of the triangular matrix has a zero on its diagonal")
    return np.asarray(X)
