"""Motions that are added to the motion to a goal, such as a search around it."""

from __future__ import annotations

from typing import Protocol

from robot_tasks.geometry import Vector


class Overlay(Protocol):
    """An offset of the reference position as a function of time alone.

    Overlays are compared by value: one that equals the present one goes on, any other starts afresh.
    """

    @property
    def is_still(self) -> bool:
        """Whether the offset is zero at all times."""
        ...

    def offset(self, time: float) -> Vector:
        """Return the offset in world axes in [m] at a time in [s] since the overlay began, zero at time zero."""
        ...
