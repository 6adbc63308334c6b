"""Weights on the levels of an ordinal or categorical parameter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hypermap_lite.errors import ScenarioError, finite_number
from hypermap_lite.priors.base import Axis, Density, Histogram


@dataclass(frozen=True, slots=True, kw_only=True)
class WeightsPrior:
    """One weight per level, in the order in which the scenario lists the levels; they need not sum to one."""

    weights: Sequence[float]

    def __post_init__(self) -> None:
        for i, weight in enumerate(self.weights):
            if finite_number(weight, f"$.weights[{i}]", "the weight") < 0:
                raise ScenarioError(f"$.weights[{i}]", f"the weight is {weight}", allowed="a number >= 0")
        if not sum(self.weights) > 0:
            raise ScenarioError("$.weights", "all weights are zero", allowed="at least one weight > 0")

    def on(self, axis: Axis) -> Density:
        """Place it on a parameter's axis.

        Raises
        ------
        ScenarioError
            If the parameter is continuous or has another number of levels.
        """
        if axis.n_levels is None:
            raise ScenarioError(
                "$", f"'{axis.name}' has no levels to put weights on", hint="Give it a gaussian or beta prior."
            )
        if len(self.weights) != axis.n_levels:
            problem = f"{len(self.weights)} weights for the {axis.n_levels} levels of '{axis.name}'"
            raise ScenarioError("$.weights", problem, allowed=f"{axis.n_levels} numbers >= 0")
        masses = np.asarray(self.weights, dtype=float)
        return Histogram(axis.bin_edges(), masses / masses.sum())
