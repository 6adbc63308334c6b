"""All parameters as one space: the only place where configurations become arrays and arrays configurations."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt

from hypermap_lite.space.constraint import Constraint
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.permutation import PermutationParameter
from hypermap_lite.typing import BoolArray, Configuration, FloatArray, IntArray, Rng, Value

KEY_DECIMALS = 10
"""Codes of a real parameter that agree to this many decimals are the same value."""

LISTING_LIMIT = 2_000_000
"""A finite space up to this size is looked through for the configurations that its constraints allow."""

BLOCK = 100_000
"""Configurations looked at together; bounds the memory."""

MAX_DRAWS = 200_000
"""Draws after which the search for allowed points ends."""

FIRST_DRAWS = 256
"""Smallest number of draws at a time where constraints reject some."""


@dataclass(frozen=True)
class SearchSpace:
    """An ordered set of d parameters, seen as the unit cube [0, 1]^d with one axis each.

    Points of the cube are legal if their discrete coordinates are codes of levels, and allowed if their configurations
    meet all constraints.
    """

    parameters: tuple[Parameter, ...]
    constraints: tuple[Constraint, ...] = ()
    """Conditions that every configuration meets."""

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
        """Which axes have an order (all but categorical and permutation ones), shape (d,)."""
        return np.array([p.is_ordered for p in self.parameters])

    @property
    def permutations(self) -> Mapping[int, PermutationParameter]:
        """The permutation parameters by their axes."""
        return {j: p for j, p in enumerate(self.parameters) if isinstance(p, PermutationParameter)}

    @property
    def n_configurations(self) -> float:
        """Number of different allowed configurations; infinity with a real parameter.

        Of a finite space that is too large to be looked through, the number without constraints.
        """
        return self._size if self._allowed_rows is None else len(self._allowed_rows)

    @property
    def _size(self) -> float:
        return math.prod(math.inf if p.n_levels is None else p.n_levels for p in self.parameters)

    @cached_property
    def _allowed_rows(self) -> IntArray | None:
        """Numbers of the allowed configurations among all, the last parameter fastest; None if that is not known."""
        if not self.constraints or self._size > LISTING_LIMIT:
            return None
        tables = {p.name: _column(p.decode(p.level_codes())) for p in self.parameters if p.name in self._constrained}
        rows = []
        for start in range(0, int(self._size), BLOCK):
            block = np.arange(start, min(start + BLOCK, int(self._size)))
            levels = dict(zip(self.names, self._levels_of(block), strict=True))
            holds = self._hold({name: table[levels[name]] for name, table in tables.items()}, len(block))
            rows.append(block[holds])
        return np.concatenate(rows)

    def _levels_of(self, rows: IntArray) -> tuple[IntArray, ...]:
        """Return the level of each parameter in some configurations of a finite space, by their numbers."""
        return np.unravel_index(rows, [p.n_levels or 1 for p in self.parameters])

    @property
    def default(self) -> Configuration | None:
        """The configuration of all defaults, or None if a parameter has none."""
        values = {p.name: p.default for p in self.parameters if p.default is not None}
        return values if len(values) == self.dimension else None

    def contains(self, configuration: Configuration) -> bool:
        """Tell whether a configuration names every parameter, and nothing else, with legal values that are allowed."""
        return (
            set(configuration) == set(self.names)
            and all(p.contains(configuration[p.name]) for p in self.parameters)
            and not self.violated(configuration)
        )

    def violated(self, configuration: Configuration) -> list[int]:
        """Return which constraints a configuration of legal values does not meet, counted from 0."""
        columns = {name: _column([configuration[name]]) for name in self._constrained}
        return [i for i, constraint in enumerate(self.constraints) if not constraint.holds(columns, 1)[0]]

    @cached_property
    def _constrained(self) -> frozenset[str]:
        """Names of the parameters that the constraints speak of."""
        return frozenset().union(*(constraint.names for constraint in self.constraints))

    def is_allowed(self, X: FloatArray) -> BoolArray:
        """Tell which of n points of the cube decode to configurations that meet all constraints, shape (n,)."""
        if not len(X):
            return np.ones(0, dtype=bool)
        used = [j for j, p in enumerate(self.parameters) if p.name in self._constrained]
        return self._hold({self.names[j]: _column(self.parameters[j].decode(X[:, j])) for j in used}, len(X))

    def _hold(self, columns: Mapping[str, npt.NDArray[Any]], n: int) -> BoolArray:
        holds = np.ones(n, dtype=bool)
        for constraint in self.constraints:
            holds &= constraint.holds(columns, n)
        return holds

    def keep_allowed(self, X: FloatArray) -> FloatArray:
        """Return those of n points that are allowed, shape (k, d)."""
        return X[self.is_allowed(X)] if self.constraints else X

    def draw(self, n: int, sample: Callable[[int], FloatArray], limit: int = MAX_DRAWS) -> FloatArray:
        """Return n legal, allowed points among those that a function draws; fewer if `limit` draws hold no more.

        So the points have the function's distribution, given that they are allowed.
        """
        if not self.constraints:
            return self.snap(sample(n))
        found, n_drawn, size = np.empty((0, self.dimension)), 0, max(n, FIRST_DRAWS)
        while len(found) < n and n_drawn < limit:
            found = np.vstack([found, self.keep_allowed(self.snap(sample(size)))])
            n_drawn += size
            size = min(2 * size, BLOCK)
        return found[:n]

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
        return [row.tobytes() for row in self._names(X)]

    def _names(self, X: FloatArray) -> FloatArray:
        """Return numbers that are equal, bit by bit, for points that are the same configuration, shape (n, d)."""
        names = np.empty(X.shape)
        for j, parameter in enumerate(self.parameters):
            if parameter.n_levels is not None:
                names[:, j] = parameter.level_index(X[:, j])
            else:  # rounded twice, for a point and its configuration may lie on two sides of a half of a decimal
                names[:, j] = np.round(parameter.rounded(X[:, j]), KEY_DECIMALS)
        return names + 0.0  # no negative zeros

    def unseen(self, X: FloatArray, seen: Collection[bytes]) -> BoolArray:
        """Tell which of n points are neither among the seen keys nor a repeat of an earlier row, shape (n,)."""
        new = np.ones(len(X), dtype=bool)
        names = self._names(X)
        both = np.vstack([np.frombuffer(b"".join(seen)).reshape(-1, self.dimension), names])
        _, first, counts = np.unique(_fingerprints(both), return_inverse=True, return_counts=True)
        known = set(seen)
        for i in np.flatnonzero(counts[first][len(seen) :] > 1):  # all others differ from every other row
            key = names[i].tobytes()
            new[i] = key not in known
            known.add(key)
        return new

    def enumerate(self) -> FloatArray:
        """Return every allowed point of a finite space, shape (n_configurations, d), last parameter fastest."""
        if self._allowed_rows is not None:
            return self._points_of(self._allowed_rows)
        return self.keep_allowed(np.array(list(product(*(p.level_codes() for p in self.parameters)))))

    def _points_of(self, rows: IntArray) -> FloatArray:
        """Return the points of some configurations of a finite space, by their numbers, shape (n, d)."""
        levels = self._levels_of(rows)
        return np.column_stack([p.codes_of_levels(levels[j]) for j, p in enumerate(self.parameters)])

    def sample_listed(self, n: int, rng: Rng) -> FloatArray:
        """Draw up to n different points of a space whose allowed ones are known one by one; none of any other."""
        rows = self._allowed_rows
        if rows is None:
            return np.empty((0, self.dimension))
        return self._points_of(rng.choice(rows, size=min(n, len(rows)), replace=False))

    @cached_property
    def known_point(self) -> FloatArray:
        """Some allowed point, always the same, shape (1, d); shape (0, d) if none is found."""
        rng = np.random.default_rng(0)
        found = self.sample_uniform(1, rng) if self._allowed_rows is None else self.sample_listed(1, rng)
        return found if len(found) or self.default is None else self.keep_allowed(self.encode([self.default]))

    def share_allowed(self, n: int = 10_000) -> float:
        """Return the share of n uniform draws that are allowed, always the same."""
        X = np.random.default_rng(0).random((n, self.dimension))
        return float(self.is_allowed(self.snap(X)).mean())

    def sample_uniform(self, n: int, rng: Rng) -> FloatArray:
        """Draw n points uniformly (each level of a discrete axis by the width of its bin), shape (n, d)."""
        return self.draw(n, lambda k: rng.random((k, self.dimension)))


def _fingerprints(names: FloatArray) -> npt.NDArray[np.uint64]:
    """Return a number for each of n rows, equal for equal rows and hardly ever for others, shape (n,)."""
    bits = np.ascontiguousarray(names).view(np.uint64)
    mixed = (bits ^ (bits >> np.uint64(29))) * np.uint64(0xBF58476D1CE4E5B9)
    factors = np.arange(1, 2 * names.shape[1], 2, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    return np.asarray(((mixed ^ (mixed >> np.uint64(32))) * factors).sum(axis=1, dtype=np.uint64))


def _column(values: Sequence[Value]) -> npt.NDArray[Any]:
    """Return the native values of one parameter as an array."""
    is_text = bool(values) and isinstance(values[0], str)
    return np.array(values, dtype=object if is_text else float)
