"""Latin hypercube sampling: plain, by the prior, and per combination of categories."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hypermap_lite.design.base import distinct
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.priors.quantiles import quantiles
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import FloatArray, IntArray, Rng

MANY = 2**62
"""Combinations of categories beyond this are not numbered: independent draws hardly ever repeat one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LatinHypercube:
    """One random point in each of n equal slices of every axis [1]_.

    Where constraints reject some, points of further hypercubes take their place.

    References
    ----------
    .. [1] McKay, Beckman, Conover. A Comparison of Three Methods for Selecting Values of Input Variables in the
       Analysis of Output from a Computer Code. Technometrics, 1979.
    """

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""

        def hypercube(k: int) -> FloatArray:
            return latin_hypercube(k, space.dimension, rng)

        def uniform(k: int) -> FloatArray:
            return rng.random((k, space.dimension))

        return distinct(space, hypercube(n), n, hypercube if space.constraints else uniform, rng)


@dataclass(frozen=True, slots=True, kw_only=True)
class PriorLatinHypercube:
    """One random point in each of n slices of every axis that have the same prior mass.

    A latin hypercube mapped through the inverse distribution function of the prior on each axis. A joint prior counts
    by its marginals: it places the slices, and has no say in which slices of two axes go together. Repeated
    configurations of discrete parameters are replaced by draws from the prior.
    """

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""
        P = latin_hypercube(n, space.dimension, rng)
        X = np.column_stack([quantiles(prior, j, P[:, j]) for j in range(space.dimension)])
        return distinct(space, X, n, lambda k: prior.sample(k, rng), rng)


@dataclass(frozen=True, slots=True, kw_only=True)
class KLatinHypercube:
    """A latin hypercube of its own for each combination of categories, as HyperMapper has it.

    With m combinations each gets one of floor(n / m) points over the other parameters; the remaining points are
    random, in combinations drawn without repetition. The order is random too, so that a stopped run has seen all
    combinations alike. Without categorical parameters it is the plain latin hypercube.
    """

    def points(self, space: SearchSpace, prior: ProductPrior, n: int, rng: Rng) -> FloatArray:
        """Return n different points, shape (n, d)."""
        nominal = np.flatnonzero(~space.is_ordered)
        if not len(nominal):
            return LatinHypercube().points(space, prior, n, rng)
        counts = [int(space.parameters[j].n_levels or 1) for j in nominal]
        share, rest = divmod(n, math.prod(counts))
        X, levels = rng.random((rest, space.dimension)), _some(counts, rest, rng)
        if share:
            every = np.indices(counts).reshape(len(counts), -1).T  # (m, k)
            X = np.vstack([*(latin_hypercube(share, space.dimension, rng) for _ in every), X])
            levels = np.vstack([every.repeat(share, axis=0), levels])
        for j, chosen in zip(nominal, levels.T, strict=True):
            X[:, j] = space.parameters[j].codes_of_levels(chosen)
        return distinct(space, rng.permutation(X), n, lambda k: rng.random((k, space.dimension)), rng)


def _some(counts: list[int], n: int, rng: Rng) -> IntArray:
    """Return the levels of n random combinations, shape (n, k): different ones, unless there are too many to count."""
    m = math.prod(counts)
    if m > MANY:
        return np.column_stack([rng.integers(count, size=n) for count in counts])
    return np.column_stack(np.unravel_index(rng.choice(m, size=n, replace=False), counts))


def latin_hypercube(n: int, dimension: int, rng: Rng) -> FloatArray:
    """Return one random point in each of n equal slices of every axis of the unit cube, shape (n, dimension)."""
    slices = np.column_stack([rng.permutation(n) for _ in range(dimension)])
    return (slices + rng.random((n, dimension))) / n
