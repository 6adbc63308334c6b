"""The robot tasks as cheap problems: interpolated between thousands of their rollouts.

An evaluation takes less than a millisecond instead of half a second, so methods can be compared on landscapes of skills
over many seeds [1]_. Most of the rollouts are where optimizers searched, so elsewhere cliffs are blurred more; what is
found here must still hold for the rollouts.

References
----------
.. [1] Eggensperger, Hutter, Hoos, Leyton-Brown. Efficient Benchmarking of Hyperparameter Optimizers via Surrogates.
   AAAI 2015.
"""

from __future__ import annotations

import functools
import gzip
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from .base import FloatArray, Problem

ROLLOUTS = Path(__file__).parent / "rollouts"
TASKS = ("peg_insertion", "object_pushing", "obstacle_avoidance")

NEIGHBOURS = 10
"""Evaluations that a value is a mean over."""


@dataclass(frozen=True)
class Landscape:
    """A local mean over evaluations: that of the nearest ones, weighted by the tricube of their distances [1]_.

    Distances are those in the unit cube, relative to that of the nearest evaluation that does not count any more.

    References
    ----------
    .. [1] Cleveland. Robust Locally Weighted Regression and Smoothing Scatterplots. JASA, 1979.
    """

    X: FloatArray
    """Places of the evaluations in the unit cube, shape (n, d)."""

    Y: FloatArray
    """Their objectives, all to be small, shape (n, m)."""

    low: FloatArray
    """Lower bounds of the parameters, shape (d,)."""

    width: FloatArray
    """Upper minus lower bounds, shape (d,)."""

    @classmethod
    def of(cls, task: str, parameters: Mapping[str, Mapping[str, Any]]) -> Landscape:
        """Read the evaluations of a task whose parameters have these bounds."""
        with gzip.open(ROLLOUTS / f"{task}.csv.gz", "rt", encoding="utf-8") as file:
            table = np.loadtxt(file, delimiter=",", skiprows=1)
        low, high = np.array([parameter["values"] for parameter in parameters.values()], dtype=float).T
        d = len(low)
        return cls(X=(table[:, :d] - low) / (high - low), Y=table[:, d:], low=low, width=high - low)

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self.X)

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return the objectives at points in the parameters' units, shape (n, d) to (n, m)."""
        return self._mean(*self._tree.query((points - self.low) / self.width, NEIGHBOURS + 1))

    def values_at_rows(self) -> FloatArray:
        """Return the objectives at the places of the evaluations, shape (n, m)."""
        return self(self.low + self.X * self.width)

    def r2(self) -> FloatArray:
        """Return the share of each objective's variance that the others tell of an evaluation, shape (m,)."""
        distances, rows = self._tree.query(self.X, NEIGHBOURS + 2)
        error = self._mean(distances[:, 1:], rows[:, 1:]) - self.Y
        share: FloatArray = 1 - (error**2).mean(axis=0) / self.Y.var(axis=0)
        return share

    def _mean(self, distances: FloatArray, rows: Any) -> FloatArray:
        """Return weighted means, shape (n, m), over all but the farthest of the rows, shape (n, k + 1)."""
        farthest = np.maximum(distances[:, -1:], np.finfo(float).tiny)
        weights = (1 - np.minimum(distances[:, :-1] / farthest, 1) ** 3) ** 3 + 1e-9
        weights /= weights.sum(axis=1, keepdims=True)
        mean: FloatArray = np.einsum("nk,nkm->nm", weights, self.Y[rows[:, :-1]])
        return mean


@dataclass(frozen=True, kw_only=True)
class EmulatedTask(Problem):
    """A problem whose noise is that of the mean over the task's replicates."""

    errors: tuple[float, ...]
    """Median standard error of an evaluation, shape (m,), in the objectives' own units."""

    @property
    def noise_sd(self) -> FloatArray:  # type: ignore[override]
        """Standard deviation of the observations, shape (m,)."""
        return np.array(self.errors)


def emulated(task: str, about: Mapping[str, Any]) -> EmulatedTask:
    """Return the problem of a task; its table is read when it is first evaluated."""
    objectives = about["objectives"]
    return EmulatedTask(
        function=functools.partial(_values, task),
        parameters=about["parameters"],
        reference_point=tuple(objective["reference_point"] for objective in objectives),
        best=about["best"],
        errors=tuple(objective["noise_sd"] for objective in objectives),
    )


def _values(task: str, points: FloatArray) -> FloatArray:
    return _landscape(task)(points)


@functools.cache
def _landscape(task: str) -> Landscape:
    return Landscape.of(task, _described()[task]["parameters"])


def _described() -> Mapping[str, Any]:
    file = ROLLOUTS / "tasks.json"
    found: Mapping[str, Any] = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    return found


EMULATED: Mapping[str, EmulatedTask] = {f"{task}_emulated": emulated(task, of) for task, of in _described().items()}
