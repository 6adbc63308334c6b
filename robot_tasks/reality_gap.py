"""What a stand-in for the real robot does differently, unknown to whoever tunes it.

A stand-in is the simulation of a task with other physics, delays, and an operator with a finger on the stop button. It
is no measurement of a real robot: it lets one study how parameters, priors and methods carry over a gap.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields
from importlib import resources
from math import inf, isfinite
from typing import Any, Final

from robot_tasks.errors import GapError, UnknownNameError
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
    GapError
        If a number has no physical meaning, or the sensing delay is no multiple of a tick.
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
        for key in ("payload", "joint_damping", "joint_stiction", "command_delay", "sensing_delay"):
            value = getattr(self, key)
            if not 0.0 <= value < inf:
                raise GapError(key, f"{value:g} is out of range", "a finite number that is not negative")
        for key in ("friction", "force_limit"):
            if not getattr(self, key) > 0.0:
                raise GapError(key, f"{getattr(self, key):g} is out of range", "a positive number")
        if not isfinite(self.force_compensation):
            raise GapError("force_compensation", f"{self.force_compensation:g} is not finite", "a number of newtons")
        if abs(self.sensing_delay / TICK - self.ticks_of_sensing_delay) > 1e-9:
            raise GapError("sensing_delay", f"{self.sensing_delay:g} s", f"a multiple of a tick of {TICK:g} s")

    @property
    def ticks_of_sensing_delay(self) -> int:
        """The sensing delay in ticks."""
        return round(self.sensing_delay / TICK)

    def apply(self, specification: Any) -> None:  # mujoco.MjSpec, which has no type stubs
        """Change the physics of a scene that is not yet compiled.

        Raises
        ------
        GapError
            If the scene has no body of a name, or the command delay is no multiple of its physics step.
        """
        n_samples = self._steps_of_command_delay(specification.option.timestep)
        for geom in specification.geoms:
            geom.friction[0] *= self.friction
        for pair in specification.pairs:
            pair.friction[:2] *= self.friction
        for name in ARM_JOINTS:
            joint = specification.joint(name)
            joint.damping[0] += self.joint_damping
            joint.frictionloss = self.joint_stiction
        for name, offset in self.offsets.items():
            body = specification.body(name)
            if body is None:
                raise GapError("offsets", f"the scene has no body '{name}'", "names of its bodies")
            body.pos += offset
        self._load(specification.body(TOOL))
        for actuator in specification.actuators:
            actuator.nsample = n_samples
            actuator.delay = self.command_delay

    def _steps_of_command_delay(self, timestep: float) -> int:
        n_steps = round(self.command_delay / timestep)
        if abs(n_steps * timestep - self.command_delay) > 1e-9:
            step = f"a multiple of the physics step of {timestep:g} s"
            raise GapError("command_delay", f"{self.command_delay:g} s", step)
        return n_steps

    def _load(self, tool: Any) -> None:
        """Put the payload into the tool, of which gravity compensation goes on carrying only the nominal mass."""
        loaded = tool.mass + self.payload
        tool.gravcomp *= tool.mass / loaded
        tool.inertia *= loaded / tool.mass
        tool.mass = loaded


def read_gaps(tasks: Collection[str]) -> dict[str, RealityGap]:
    """Read the gap of each task that has one.

    Parameters
    ----------
    tasks
        Names of the tasks that exist.

    Raises
    ------
    UnknownNameError
        If the file names something else, or a number that a gap does not have.
    GapError
        If a number has no meaning.
    """
    gaps = json.loads((resources.files("robot_tasks") / FILE).read_text(encoding="utf-8"))
    return {task: _gap(task, values, tasks) for task, values in gaps.items()}


def _gap(task: str, values: Mapping[str, Any], tasks: Collection[str]) -> RealityGap:
    if task not in tasks:
        raise UnknownNameError(f"task in {FILE}", task, tasks)
    known = [field.name for field in fields(RealityGap)]
    for key in values:
        if key not in known:
            raise UnknownNameError(f"key of task '{task}' in {FILE}", key, known)
    offsets = {body: tuple(offset) for body, offset in values.get("offsets", {}).items()}
    return RealityGap(**{**values, "offsets": offsets})
