"""Tchebyshev scalarization whose weights are a direction in the space of the objectives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.typing import FloatArray

SMALLEST_WEIGHT = 1e-6
"""Weights below this count as this: their inverses are what is used."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModifiedTchebyshev:
    r"""The Tchebyshev scalarization with inverse weights [1]_, augmented as the plain one is [2]_.

    .. math:: \max_k r_k y_k + \rho \sum_k r_k y_k, \qquad r_k = (1 / w_k) / \sum_j (1 / w_j)

    The best point of a front is where the ray along w from the ideal point meets it, so weights that are spread evenly
    spread the points evenly; with the plain form they crowd where the front is flat. HyperMapper has it without the
    augmentation [3]_.

    References
    ----------
    .. [1] Yuan, Xu, Wang, Zhang, Yao. Balancing Convergence and Diversity in Decomposition-Based Many-Objective
       Optimizers. IEEE Trans. Evolutionary Computation, 2016.
    .. [2] Steuer, Choo. An Interactive Weighted Tchebycheff Procedure for Multiple Objective Programming.
       Mathematical Programming, 1983.
    .. [3] Nardi, Koeplinger, Olukotun. Practical Design Space Exploration. MASCOTS 2019.
    """

    rho: float = 0.05
    is_linear: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not self.rho >= 0:
            raise ScenarioError("$.rho", f"the multiple is {self.rho}", allowed="a number >= 0")

    def __call__(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return the scalar of each row, shape (..., m) to (...)."""
        weighted = Y * inverse_weights(weights)
        return weighted.max(axis=-1) + self.rho * weighted.sum(axis=-1)

    def gradient(self, Y: FloatArray, weights: FloatArray) -> FloatArray:
        """Return a subgradient by Y, shape (..., m)."""
        inverse = inverse_weights(weights)
        is_largest = np.arange(Y.shape[-1]) == (Y * inverse).argmax(axis=-1)[..., None]
        return inverse * (is_largest + self.rho)


def inverse_weights(weights: FloatArray) -> FloatArray:
    """Return the inverses of m weights, shape (m,), scaled to sum to one.

    >>> inverse_weights(np.array([0.25, 0.75]))
    array([0.75, 0.25])
    """
    inverse = 1.0 / np.maximum(weights, SMALLEST_WEIGHT)
    return inverse / inverse.sum()
