"""Beta-shaped beliefs, among them HyperMapper's named priors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import betainc, betaln

from hypermap_lite.errors import ScenarioError, nearest, positive_number
from hypermap_lite.priors.base import Axis, Density, on_levels
from hypermap_lite.typing import FloatArray, Rng

SHAPES: Final[Mapping[str, tuple[float, float]]] = {
    "gaussian": (3.0, 3.0),
    "decay": (0.8, 1.0),
    "exponential": (1.0, 0.8),
}
"""Parameters (alpha, beta) behind HyperMapper's names [1]_.

.. [1] Souza et al. Bayesian Optimization with a Prior for the Optimum. ECML-PKDD 2021.
"""

SMALLEST, LARGEST = 0.5, 1e4
"""Range of alpha and beta: below, much of the mass would be closer to a bound than numbers can tell."""

EDGE = 1e-9
"""Densities that are unbounded at a bound are evaluated this far from it."""

MODE_EDGE = 0.01
"""Where such a density counts as highest, so that the infinite value at the bound does not dwarf the rest."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BetaPrior:
    """Beta density over the range, by `shape` name or by `alpha` and `beta`."""

    shape: str | None = None
    """``gaussian`` favours the middle, ``decay`` the lower bound, ``exponential`` the upper bound."""

    alpha: float | None = None
    beta: float | None = None

    def __post_init__(self) -> None:
        if (self.shape is None) == (self.alpha is None and self.beta is None):
            raise ScenarioError("$", "a beta prior needs a shape, or alpha and beta", allowed="one of the two")
        if self.shape is not None and self.shape not in SHAPES:
            known = ", ".join(SHAPES)
            raise ScenarioError(
                "$.shape", f"unknown shape {self.shape!r}", allowed=known, hint=nearest(self.shape, SHAPES)
            )
        if self.shape is None:
            for name, value in (("alpha", self.alpha), ("beta", self.beta)):
                number = positive_number(value, f"$.{name}", name)
                if not SMALLEST <= number <= LARGEST:
                    problem = f"{name} is {value!r}"
                    raise ScenarioError(f"$.{name}", problem, allowed=f"from {SMALLEST:g} to {LARGEST:g}")

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis."""
        alpha, beta = SHAPES[self.shape] if self.shape else (self.alpha, self.beta)
        assert alpha is not None
        assert beta is not None
        return on_levels(BetaDensity(float(alpha), float(beta)), axis)


@dataclass(frozen=True, slots=True)
class BetaDensity(Density):
    """Beta density on the unit interval."""

    alpha: float
    beta: float

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n,)."""
        return rng.beta(self.alpha, self.beta, size=n)

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,)."""
        inner = np.clip(u, EDGE, 1 - EDGE)
        log_norm = float(betaln(self.alpha, self.beta))
        return (self.alpha - 1) * np.log(inner) + (self.beta - 1) * np.log1p(-inner) - log_norm

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return the derivative of the log density, shape (n,)."""
        inner = np.clip(u, EDGE, 1 - EDGE)
        return (self.alpha - 1) / inner - (self.beta - 1) / (1 - inner)

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""
        return np.asarray(betainc(self.alpha, self.beta, u))

    def mode(self) -> float:
        """Return the point of highest density; a little off a bound where it is unbounded."""
        if self.alpha > 1 and self.beta > 1:
            return (self.alpha - 1) / (self.alpha + self.beta - 2)
        if self.alpha == self.beta == 1:
            return 0.5
        low = self.alpha < 1 or (self.alpha == 1 and self.beta > 1)
        unbounded = (self.alpha if low else self.beta) < 1
        edge = MODE_EDGE if unbounded else 0.0
        return edge if low and (self.beta >= 1 or self.alpha <= self.beta) else 1 - edge
