"""What makes up a task."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Final

from robot_tasks.errors import ParameterError
from robot_tasks.randomization import Randomization
from robot_tasks.reality_gap import RealityGap
from robot_tasks.rewards import RewardTerm
from robot_tasks.skills import Behaviour
from robot_tasks.skills.conditions import Relation

NO_GAP: Final = RealityGap()


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """A number of a skill that is to be tuned."""

    name: str
    low: float
    """Smallest value allowed."""
    high: float
    """Largest value allowed."""
    unit: str
    """Unit, as in ``"m"``."""
    description: str
    """What the number means."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """A skill to tune in a scene, and what counts as doing it well."""

    name: str
    description: str
    scene: str
    """File name of the scene in the `models` folder."""
    duration: float
    """Length of an episode in [s]."""
    parameters: tuple[Parameter, ...]
    build_tree: Callable[[Mapping[str, float]], Behaviour]
    """Build the behaviour tree of the skill from checked parameters."""
    objectives: Mapping[str, tuple[RewardTerm, ...]]
    """Objectives, all to be maximized: each is the sum of its reward terms."""
    randomization: Randomization
    obstacle: str | None = None
    """Geom to which the clearance is measured, if any."""
    object_body: str | None = None
    """Free body whose pose is recorded, if any."""
    final_condition: Relation | None = None
    """What is to hold at the end: success is its holding from some time on. None: success is that of the skill."""
    gap: RealityGap = NO_GAP
    """What the stand-in for the real robot does differently; nothing in the task itself."""

    @property
    def terms(self) -> tuple[RewardTerm, ...]:
        """All reward terms, in the order of the objectives."""
        return tuple(term for terms in self.objectives.values() for term in terms)

    def check(self, configuration: Mapping[str, object]) -> dict[str, float]:
        """Return the configuration as floats, in the order of the task's parameters.

        Raises
        ------
        ParameterError
            If a parameter is missing, unknown, not a finite number, or out of its bounds.
        """
        names = [parameter.name for parameter in self.parameters]
        for name in configuration:
            if name not in names:
                raise ParameterError(self.name, name, "not a parameter of this task", f"only {', '.join(names)}")
        return {parameter.name: self._check_value(parameter, configuration) for parameter in self.parameters}

    def _check_value(self, parameter: Parameter, configuration: Mapping[str, object]) -> float:
        allowed = f"a number in [{parameter.low:g}, {parameter.high:g}] {parameter.unit}"
        if parameter.name not in configuration:
            raise ParameterError(self.name, parameter.name, "missing", allowed)
        given = configuration[parameter.name]
        try:
            value = float("nan") if isinstance(given, bool | str) else float(given)  # type: ignore[arg-type]  # tried
        except (TypeError, ValueError):
            value = float("nan")
        if not isfinite(value):
            raise ParameterError(self.name, parameter.name, f"{given!r} is not a finite number", allowed)
        if not parameter.low <= value <= parameter.high:
            raise ParameterError(self.name, parameter.name, f"{value:g} is out of bounds", allowed)
        return value
