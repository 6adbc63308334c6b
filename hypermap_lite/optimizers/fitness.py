"""One number per evaluation for searches that follow a single trade-off: a scalarization with fixed weights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.scalarization.base import Normalization, Scalarization
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitness:
    """The scalarization of the objectives in units of the first evaluations; smaller is better."""

    scalarization: Scalarization
    weights: FloatArray
    """Shape (m,), summing to one."""

    n_reference: int
    """The first so many evaluations set zero and unit of each objective, so that later ones do not move them."""

    def __call__(self, Y: FloatArray) -> FloatArray:
        """Return the fitness of n evaluations, shape (n, m) to (n,); infinite where an objective is."""
        usable = np.asarray(np.isfinite(Y).all(axis=1))
        fitness = np.full(len(Y), np.inf)
        if usable.any():
            first = Y[: self.n_reference][usable[: self.n_reference]]
            first = first if len(first) else Y[usable]
            offset, extent = first.min(axis=0), np.ptp(first, axis=0)
            normalization = Normalization(offset=offset, scale=np.where(extent > 0, extent, 1.0))
            fitness[usable] = self.scalarization(normalization(Y[usable]), self.weights)
        return fitness


def normalized_weights(weights: Sequence[float] | None, n_objectives: int) -> FloatArray:
    """Return weights that sum to one, shape (m,); equal ones for None.

    Raises
    ------
    ScenarioError
        If there is not one for each objective.

    Examples
    --------
    >>> normalized_weights([1, 1, 2], 3)
    array([0.25, 0.25, 0.5 ])
    """
    if weights is None:
        return np.full(n_objectives, 1.0 / n_objectives)
    if len(weights) != n_objectives:
        problem = f"there are {len(weights)} weights for {n_objectives} objectives"
        raise ScenarioError("$.weights", problem, allowed="a number >= 0 for each objective, or null")
    numbers = np.array(weights, dtype=float)
    return np.asarray(numbers / numbers.sum())


def check_weights(weights: Sequence[float] | None) -> None:
    """Raise a `ScenarioError` if a weight is negative, or none is positive."""
    for i, weight in enumerate(weights or ()):
        if finite_number(weight, f"$.weights[{i}]", "the weight") < 0:
            raise ScenarioError(f"$.weights[{i}]", f"the weight is {weight}", allowed="a number >= 0")
    if weights is not None and not sum(weights) > 0:
        raise ScenarioError("$.weights", "no weight is positive", allowed="at least one weight > 0")
