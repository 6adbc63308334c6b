"""Weighted sum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Linear:
    """The weighted sum of the objectives [1]_. It cannot reach concave parts of a front.

    References
    ----------
    .. [1] Paria, Kandasamy, Poczos. A Flexible Framework for Multi-Objective Bayesian Optimization using Random
       Scalarizations. UAI 2019.
    """

    is_linear: ClassVar[bool] = True

    def __call__(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return the weighted sum of each row, shape (..., m) to (...)."""
        return Y @ weights

    def gradient(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return the weights, shape (..., m)."""
        return np.broadcast_to(weights, Y.shape)
