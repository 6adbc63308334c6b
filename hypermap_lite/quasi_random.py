"""Scrambled Sobol points: SciPy's own numbers, in a sixth (many axes, few points) to half of its time.

A suggestion scrambles a sequence of sixty axes or more for a few points each, and SciPy works out all thirty direction
numbers of every axis, where log2 of the points are needed.
"""

from __future__ import annotations

import functools

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from hypermap_lite.typing import FloatArray, Rng

UInt32Array = npt.NDArray[np.uint32]

BITS = 30
"""Of each coordinate."""

MAX_DIMENSION = 21201
"""Axes for which direction numbers are known [1]_.

References
----------
.. [1] Joe, Kuo. Constructing Sobol Sequences with Better Two-Dimensional Projections. SIAM J. Sci. Comput., 2008.
"""

KEPT_AXES = 64
"""Direction numbers are kept for at least so many axes."""

PLACES = np.left_shift(np.uint32(1), np.arange(BITS - 1, -1, -1, dtype=np.uint32))
"""Worth of each bit, the first one first."""

BELOW = np.where(np.tri(BITS, k=-1, dtype=bool), PLACES[:, None], np.uint32(0))
"""Worth of what is below the diagonal of a matrix of bits, shape (BITS, BITS)."""


def sobol_points(n: int, dimension: int, rng: Rng) -> FloatArray:
    """Return the first n points of a freshly scrambled Sobol sequence, shape (n, dimension), in [0, 1).

    Each axis is scrambled by a random lower triangular matrix of bits and a random shift [1]_. The points are those of
    `scipy.stats.qmc.Sobol` with the same generator, to the last bit.

    Parameters
    ----------
    n
        At most 2^30.
    dimension
        From 1 to `MAX_DIMENSION`.
    rng
        A child of it is drawn from, as SciPy does; it is itself left where it is but for its number of children.

    References
    ----------
    .. [1] Matousek. On the L2-Discrepancy for Anchored Boxes. Journal of Complexity, 1998.
    """
    (child,) = rng.spawn(1)
    shift = child.integers(2, size=(dimension, BITS), dtype=np.uint32) @ PLACES[::-1]
    matrices = child.integers(2, size=(dimension, BITS, BITS), dtype=np.uint32)
    columns = np.einsum("dij,ij->dj", matrices, BELOW) | PLACES
    exponent = max(n - 1, 0).bit_length()
    points = np.empty((2**exponent, dimension), dtype=np.uint32)
    points[0] = shift
    # In the order of a Gray code the second half of the points is the first one backwards, moved in one more direction.
    for j, bits in enumerate(_directions(_axes_kept(dimension), exponent)):
        direction = np.bitwise_xor.reduce(np.where(bits[:dimension], columns, np.uint32(0)), axis=1)
        k = 2**j
        np.bitwise_xor(points[:k][::-1], direction, out=points[k : 2 * k])
    return points[:n] * 2.0**-BITS


def _axes_kept(dimension: int) -> int:
    return min(max(KEPT_AXES, 2 ** (dimension - 1).bit_length()), MAX_DIMENSION)


@functools.lru_cache(maxsize=32)
def _directions(dimension: int, exponent: int) -> npt.NDArray[np.bool_]:
    """Return the bits of the first direction numbers of each axis, shape (exponent, dimension, BITS)."""
    from scipy.stats import qmc  # slow to import, and not needed to check a scenario

    points = qmc.Sobol(dimension, scramble=False, bits=BITS).random_base2(exponent)
    numbers: UInt32Array = (points * 2.0**BITS).astype(np.uint32)
    first = 2 ** np.arange(exponent)
    steps = numbers[first] ^ numbers[first - 1]
    return (steps[:, :, None] & PLACES) != 0


def quasi_normal(n: int, dimension: int, rng: Rng) -> FloatArray:
    """Return n standard normal draws from a scrambled Sobol sequence, shape (n, dimension).

    Beyond the sequence's largest dimension the rest is filled with ordinary draws.
    """
    known = min(dimension, MAX_DIMENSION)
    normal = ndtri(np.clip(sobol_points(n, known, rng), 1e-12, 1 - 1e-12))
    return np.hstack([normal, rng.standard_normal((n, dimension - known))])
