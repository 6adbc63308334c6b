"""The scalarization whose average over random directions is the dominated hypervolume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class HypervolumeScalarization:
    r"""Minus the m-th power of the distance from the reference point r to where a ray leaves what y dominates [1]_.

    .. math:: s(y) = -\Bigl(\min_k \frac{r_k - y_k}{w_k}\Bigr)^m

    with a direction w of length one; beyond the reference point it is linear, so that it leads inside. The mean over
    uniform directions of the least s of a set is minus its hypervolume, up to a constant that depends on m only.

    References
    ----------
    .. [1] Zhang, Golovin. Random Hypervolume Scalarizations for Provable Multi-Objective Black Box Optimization.
       ICML 2020, eq. 1 and lemma 5.
    """

    corner: FloatArray
    """The reference point in normalized objectives, shape (m,)."""

    is_linear: ClassVar[bool] = False

    def __call__(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return the scalar of each row, shape (..., m) to (...)."""
        length = ((self.corner - Y) / weights).min(axis=-1)
        return np.asarray(-np.where(length > 0, np.abs(length) ** Y.shape[-1], length))

    def gradient(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return a (sub)gradient by Y, shape (..., m)."""
        m = Y.shape[-1]
        lengths = (self.corner - Y) / weights
        length = lengths.min(axis=-1, keepdims=True)
        is_least = np.arange(m) == lengths.argmin(axis=-1)[..., None]
        return np.asarray(is_least / weights * np.where(length > 0, m * np.abs(length) ** (m - 1), 1.0))


def random_direction(m: int, rng: Rng) -> FloatArray:
    """Draw a direction uniformly from the positive part of the unit sphere, shape (m,)."""
    normal = np.abs(rng.standard_normal(m)) + 1e-12
    return np.asarray(normal / np.linalg.norm(normal))
