"""What happened in one rollout, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]


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
    success_time: float | None = None
    """When the skill succeeded in [s]; None if it never did."""
    simulated_seconds: float
    """Time in [s] up to which physics ran."""
    clearance: float = float("inf")
    """Smallest distance of arm or tool to the obstacle in [m]; negative when they overlapped."""
    contact: ContactRecord = field(default_factory=ContactRecord)
    """Summary of unwanted contacts."""

    def __post_init__(self) -> None:
        n = len(self.times)
        for name, width in (("tip_positions", 3), ("reference_positions", 3), ("joint_positions", 7)):
            shape = getattr(self, name).shape
            if shape != (n, width):
                raise ValueError(f"Episode.{name}: expected shape {(n, width)} for {n} times, got {shape}")

    @property
    def is_success(self) -> bool:
        """Whether the skill ever succeeded."""
        return self.success_time is not None

    @property
    def n_steps(self) -> int:
        """Number of reward terms: one for each sample after the first."""
        return len(self.times) - 1
