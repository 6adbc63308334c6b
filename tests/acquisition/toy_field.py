"""A smooth field in closed form, for tests of scorers without a model."""

import numpy as np

from hypermap_lite.surrogates.base import Conditional, Field


def toy_field(scenarios: int) -> Field:
    """Return a field of two objectives on the square: mean_sk = sin(a_sk . x), std_k = 0.2 + 0.1 x_0 (k + 1)."""
    a = np.random.default_rng(1).standard_normal((scenarios, 2, 2))  # (S, m, d)

    def field(X: np.ndarray) -> Conditional:
        angle = np.einsum("smd,nd->snm", a, X)
        std = (0.2 + 0.1 * X[:, :1] * np.array([1.0, 2.0]))[None]

        def pullback(by_mean: np.ndarray, by_std: np.ndarray) -> np.ndarray:
            gradient = np.einsum("snm,smd->nd", by_mean * np.cos(angle), a)
            gradient[:, 0] += (by_std.sum(axis=0) * np.array([0.1, 0.2])).sum(axis=1)
            return gradient

        return Conditional(mean=np.sin(angle), std=std, pullback=pullback)

    return field
