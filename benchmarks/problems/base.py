"""What a benchmark problem is: a function with a known answer, its box, and how long an optimizer may take."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

SPREAD_POINTS = 2**14
"""Points over which the standard deviation of an objective is taken: scrambled Sobol, seed 0."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One or several functions to minimize over a box, without noise of their own.

    Points are rows of numbers: native values, but of categorical parameters their positions in the list of values.
    """

    function: Callable[[FloatArray], FloatArray]
    """Objective values, shape (n, m), of points, shape (n, d)."""

    parameters: Mapping[str, Mapping[str, Any]]
    """As in the scenario's ``input_parameters``; real, integer, ordinal and categorical ones."""

    best: float
    """The smallest value, or the hypervolume of the whole front."""

    reference_point: tuple[float, ...] | None = None
    """From which the hypervolume counts, shape (m,); None for one objective."""

    is_feasible: Callable[[FloatArray], BoolArray] | None = None
    """Whether points are allowed, shape (n,), which an optimizer learns only by evaluating; None if all are."""

    noise: float = 0.0
    """Standard deviation of the observations, as a share of that of the objective over the box."""

    failures: float = 0.0
    """Share of the evaluations that fail for no reason of their parameters: they come out as bad as `worst`."""

    evaluations: int = 60

    @property
    def dimension(self) -> int:
        """Number of parameters."""
        return len(self.parameters)

    @property
    def design(self) -> int:
        """Number of evaluations before there is a model."""
        return 2 * (self.dimension + 1)

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the objectives."""
        return tuple(f"f{k + 1}" for k in range(len(self.reference_point or (0.0,))))

    @cached_property
    def noise_sd(self) -> FloatArray:
        """Standard deviation of the observations, shape (m,), in the objectives' own units.

        `noise` times the standard deviation (ddof 0) of the noise-free values at `SPREAD_POINTS` points of a scrambled
        Sobol sequence over the box, feasible or not.
        """
        if not self.noise:
            return np.zeros(len(self.objectives))
        return np.asarray(self.noise * self._spread().std(axis=0))

    @cached_property
    def worst(self) -> FloatArray:
        """Largest value of each objective, shape (m,), at the same points."""
        return np.asarray(self._spread().max(axis=0))

    def _spread(self) -> FloatArray:
        U = qmc.Sobol(self.dimension, rng=np.random.default_rng(0)).random(SPREAD_POINTS)
        return self.function(self.points(U))

    def points(self, U: FloatArray) -> FloatArray:
        """Return the points at places in the unit cube, shape (n, d); levels of a category get equal shares."""
        columns = [_scaled(U[:, j], parameter) for j, parameter in enumerate(self.parameters.values())]
        return np.column_stack(columns)

    def configurations(self, X: FloatArray) -> list[dict[str, Any]]:
        """Return points as mappings from names to native values."""
        return [
            {name: _native(x, parameter) for (name, parameter), x in zip(self.parameters.items(), row, strict=True)}
            for row in X
        ]

    def evaluate(self, configuration: Mapping[str, Any]) -> tuple[FloatArray, bool]:
        """Return the noise-free objectives, shape (m,), of a configuration, and whether it is allowed."""
        row = [
            parameter["values"].index(configuration[name])
            if parameter["parameter_type"] == "categorical"
            else configuration[name]
            for name, parameter in self.parameters.items()
        ]
        X = np.array([row], dtype=float)
        return self.function(X)[0], self.is_feasible is None or bool(self.is_feasible(X)[0])


def real_parameters(bounds: Sequence[tuple[float, float]]) -> dict[str, dict[str, Any]]:
    """Return real parameters x1, x2, ... with these bounds."""
    return {f"x{j + 1}": {"parameter_type": "real", "values": list(pair)} for j, pair in enumerate(bounds)}


def one_objective(function: Callable[[FloatArray], FloatArray]) -> Callable[[FloatArray], FloatArray]:
    """Turn a function with values of shape (n,) into one with values of shape (n, 1)."""
    return lambda X: function(X)[:, None]


def _scaled(u: FloatArray, parameter: Mapping[str, Any]) -> FloatArray:
    values = parameter["values"]
    match parameter["parameter_type"]:
        case "categorical":
            return _level(u, len(values))
        case "ordinal":
            return np.array(values, dtype=float)[_level(u, len(values)).astype(int)]
        case "integer":
            return values[0] + _level(u, values[1] - values[0] + 1)
    return values[0] + u * (values[1] - values[0])


def _level(u: FloatArray, n: int) -> FloatArray:
    return np.minimum(np.floor(u * n), n - 1)


def _native(x: float, parameter: Mapping[str, Any]) -> Any:
    match parameter["parameter_type"]:
        case "categorical":
            return parameter["values"][int(x)]
        case "integer":
            return int(x)
    return float(x)
