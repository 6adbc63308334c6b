"""Inner nodes of a behaviour tree, with the semantics of SkiROS2's processors.

Children are ticked in order. The plain kinds decide afresh at every tick and restart children that had finished; the
starred kinds remember, for one run, which children are done.
"""

from __future__ import annotations

from typing import ClassVar

from robot_tasks.skills.behaviour import FAILURE, RUNNING, SUCCESS, Behaviour, SkillContext, Status


class Composite(Behaviour):
    """A node with children, all of which are halted when it ends.

    Parameters
    ----------
    children
        At least one behaviour, in the order in which they are ticked.
    """

    __slots__ = ("_children",)

    def __init__(self, *children: Behaviour) -> None:
        super().__init__()
        if not children:
            raise ValueError(f"{type(self).__name__} needs at least one child, got none")
        self._children = children

    @property
    def children(self) -> tuple[Behaviour, ...]:
        """The nodes below this one, in the order in which they are ticked."""
        return self._children

    def _terminate(self, context: SkillContext, status: Status) -> None:
        for child in self._children:
            child.halt(context)


class _OneAtATime(Composite):
    """Children of which one runs at most: the one that ran before is halted when another takes over."""

    __slots__ = ("_running",)

    def __init__(self, *children: Behaviour) -> None:
        super().__init__(*children)
        self._running: Behaviour | None = None

    def _run(self, child: Behaviour | None, context: SkillContext) -> None:
        if child is not self._running:
            if self._running is not None:
                self._running.halt(context)
            self._running = child

    def _terminate(self, context: SkillContext, status: Status) -> None:
        self._run(None, context)


class Serial(_OneAtATime):
    """Succeed once all children succeed in one tick; the first that does not, decides, and later ones are halted."""

    __slots__ = ()

    def _update(self, context: SkillContext) -> Status:
        for child in self._children:
            status = child.tick(context)
            if status is not SUCCESS:
                if status is RUNNING:
                    self._run(child, context)
                return status
        return SUCCESS


class _Starred(Composite):
    """Tick children one after the other, each until it ends with the status that passes on to the next."""

    __slots__ = ("_current",)
    _passes_on: ClassVar[Status]

    def _initialise(self, context: SkillContext) -> None:
        self._current = 0

    def _update(self, context: SkillContext) -> Status:
        while self._current < len(self._children):
            status = self._children[self._current].tick(context)
            if status is not self._passes_on:
                return status
            self._current += 1
        return self._passes_on


class SerialStar(_Starred):
    """Tick children one after the other, each until it succeeds; a failure ends the sequence."""

    __slots__ = ()
    _passes_on = SUCCESS


class Selector(_OneAtATime):
    """Follow the first child that runs or succeeds and halt later ones; fail if every child fails."""

    __slots__ = ()

    def _update(self, context: SkillContext) -> Status:
        for child in self._children:
            status = child.tick(context)
            if status is not FAILURE:
                if status is RUNNING:
                    self._run(child, context)
                return status
        return FAILURE


class SelectorStar(_Starred):
    """Try children one after the other, each until it fails; a success ends the search."""

    __slots__ = ()
    _passes_on = FAILURE


class ParallelFs(Composite):
    """Run all children; the first to finish, by success or failure, decides, and those after it are not ticked."""

    __slots__ = ()

    def _update(self, context: SkillContext) -> Status:
        for child in self._children:
            status = child.tick(context)
            if status is not RUNNING:
                return status
        return RUNNING


class ParallelFf(Composite):
    """Run all children until each has succeeded once; the first failure stops all."""

    __slots__ = ("_waiting",)

    def _initialise(self, context: SkillContext) -> None:
        self._waiting = list(self._children)

    def _update(self, context: SkillContext) -> Status:
        still_running = []
        for child in self._waiting:
            status = child.tick(context)
            if status is FAILURE:
                return status
            if status is RUNNING:
                still_running.append(child)
        self._waiting = still_running
        return RUNNING if still_running else SUCCESS


class NoFail(Composite):
    """Turn the failure of a child into success."""

    __slots__ = ()

    def __init__(self, child: Behaviour) -> None:
        super().__init__(child)

    def _update(self, context: SkillContext) -> Status:
        status = self._children[0].tick(context)
        return SUCCESS if status is FAILURE else status
