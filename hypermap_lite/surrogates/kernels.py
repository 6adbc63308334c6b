"""The covariance function: Matern-5/2 over ordered axes times a factor for each categorical or permutation axis."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from hypermap_lite.surrogates.base import Permutations
from hypermap_lite.typing import BoolArray, FloatArray

SQRT5 = math.sqrt(5.0)


@dataclass(frozen=True, slots=True)
class MaternHammingKernel:
    r"""Product kernel with one lengthscale per axis and unit variance.

    .. math::

        k(x, x') = (1 + \sqrt5 r + \tfrac53 r^2) e^{-\sqrt5 r} \prod_{c} e^{-d_c(x_c, x'_c) / l_c},
        \qquad r^2 = \sum_j (x_j - x'_j)^2 / l_j^2

    with j over the ordered and c over the other axes [1]_: d is 0 or 1 for equal and different categories, and a
    distance between 0 and 1 for permutations [2]_.

    References
    ----------
    .. [1] Rasmussen, Williams. Gaussian Processes for Machine Learning, eq. 4.17. MIT Press, 2006.
    .. [2] Deshwal, Belakaria, Doppa, Kim. Bayesian Optimization over Permutation Spaces. AAAI 2022.
    """

    lengthscales: FloatArray
    """Shape (d,), in units of the cube; of a categorical axis, the inverse of the log loss of correlation."""

    is_ordered: BoolArray
    """Which axes have an order, shape (d,)."""

    permutations: Permutations = field(default_factory=dict)
    """The axes without an order whose codes are permutations."""

    def __call__(self, A: FloatArray, B: FloatArray) -> FloatArray:
        """Return the correlations of n and k points, shape (n, k)."""
        return self.parts(A, B)[0]

    def parts(self, A: FloatArray, B: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the correlations, shape (n, k), and the factor H that all their derivatives share.

        By a coordinate: dk/da_j = -H (a_j - b_j) / l_j^2; by a lengthscale: dk/dlog(l_j) = H (a_j - b_j)^2 / l_j^2.
        """
        # In place: memory that is asked for and given back again and again costs more than the arithmetic.
        r5 = self._squared_distances(A, B)
        np.sqrt(r5, out=r5)
        r5 *= SQRT5
        decay = np.negative(r5)
        np.exp(decay, out=decay)
        hamming = self._hamming(A, B)
        if hamming is not None:
            decay *= hamming
        H = 1.0 + r5
        K: FloatArray = np.square(r5, out=r5)
        K /= 3.0
        K += H
        K *= decay
        H *= 5.0 / 3.0
        H *= decay
        return K, H

    def _squared_distances(self, A: FloatArray, B: FloatArray) -> FloatArray:
        ordered = slice(None) if self._has_order_only else self.is_ordered
        scale = 1.0 / self.lengthscales[ordered]
        b = np.asfortranarray(B[:, ordered]) * scale
        # The expanded square loses digits for close points, so it is centred first and floored at zero.
        centre = b.mean(axis=0) if len(b) else 0.0
        b -= centre
        a = b.copy(order="F") if A is B else np.asfortranarray(A[:, ordered]) * scale - centre
        rest = (b * b).sum(axis=1)
        squares: FloatArray = (rest if A is B else (a * a).sum(axis=1))[:, None] + rest[None, :]
        products = a @ b.T
        products *= 2.0
        squares -= products
        return np.maximum(squares, 0.0, out=squares)

    @property
    def _has_order_only(self) -> bool:
        return bool(self.is_ordered.all())

    def _hamming(self, A: FloatArray, B: FloatArray) -> FloatArray | None:
        if self._has_order_only:
            return None
        exponent = np.zeros((len(A), len(B)))
        for c in np.flatnonzero(~self.is_ordered):
            exponent += self._distances(int(c), A, B) / self.lengthscales[c]
        return np.exp(-exponent)

    def _distances(self, axis: int, A: FloatArray, B: FloatArray) -> FloatArray:
        """Return the distances of n and k points along an axis without order, shape (n, k)."""
        if axis not in self.permutations:
            return (A[:, axis][:, None] != B[:, axis][None, :]).astype(float)
        a, b = (self.permutations[axis].embed(points[:, axis]) for points in (A, B))
        squares = (a * a).sum(axis=1)[:, None] + (b * b).sum(axis=1)[None, :] - 2.0 * (a @ b.T)
        return np.maximum(squares, 0.0)

    def pull_coordinates(self, weights: FloatArray, A: FloatArray, B: FloatArray) -> FloatArray:
        """Return sum_b w_ab H_ab (-(a - b)) / l^2: the gradient by A of sum_b w_ab k(a, b), shape (n, d).

        Parameters
        ----------
        weights
            The products w_ab H_ab, shape (n, k).
        A, B
            The points, shapes (n, d) and (k, d).
        """
        gradient = -(A * weights.sum(axis=1)[:, None] - weights @ B) / self.lengthscales**2
        gradient[:, ~self.is_ordered] = 0.0
        return gradient

    def pull_log_lengthscales(self, W: FloatArray, K: FloatArray, H: FloatArray, X: FloatArray) -> FloatArray:
        """Return sum_ab W_ab dk(x_a, x_b)/dlog(l_j) for a symmetric W, shape (d,)."""
        G = W * H
        # sum_ab G_ab (x_a - x_b)^2 = 2 (sum_a x_a^2 g_a - x' G x), with g the row sums of G
        squares = 2.0 * ((X * X).T @ G.sum(axis=1) - np.einsum("aj,aj->j", X, G @ X))
        gradient = squares / self.lengthscales**2
        WK = None
        for c in np.flatnonzero(~self.is_ordered):
            WK = W * K if WK is None else WK
            if c in self.permutations:
                gradient[c] = np.vdot(WK, self._distances(int(c), X, X)) / self.lengthscales[c]
                continue
            differs = X[:, c][:, None] != X[:, c][None, :]
            gradient[c] = WK[differs].sum() / self.lengthscales[c]
        return gradient
