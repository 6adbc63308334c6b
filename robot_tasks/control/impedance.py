"""Cartesian impedance control of the tool tip, computed by MuJoCo inside the physics step.

The scene's actuators hold a spring and a damper between tip and reference in world axes,

    force  = K (x_reference - x) - D v + feed-forward,      torque = k log(R_reference R^-1) - d omega,

so the control law runs at every physics step and is integrated implicitly. This class writes references, gains and
feed-forward forces once per tick, and adds a posture torque in the one direction of joint space that leaves the tip
where it is: the turning of the elbow about the line from shoulder to wrist.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin, sqrt
from typing import Final

from robot_tasks.control.ramp import Ramp
from robot_tasks.geometry import Pose, Quaternion, Stiffness, Vector
from robot_tasks.names import N_JOINTS, TIP
from robot_tasks.simulation import Simulation

STIFFNESS: Final[Stiffness] = (400.0, 400.0, 400.0, 50.0)
"""Stiffness at the start of an episode."""
LEAST_DAMPING: Final = 20.0
"""Damping in [Ns/m] of an axis whose stiffness is zero or small, for which 2 sqrt(K) would be none.

An axis under pure force control would otherwise be braked by the joints alone: it would hit the work piece at 0.3 m/s
under 3 N and at 0.7 m/s under 20 N. With it a force F lets the free arm settle at F / 20 m/s.
"""
STIFFNESS_RATE: Final = 500.0
"""Largest change of stiffness in [N/m] and [Nm/rad] per second."""
SPRING_FORCE: Final = 100.0
"""Largest force of the spring in [N]: a reference that asks for more is pulled in, to 0.25 m at 400 N/m.

An arm stuck at an obstacle while its reference moves on would otherwise be loaded until it buckles and whips free. In
free motion the lag stays below 0.08 m.
"""
FORCE_RATE: Final = 10.0
"""Largest change of the feed-forward force in [N/s]."""

POSTURE: Final = (0.2, 0.9, -0.25, -1.2, 1.2, 1.4, -1.0)
"""Joint angles in [rad] that the elbow leans towards: elbow up and to the side, all joints far from their limits."""
POSTURE_STIFFNESS: Final = 10.0
"""Stiffness of the posture in [Nm/rad]."""
POSTURE_DAMPING: Final = 4.0
"""Damping of the posture in [Nms/rad]."""

_AXES: Final = ("impedance_x", "impedance_y", "impedance_z")
_ROTATION: Final = "impedance_rotation"


class ImpedanceController:
    """Commands to the impedance actuators of a simulation.

    Make one per episode: gains and feed-forward start from the defaults and zero.

    Parameters
    ----------
    simulation
        Its scene must have the actuators of `models/robot.xml`, and its arm must stand where the episode starts.
    force_compensation
        Vertical force in [N] that is applied on top of every vertical feed-forward force but zero.
    """

    def __init__(self, simulation: Simulation, *, force_compensation: float = 0.0) -> None:
        self._model = simulation.model
        # Numbers are read and written one by one, which a memory view does twice as fast as an array.
        self._ctrl = memoryview(simulation.data.ctrl).cast("B").cast("d")
        self._applied = memoryview(simulation.data.qfrc_applied).cast("B").cast("d")
        self._qpos = simulation.data.qpos[:N_JOINTS]
        self._qvel = simulation.data.qvel[:N_JOINTS]
        self._tip = simulation.site_position(TIP)
        self._axis_ids = [simulation.id_of("actuator", name) for name in _AXES]
        self._rotation_id = simulation.id_of("actuator", _ROTATION)
        self._position: Vector | None = None
        self._quaternion: Quaternion | None = None
        self._stiffness = Ramp(STIFFNESS, rate=STIFFNESS_RATE)
        self._force = Ramp((0.0, 0.0, 0.0), rate=FORCE_RATE)
        self._force_compensation = force_compensation
        self._write_gains()
        self._write_reference(simulation.pose_of(TIP))
        simulation.hold_commands()

    @property
    def force(self) -> tuple[float, ...]:
        """The feed-forward force commanded at present along x, y, z in [N]."""
        return self._force.value

    @property
    def is_settled(self) -> bool:
        """Whether stiffness and force have reached what was asked for."""
        return self._stiffness.is_settled and self._force.is_settled

    def aim_stiffness(self, stiffness: Sequence[float]) -> None:
        """Ask for a stiffness along x, y, z in [N/m] and about every axis in [Nm/rad].

        Damping follows as 2 sqrt(K), along x, y, z at least `LEAST_DAMPING`.
        """
        if stiffness is not self._stiffness.target:
            self._stiffness.aim(stiffness)

    def aim_force(self, force: Sequence[float]) -> None:
        """Ask for a feed-forward force along x, y, z in world axes in [N]."""
        if force is not self._force.target:
            self._force.aim(force)

    def update(self, reference: Pose, seconds: float) -> None:
        """Write the commands of one tick that lasts a time in [s]."""
        self._write_reference(reference)
        if not self._stiffness.is_settled:
            self._stiffness.advance(seconds)
            self._write_gains()
        if not self._force.is_settled:
            self._force.advance(seconds)
            x, y, z = self._force.value
            self._ctrl[1], self._ctrl[3], self._ctrl[5] = x, y, z + self._force_compensation if z else z
        torque = self._applied
        torque[0], torque[1], torque[2], torque[3], torque[4], torque[5], torque[6] = posture_torque(
            self._qpos.tolist(), self._qvel.tolist()
        )

    def _write_reference(self, reference: Pose) -> None:
        ctrl = self._ctrl
        position = within_reach(reference.position, self._tip.tolist(), self._stiffness.value)
        if position != self._position:
            self._position = ctrl[0], ctrl[2], ctrl[4] = position
        if reference.quaternion is not self._quaternion:
            self._quaternion = ctrl[6], ctrl[7], ctrl[8], ctrl[9] = reference.quaternion

    def _write_gains(self) -> None:
        """Write stiffness and damping where MuJoCo's pid and orientation actuators keep them."""
        *axes, rotation = self._stiffness.value
        for index, k in zip(self._axis_ids, axes, strict=True):
            self._model.actuator_biasprm[index, 1:3] = -k, -max(2.0 * sqrt(k), LEAST_DAMPING)
        self._model.actuator_gainprm[self._rotation_id, 0] = rotation
        self._model.actuator_biasprm[self._rotation_id, 1:3] = -rotation, -2.0 * sqrt(rotation)


