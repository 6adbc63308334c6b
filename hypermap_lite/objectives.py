"""What the black box answers: objectives, with the one place where a direction flips a sign, and the feasibility."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from hypermap_lite.errors import ScenarioError
from hypermap_lite.typing import FloatArray

MAX_CLOSED_FORM = 3
"""Objectives for which the expected growth of the hypervolume is taken in closed form; more make too many cells."""


class Goal(Enum):
    """Whether small or large values of an objective are wanted."""

    MINIMIZE = "minimize"
    MAXIMIZE = "maximize"


@dataclass(frozen=True, slots=True, kw_only=True)
class Objective:
    """One quantity to optimize, in the user's own units and direction."""

    name: str
    """Key under which an evaluation returns it; also its column in the history."""

    goal: Goal = Goal.MINIMIZE
    """Direction in which it is better."""

    reference_point: float | None = None
    """Worst value that still counts for the hypervolume, in the user's units and direction."""

    @property
    def sign(self) -> float:
        """Factor that turns a value into one to be minimized: 1.0 or -1.0."""
        return 1.0 if self.goal is Goal.MINIMIZE else -1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibleOutput:
    """What the black box says of whether a configuration is allowed, and how the files say it."""

    name: str = "Valid"
    """Key under which an evaluation returns it; also its column in the files."""

    true_value: str = "True"
    """Text for a feasible configuration."""

    false_value: str = "False"
    """Text for an infeasible one."""

    def __post_init__(self) -> None:
        if self.true_value == self.false_value:
            problem = f"feasible and infeasible are both called {self.true_value!r}"
            raise ScenarioError("$.false_value", problem, allowed="two different texts")

    def text(self, is_feasible: bool | None) -> str:
        """Return what stands in the column; nothing where it is not known."""
        return "" if is_feasible is None else self.true_value if is_feasible else self.false_value

    def verdict(self, answer: object, number: float | None) -> bool | None:
        """Return whether an answer, and the number it may be, says feasible; None if it says neither."""
        if isinstance(answer, str):
            return {self.true_value: True, self.false_value: False}.get(answer)
        return bool(number) if number in (0.0, 1.0) else None


def to_minimization(objectives: Sequence[Objective], values: FloatArray) -> FloatArray:
    """Turn values as the user directed them, shape (n, m), into values to be minimized; its own inverse."""
    return values * np.array([objective.sign for objective in objectives])


def values_of(objectives: Sequence[Objective], outcome: Mapping[str, float]) -> FloatArray:
    """Return one outcome's objective values to be minimized, shape (m,)."""
    return np.array([objective.sign * outcome[objective.name] for objective in objectives])


def reference_point_of(objectives: Sequence[Objective]) -> FloatArray | None:
    """Return the reference point to be minimized against, shape (m,), or None if an objective lacks one."""
    points = [o.sign * o.reference_point for o in objectives if o.reference_point is not None]
    return np.array(points) if len(points) == len(objectives) else None


def stated_or(objectives: Sequence[Objective], inferred: FloatArray) -> FloatArray:
    """Return the reference point to be minimized against, shape (m,): inferred where an objective states none."""
    stated = [np.nan if o.reference_point is None else o.sign * o.reference_point for o in objectives]
    return np.where(np.isnan(stated), inferred, stated)
