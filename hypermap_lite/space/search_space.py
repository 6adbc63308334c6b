"""All parameters as one space: the only place where configurations become arrays and arrays configurations."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from hypermap_lite.space.parameter import Parameter
from hypermap_lite.typing import BoolArray, Configuration, FloatArray

KEY_DECIMALS = 10
"""Codes of a real parameter that agree to this many decimals are the same value."""


@dataclass(frozen=True, slots=True)
class SearchSpace:
    """An ordered set of d parameters, seen as the unit cube [0, 1]^d with one axis each."""

    parameters: tuple[Parameter, ...]

    @property
    def dimension(self) -> int:
        """Number of parameters, d."""
        return len(self.parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """Parameter names in the order of the axes."""
        return tuple(p.name for p in self.parameters)

    @property
    def is_continuous(self) -> BoolArray:
        """Which axes are real, shape (d,)."""
        return np.array([p.n_levels is None for p in self.parameters])

    @property
    def is_ordered(self) -> BoolArray:
        """Which axes have an order (all but the categorical ones), shape (d,)."""
        return np.array([p.is_ordered for p in self.parameters])

    @property
    def n_configurations(self) -> float:
        """Number of different configurations; infinity with a real parameter."""
        return math.prod(math.inf if p.n_levels is None else p.n_levels for p in self.parameters)

    @property
    def default(self) -> Configuration | None:
        """The configuration of all defaults, or None if a parameter has none."""
        values = {p.name: p.default for p in self.parameters if p.default is not None}
        return values if len(values) == self.dimension else None

    def contains(self, configuration: Configuration) -> bool:
        """Tell whether a configuration names every parameter with a legal value, and nothing else."""
        return set(configuration) == set(self.names) and all(p.contains(configuration[p.name]) for p in self.parameters)

    def encode(self, configurations: Sequence[Configuration]) -> FloatArray:
        """Return the codes of n configurations, shape (n, d)."""
        X = np.empty((len(configurations), self.dimension))
        for j, parameter in enumerate(self.parameters):
            X[:, j] = parameter.encode([c[parameter.name] for c in configurations])
        return X

    def decode(self, X: FloatArray) -> list[Configuration]:
        """Return the configurations of n points of the cube, shape (n, d); discrete axes take their bin's level."""
        columns = [p.decode(X[:, j]) for j, p in enumerate(self.parameters)]
        return [dict(zip(self.names, row, strict=True)) for row in zip(*columns, strict=True)]

    def snap(self, X: FloatArray) -> FloatArray:
        """Move n points of the cube, shape (n, d), to the nearest legal codes."""
        return np.column_stack([p.snap(X[:, j]) for j, p in enumerate(self.parameters)])

    def keys(self, X: FloatArray) -> list[bytes]:
        """Return a hashable name of each of n points, equal for points that are the same configuration."""
        names = np.round(X, KEY_DECIMALS) + 0.0  # no negative zeros
        for j, parameter in enumerate(self.parameters):
            if parameter.n_levels is not None:
                names[:, j] = parameter.level_index(X[:, j])
        return [row.tobytes() for row in names]

    def unseen(self, X: FloatArray, seen: Iterable[bytes]) -> BoolArray:
        """Tell which of n points are neither among the seen keys nor a repeat of an earlier row, shape (n,)."""
        known = set(seen)
        new = np.zeros(len(X), dtype=bool)
        for i, key in enumerate(self.keys(X)):
            new[i] = key not in known
            known.add(key)
        return new

    def enumerate(self) -> FloatArray:
        """Return every point of a finite space, shape (n_configurations, d), last parameter fastest."""
        return np.array(list(product(*(p.level_codes() for p in self.parameters))))

    def sample_uniform(self, n: int, rng: np.random.Generator) -> FloatArray:
        """Draw n legal points uniformly (each level of a discrete axis by the width of its bin), shape (n, d)."""
        return self.snap(rng.random((n, self.dimension)))
