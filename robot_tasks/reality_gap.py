"""What a stand-in for the real robot does differently, unknown to whoever tunes it.

A stand-in is the simulation of a task with other physics, delays, and an operator with a finger on the stop button. It
is no measurement of a real robot: it lets one study how parameters, priors and methods carry over a gap.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from typing import Any, Final

from robot_tasks.geometry import Vector
from robot_tasks.names import ARM_JOINTS, TOOL
from robot_tasks.simulation import TICK

FILE: Final = "reality_gaps.json"
"""The gap of each task, beside this module."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RealityGap:
    """Differences between a task and its stand-in.

    Raises
    ------
    ValueError
        If a number has no physical meaning, or a sensing delay is no multiple of a tick.
    """

    friction: float = 1.0
    """Factor on all sliding friction."""
    payload: float = 0.0
    """Mass in [kg] in the tool that gravity compensation does not know of."""
    joint_damping: float = 0.0
    """Damping in [Nms/rad] of each joint on top of the model's."""
    joint_stiction: float = 0.0
    """Dry friction of each joint in [Nm]."""
    command_delay: float = 0.0
    """Seconds until a command, the reference and the feed-forward force, has an effect on the torques."""
    sensing_delay: float = 0.0
    """Age in [s] of the tip position on which the skill decides; a multiple of a tick."""
    offsets: Mapping[str, Vector] = field(default_factory=dict)
    """How far bodies stand from where calibration has them, in [m]."""
    force_compensation: float = 0.0
    """Force in [N] added to every vertical force that is not zero, without being counted as commanded."""
    force_limit: float = float("inf")
    """Contact force in [N], averaged over a tick, on tool or arm at which the operator stops the robot."""

    def __post_init__(self) -> None:
        numbers = (self.payload, self.joint_damping, self.joint_stiction, self.command_delay, self.sensing_delay)
        if min(*numbers) < 0.0 or self.friction <= 0.0 or self.force_limit <= 0.0:
            raise ValueError(f"{self}: friction and force_limit must be positive, the rest but offsets not negative")
        if abs(self.sensing_delay / TICK - self.ticks_of_sensing_delay) > 1e-9:
            raise ValueError(f"sensing_delay {self.sensing_delay:g} s is no multiple of a tick of {TICK:g} s")

    @property
    def ticks_of_sensing_delay(self) -> int:
        """The sensing delay in ticks."""
        return round(self.sensing_delay / TICK)

    def apply(self, specification: Any) -> None:  # mujoco.MjSpec, which has no type stubs
        """Change the physics of a scene that is not yet compiled."""
        for geom in specification.geoms:
            geom.friction[0] *= self.friction
        for pair in specification.pairs:
            pair.friction[:2] *= self.friction
        for name in ARM_JOINTS:
            joint = specification.joint(name)
            joint.damping[0] += self.joint_damping
            joint.frictionloss = self.joint_stiction
        for name, offset in self.offsets.items():
            specification.body(name).pos += offset
        self._load(specification.body(TOOL))
        for actuator in specification.actuators:
            actuator.nsample = round(self.command_delay / specification.option.timestep)
            actuator.delay = self.command_delay

    def _load(self, tool: Any) -> None:
        """Put the payload into the tool, of which gravity compensation goes on carrying only the nominal mass."""
        loaded = tool.mass + self.payload
        tool.gravcomp *= tool.mass / loaded
        tool.inertia *= loaded / tool.mass
        tool.mass = loaded


def read_gaps() -> dict[str, RealityGap]:
    """Read the gap of each task, by the task's name."""
    text = (resources.files("robot_tasks") / FILE).read_text(encoding="utf-8")
    return {
        task: RealityGap(**values | {"offsets": {body: tuple(offset) for body, offset in values["offsets"].items()}})
        for task, values in json.loads(text).items()
    }
