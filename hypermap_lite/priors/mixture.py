"""Gaussian mixtures: several guesses about one parameter, or about several parameters together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number, positive_number
from hypermap_lite.priors.base import Axis, Density, check_keys, on_levels
from hypermap_lite.priors.truncated_gaussian import gaussian_on
from hypermap_lite.typing import FloatArray, Rng


@dataclass(frozen=True, slots=True, kw_only=True)
class MixturePrior:
    """Weighted sum of truncated Gaussians over one parameter.

    Each component is ``{"mean": ..., "std": ..., "weight": 1}``, truncated and normalized by itself.
    """

    components: Sequence[Mapping[str, Any]]

    def __post_init__(self) -> None:
        require_components(self.components)
        for i, component in enumerate(self.components):
            path = f"$.components[{i}]"
            check_keys(component, path, required=("mean", "std"), optional=("weight",))
            finite_number(component["mean"], f"{path}.mean", "the mean")
            positive_number(component["std"], f"{path}.std", "the standard deviation")

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis."""
        parts = tuple((gaussian_on(axis, c["mean"], c["std"]),) for c in self.components)
        return on_levels(MarginalMixture(MixtureDensity(parts, weights_of(self.components))), axis)


@dataclass(frozen=True, slots=True, kw_only=True)
class JointMixturePrior:
    """Weighted sum of axis-aligned truncated Gaussians over several real or integer parameters.

    Each component is ``{"mean": {name: value}, "std": {name: value}, "weight": 1}``; all name the same parameters.
    """

    components: Sequence[Mapping[str, Any]]

    def __post_init__(self) -> None:
        require_components(self.components)
        for i, component in enumerate(self.components):
            path = f"$.components[{i}]"
            check_keys(component, path, required=("mean", "std"), optional=("weight",))
            for name, mean in component["mean"].items():
                finite_number(mean, f"{path}.mean.{name}", "the mean")
            for name, std in component["std"].items():
                positive_number(std, f"{path}.std.{name}", "the standard deviation")
            for part in ("mean", "std"):
                if set(component[part]) != set(self.names):
                    given = ", ".join(component[part]) or "none"
                    raise ScenarioError(
                        f"{path}.{part}", f"it names the parameters {given}", allowed=f"all of {', '.join(self.names)}"
                    )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters it speaks of, in the order of the first component."""
        return tuple(self.components[0]["mean"])

    def on(self, axes: Sequence[Axis]) -> MixtureDensity:
        """Place it on the axes of its parameters, in the order of `names`."""
        parts = []
        for i, c in enumerate(self.components):
            try:
                parts.append(tuple(on_levels(gaussian_on(a, c["mean"][a.name], c["std"][a.name]), a) for a in axes))
            except ScenarioError as error:
                raise error.below(f"$.components[{i}]") from None
        return MixtureDensity(tuple(parts), weights_of(self.components))


@dataclass(frozen=True, slots=True)
class MixtureDensity:
    """Weighted sum of products of densities on k axes."""

    components: tuple[tuple[Density, ...], ...]
    weights: FloatArray
    """Probability of each component, summing to one."""

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n, k)."""
        chosen = rng.choice(len(self.weights), size=n, p=self.weights)
        U = np.empty((n, len(self.components[0])))
        for k, component in enumerate(self.components):
            rows = np.flatnonzero(chosen == k)
            for j, density in enumerate(component):
                U[rows, j] = density.sample(len(rows), rng)
        return U

    def log_density(self, U: FloatArray) -> FloatArray:
        """Return the log of the summed density at n points, shape (n, k), as shape (n,)."""
        return np.logaddexp.reduce(self._log_terms(U), axis=0)

    def _log_terms(self, U: FloatArray) -> FloatArray:
        """Return the log of each component's part of the density, shape (components, n)."""
        logs = [sum(f.log_density(U[:, j]) for j, f in enumerate(c)) for c in self.components]
        return np.log(self.weights)[:, None] + np.array(logs)

    def log_gradient(self, U: FloatArray) -> FloatArray:
        """Return the gradient of the log density, shape (n, k): the components' own, by their part of the density."""
        terms = self._log_terms(U)
        parts = np.exp(terms - terms.max(axis=0))
        parts /= parts.sum(axis=0)
        own = [np.column_stack([f.log_gradient(U[:, j]) for j, f in enumerate(c)]) for c in self.components]
        return np.einsum("cn,cnk->nk", parts, np.array(own))

    def mode(self) -> FloatArray:
        """Return the densest of the components' modes, shape (k,)."""
        modes = np.array([[f.mode() for f in component] for component in self.components])
        return np.asarray(modes[np.argmax(self.log_density(modes))])

    def marginal(self, axes: Sequence[int]) -> MixtureDensity:
        """Return the density on some axes: each component just drops the others."""
        return MixtureDensity(tuple(tuple(c[j] for j in axes) for c in self.components), self.weights)


@dataclass(frozen=True, slots=True)
class MarginalMixture(Density):
    """A mixture over a single axis."""

    mixture: MixtureDensity

    def sample(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points, shape (n,)."""
        return self.mixture.sample(n, rng)[:, 0]

    def log_density(self, u: FloatArray) -> FloatArray:
        """Return the log density, shape (n,)."""
        return self.mixture.log_density(u[:, None])

    def log_gradient(self, u: FloatArray) -> FloatArray:
        """Return the derivative of the log density, shape (n,)."""
        return self.mixture.log_gradient(u[:, None])[:, 0]

    def cdf(self, u: FloatArray) -> FloatArray:
        """Return the probability of [0, u], shape (n,)."""
        parts = np.array([component[0].cdf(u) for component in self.mixture.components])
        return self.mixture.weights @ parts

    def mode(self) -> float:
        """Return the densest of the components' modes."""
        return float(self.mixture.mode()[0])


def require_components(components: Sequence[Mapping[str, Any]]) -> None:
    """Raise a `ScenarioError` unless there is a component, and all weights are positive."""
    if not components:
        raise ScenarioError("$.components", "the list is empty", allowed="at least one component")
    for i, component in enumerate(components):
        positive_number(component.get("weight", 1), f"$.components[{i}].weight", "the weight")


def weights_of(components: Sequence[Mapping[str, Any]]) -> FloatArray:
    """Return the normalized weights of the components, shape (k,)."""
    weights = np.array([float(c.get("weight", 1)) for c in components])
    return weights / weights.sum()
