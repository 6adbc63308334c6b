"""Augmented Tchebyshev scalarization."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Tchebyshev:
    r"""The largest weighted objective plus a small multiple of the weighted sum [1]_.

    .. math:: \max_k w_k y_k + \rho \sum_k w_k y_k

    It reaches every part of a front, concave ones too.

    References
    ----------
    .. [1] Knowles. ParEGO: A Hybrid Algorithm with On-Line Landscape Approximation for Expensive Multiobjective
       Optimization Problems. IEEE Trans. Evolutionary Computation, 2006.
    """

    rho: float = 0.05
    is_linear: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not self.rho >= 0:
            raise ScenarioError("$.rho", f"the multiple is {self.rho}", allowed="a number >= 0")

    def __call__(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return the scalar of each row, shape (..., m) to (...)."""
        weighted = Y * weights
        return weighted.max(axis=-1) + self.rho * weighted.sum(axis=-1)

    def gradient(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return a subgradient by Y, shape (..., m)."""
        weighted = Y * weights
        is_largest = np.arange(Y.shape[-1]) == weighted.argmax(axis=-1)[..., None]
        return weights * (is_largest + self.rho)
