"""The life of a behaviour: started when first ticked, updated while it runs, ended once."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import Final, Protocol

from robot_tasks.geometry import Pose, Stiffness, Vector
from robot_tasks.motion.overlay import Overlay


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


DEFAULT_STIFFNESS: Final[Stiffness] = (400.0, 400.0, 400.0, 50.0)
"""Stiffness while no behaviour asks for another."""
NO_FORCE: Final[Vector] = (0.0, 0.0, 0.0)


class World(Protocol):
    """Where things are, as far as the robot can tell."""

    def pose_of(self, name: str) -> Pose:
        """Return the measured pose of a body or site of the scene."""
        ...


@dataclass(slots=True, kw_only=True)
class SkillContext:
    """What behaviours read from the robot and what they ask of it.

    A demand for stiffness, force or overlay lasts for one tick: a behaviour that runs repeats it at every tick, and
    one that was halted asks for nothing more.
    """

    tip: Vector
    """Measured position of the tool tip in world axes, in [m]."""
    world: World
    """Measured poses of everything else."""
    goal: Pose
    """Pose to move to. It stays until a behaviour sets another."""
    stiffness: Stiffness = DEFAULT_STIFFNESS
    """Stiffness wanted."""
    force: Vector = NO_FORCE
    """Force wanted on top of the spring, in world axes in [N]."""
    overlay: Overlay | None = None
    """Motion wanted on top of the motion to the goal."""

    def forget_demands(self) -> None:
        """Return to the default stiffness, no force and no overlay; the goal stays."""
        self.stiffness = DEFAULT_STIFFNESS
        self.force = NO_FORCE
        self.overlay = None


class Behaviour(ABC):
    """A node of a behaviour tree.

    Subclasses answer in `_update`; `_initialise` runs before the first update of each run and `_terminate` after the
    last, with SUCCESS, FAILURE or, if another branch took over, IDLE.
    """

    __slots__ = ("status",)

    def __init__(self) -> None:
        self.status = IDLE

    @property
    def children(self) -> tuple[Behaviour, ...]:
        """The nodes below this one; leaves have none."""
        return ()

    @property
    def label(self) -> str:
        """What the node is, in a drawing of the tree."""
        return type(self).__name__

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
