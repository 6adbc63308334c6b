"""Skills: behaviour trees that say what they are told, what they need, and what they bring about."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from robot_tasks.skills.behaviour import FAILURE, SUCCESS, Behaviour, SkillContext, Status
from robot_tasks.skills.conditions import Relation, first_violated


class ParameterKind(Enum):
    """Where the value of a skill's parameter comes from."""

    LEARNED = "learned"
    """To be tuned: a plan leaves it open."""
    REQUIRED = "required"
    """Given by the plan, such as the goal."""
    OPTIONAL = "optional"
    """Has a default in the skill."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SkillParameter:
    """One thing a skill must be told."""

    name: str
    kind: ParameterKind
    value_type: type
    """Type of the value."""
    unit: str = ""
    """Unit of a number, as in ``"m"``."""
    description: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SkillDescription:
    """What a planner needs to know of a skill, in the terms of SkiROS2."""

    name: str
    description: str
    parameters: tuple[SkillParameter, ...]
    preconditions: tuple[Relation, ...] = ()
    """Must hold when the skill starts."""
    holdconditions: tuple[Relation, ...] = ()
    """Must hold at every tick while it runs."""
    postconditions: tuple[Relation, ...] = ()
    """Must hold when it succeeds."""


class Skill(Behaviour):
    """A behaviour tree with a description whose conditions are checked while it runs.

    It fails where a condition does not hold: a precondition when it starts, a hold condition at any tick, a
    postcondition when its tree succeeds.

    Parameters
    ----------
    description
        Parameters and conditions.
    body
        The tree that does the work.

    Attributes
    ----------
    violated
        The condition that made it fail, if one did.
    """

    __slots__ = ("_body", "_holdconditions", "_is_fresh", "description", "violated")

    def __init__(self, description: SkillDescription, body: Behaviour) -> None:
        super().__init__()
        self.description = description
        self.violated: Relation | None = None
        self._holdconditions = description.holdconditions
        self._body = body
        self._is_fresh = True

    @property
    def children(self) -> tuple[Behaviour, ...]:
        """The tree that does the work."""
        return (self._body,)

    @property
    def label(self) -> str:
        """Name of the skill."""
        return f"Skill {self.description.name}"

    def _initialise(self, context: SkillContext) -> None:
        self._is_fresh = True
        self.violated = None

    def _update(self, context: SkillContext) -> Status:
        if self._is_fresh:
            self._is_fresh = False
            if self._is_violated(self.description.preconditions, context):
                return FAILURE
        if self._holdconditions and self._is_violated(self._holdconditions, context):
            return FAILURE
        status = self._body.tick(context)
        if status is SUCCESS and self._is_violated(self.description.postconditions, context):
            return FAILURE
        return status

    def _terminate(self, context: SkillContext, status: Status) -> None:
        self._body.halt(context)

    def _is_violated(self, relations: tuple[Relation, ...], context: SkillContext) -> bool:
        self.violated = first_violated(relations, context.world)
        return self.violated is not None
