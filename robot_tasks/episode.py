"""What happened in one rollout, as plain arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from robot_tasks.geometry import Vector

FloatArray: TypeAlias = NDArray[np.float64]

_WIDTHS: Final = {
    "tip_positions": 3,
    "reference_positions": 3,
    "joint_positions": 7,
    "commanded_forces": 3,
    "object_poses": 7,
}


_IN_PLACE: Final[Vector] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactRecord:
    """Contacts of arm or tool with bodies that must not be touched."""

    touches: int = 0
    """Distinct touches: contact after at least 0.1 s without one."""
    seconds: float = 0.0
    """Time in contact in [s]."""
    peak_force: float = 0.0
    """Largest normal force of a single contact in [N]."""
    deepest_penetration: float = 0.0
    """Largest overlap in [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceRecord:
    """The net contact force on the tool over an episode, measured at every physics step."""

    peak: float = 0.0
    """Largest magnitude in [N]."""
    impulse: float = 0.0
    """Integral of the magnitude over time in [Ns]."""
    seconds: float = 0.0
    """Time during which there was a force in [s]."""

    @property
    def mean(self) -> float:
        """Mean magnitude in [N] while there was a force; 0 if there never was one."""
        return self.impulse / self.seconds if self.seconds else 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Episode:
    """Samples of a rollout on a regular grid from time 0 to its full length, both ends included.

    A rollout that ended early because nothing could move any more is filled with copies of its last sample, so the
    arrays always have the full length n.
    """

    times: FloatArray
    """Sample times in [s], shape (n,)."""
    tip_positions: FloatArray
    """World position of the tool tip in [m], shape (n, 3)."""
    reference_positions: FloatArray
    """World position of the controller's reference in [m], shape (n, 3)."""
    joint_positions: FloatArray
    """Joint angles in [rad], shape (n, 7)."""
    commanded_forces: FloatArray
    """Feed-forward force that was commanded on top of the spring, in world axes in [N], shape (n, 3)."""
    object_poses: FloatArray | None = None
    """Pose x y z in [m] and quaternion w x y z of the task's object, shape (n, 7); None if it has none."""
    shifts: Mapping[str, Vector] = field(default_factory=dict)
    """How far the circumstances of the rollout moved bodies from their nominal places, in [m]."""
    success_time: float | None = None
    """When the task was achieved in [s]; None if it never was."""
    simulated_seconds: float
    """Time in [s] up to which physics ran."""
    clearance: float = float("inf")
    """Smallest distance of arm or tool to the obstacle in [m]; negative when they overlapped."""
    contact: ContactRecord = field(default_factory=ContactRecord)
    """Summary of unwanted contacts."""
    tool_contact: ForceRecord = field(default_factory=ForceRecord)
    """Summary of the contact force on the tool, wanted or not."""
    interventions: int = 0
    """How often an operator stopped the robot."""

    def __post_init__(self) -> None:
        n = len(self.times)
        for name, width in _WIDTHS.items():
            array = getattr(self, name)
            shape = (n, width) if array is None else array.shape
            if shape != (n, width):
                raise ValueError(f"Episode.{name}: expected shape {(n, width)} for {n} times, got {shape}")

    def shift_of(self, body: str | None) -> Vector:
        """Return how far a body stood from its nominal place in [m]; zero for None and for bodies in their places."""
        return self.shifts.get(body, _IN_PLACE) if body else _IN_PLACE

    def tips_seen_from(self, body: str | None) -> FloatArray:
        """Return where the tip would be at the end of each step if the body stood in its place, shape (n_steps, 3)."""
        return self.tip_positions[1:] - np.asarray(self.shift_of(body))

    @property
    def object_track(self) -> FloatArray:
        """Pose of the task's object at each sample, shape (n, 7); a task without an object has none to ask for."""
        assert self.object_poses is not None, "the task has no object"
        return self.object_poses

    @property
    def is_success(self) -> bool:
        """Whether the task was achieved."""
        return self.success_time is not None

    @property
    def n_steps(self) -> int:
        """Number of reward terms: one for each sample after the first."""
        return len(self.times) - 1