def within_reach(reference: Vector, tip: Sequence[float], stiffness: Sequence[float]) -> Vector:
    """Pull a reference position in [m] towards the tip until the spring between them gives at most `SPRING_FORCE`."""
    x, y, z = tip
    dx, dy, dz = reference[0] - x, reference[1] - y, reference[2] - z
    fx, fy, fz = stiffness[0] * dx, stiffness[1] * dy, stiffness[2] * dz
    squared_force = fx * fx + fy * fy + fz * fz
    if squared_force <= SPRING_FORCE * SPRING_FORCE:
        return reference
    scale = SPRING_FORCE / sqrt(squared_force)
    return x + scale * dx, y + scale * dy, z + scale * dz


def posture_torque(q: Sequence[float], v: Sequence[float]) -> tuple[float, ...]:
    """Compute the joint torques in [Nm] that turn the elbow towards `POSTURE` without a force at the tip.

    Parameters
    ----------
    q, v
        Joint angles in [rad] and velocities in [rad/s], 7 numbers each.
    """
    n1, n2, n3, _, n5, n6, n7 = self_motion(q)
    squared_length = n1 * n1 + n2 * n2 + n3 * n3 + n5 * n5 + n6 * n6 + n7 * n7
    if squared_length < 1e-12:
        return (0.0,) * N_JOINTS
    p1, p2, p3, _, p5, p6, p7 = POSTURE
    angle = n1 * (p1 - q[0]) + n2 * (p2 - q[1]) + n3 * (p3 - q[2])
    angle += n5 * (p5 - q[4]) + n6 * (p6 - q[5]) + n7 * (p7 - q[6])
    speed = n1 * v[0] + n2 * v[1] + n3 * v[2] + n5 * v[4] + n6 * v[5] + n7 * v[6]
    torque = (POSTURE_STIFFNESS * angle - POSTURE_DAMPING * speed) / squared_length
    return torque * n1, torque * n2, torque * n3, 0.0, torque * n5, torque * n6, torque * n7


def self_motion(q: Sequence[float]) -> tuple[float, ...]:
    """Find the joint velocities that leave the tool at rest, up to length.

    The arm is a spherical shoulder (joints 1-3), an elbow (4) and a spherical wrist (5-7) with equally long upper arm
    and forearm. It can turn about the line from shoulder to wrist, which encloses half the elbow angle with each of
    the two: the shoulder turns about this line, the wrist turns back, the elbow rests. The closed form costs a tenth
    of a singular value decomposition. It vanishes where the solution is not unique.

    Parameters
    ----------
    q
        Joint angles in [rad], 7 numbers.
    """
    s2, c2, s3, c3 = sin(q[1]), cos(q[1]), sin(q[2]), cos(q[2])
    s4, c4 = sin(0.5 * q[3]), cos(0.5 * q[3])
    s5, c5, s6, c6 = sin(q[4]), cos(q[4]), sin(q[5]), cos(q[5])
    s26 = s2 * s6
    shoulder, wrist = s4 * c3 * s6, s4 * c5 * s2
    return shoulder, -s4 * s3 * s26, c4 * s26 - shoulder * c2, 0.0, wrist * c6 - c4 * s26, s4 * s5 * s26, -wrist
