"""The life of a behaviour: started when first ticked, updated while it runs, ended once."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import Final

from robot_tasks.geometry import Pose, Vector


class Status(Enum):
    """What a behaviour last answered."""

    IDLE = "idle"
    """Never ticked, or preempted."""
    RUNNING = "running"
    SUCCESS = "success"
    FAILURE = "failure"


IDLE: Final = Status.IDLE
RUNNING: Final = Status.RUNNING
SUCCESS: Final = Status.SUCCESS
FAILURE: Final = Status.FAILURE
# Looking up a member in the enumeration costs as much as the rest of a leaf's tick.


@dataclass(slots=True, kw_only=True)
class SkillContext:
    """What behaviours read from the robot and what they ask of it."""

    tip: Vector
    """Measured position of the tool tip in world axes, in [m]."""
    goal: Pose
    """Pose to move to. It stays until a behaviour sets another."""


class Behaviour(ABC):
    """A node of a behaviour tree.

    Subclasses answer in `_update`; `_initialise` runs before the first update of each run and `_terminate` after the
    last, with SUCCESS, FAILURE or, if another branch took over, IDLE.
    """

    __slots__ = ("status",)

    def __init__(self) -> None:
        self.status = IDLE

    def tick(self, context: SkillContext) -> Status:
        """Advance by one tick, starting the behaviour if it is not running."""
        if self.status is not RUNNING:
            self._initialise(context)
        self.status = status = self._update(context)
        if status is not RUNNING:
            self._terminate(context, status)
        return status

    def halt(self, context: SkillContext) -> None:
        """Preempt the behaviour if it is running."""
        if self.status is RUNNING:
            self.status = IDLE
            self._terminate(context, IDLE)

    def _initialise(self, context: SkillContext) -> None:  # noqa: B027 - an optional hook
        """Prepare a run."""

    @abstractmethod
    def _update(self, context: SkillContext) -> Status:
        """Do one tick's work and answer RUNNING, SUCCESS or FAILURE."""

    def _terminate(self, context: SkillContext, status: Status) -> None:  # noqa: B027 - an optional hook
        """Clean up after a run that ended with `status`."""


class Condition(Behaviour):
    """A question that is answered at once: it never runs, so there is nothing to start, halt or end."""

    __slots__ = ()

    def tick(self, context: SkillContext) -> Status:
        """Answer SUCCESS or FAILURE."""
        self.status = status = self._update(context)
        return status
