"""The arm under impedance control, put at a pose, held there and pushed by hand."""

import mujoco
import numpy as np

from robot_tasks.control import ImpedanceController
from robot_tasks.geometry import Pose
from robot_tasks.names import N_JOINTS, TIP, TOOL
from robot_tasks.simulation import TICK, Simulation

START = (0.56, 0.08, -0.15, -1.72, 1.07, 1.41, -0.69)
"""Joint angles in [rad] with the tool 0.3 m above the block, from which every pose of these tests is near."""


class Arm:
    """The arm of a simulation, holding the pose at which it was put.

    Attributes
    ----------
    pose
        Reference of the controller; may be replaced.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.tip = simulation.site_position(TIP)
        self.pose = simulation.pose_of(TIP)
        self.controller = ImpedanceController(simulation)
        self._tool = simulation.id_of("body", TOOL)
        self._steps_per_tick = round(TICK / simulation.model.opt.timestep)

    def run(self, seconds: float, push=(0.0, 0.0, 0.0)):
        """Advance by a time in [s] under a force in [N] at the tip; return the tip's distance from its reference."""
        model, data = self.simulation.model, self.simulation.data
        for _ in range(round(seconds / TICK)):
            data.xfrc_applied[self._tool, :3] = push
            data.xfrc_applied[self._tool, 3:] = np.cross(self.tip - data.xipos[self._tool], push)
            self.controller.update(self.pose, TICK)
            mujoco.mj_step(model, data, self._steps_per_tick)
        mujoco.mj_kinematics(model, data)
        return self.tip - self.pose.position


def place_tip(simulation: Simulation, pose: Pose) -> None:
    """Put the tip at a pose by damped least squares, starting from `START`; the arm is at rest there."""
    simulation.place_arm(START)
    for _ in range(50):
        error = _error(simulation, pose)
        if np.linalg.norm(error) < 1e-10:
            return
        jacobian = tip_jacobian(simulation)
        step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-6 * np.eye(6), error)
        simulation.place_arm(simulation.data.qpos[:N_JOINTS] + step)
    raise AssertionError(f"the arm does not reach {pose}")


def tip_jacobian(simulation: Simulation):
    """Return the Jacobian of the tip with respect to the arm's joints, shape (6, 7): translation, then rotation."""
    jacobian = np.zeros((6, simulation.model.nv))
    site = simulation.id_of("site", TIP)
    mujoco.mj_jacSite(simulation.model, simulation.data, jacobian[:3], jacobian[3:], site)
    return jacobian[:, :N_JOINTS]


def _error(simulation: Simulation, pose: Pose):
    """Return translation and rotation vector that are left to a pose, shape (6,)."""
    present = simulation.pose_of(TIP)
    inverse, difference, rotation = np.empty(4), np.empty(4), np.empty(3)
    mujoco.mju_negQuat(inverse, np.array(present.quaternion))
    mujoco.mju_mulQuat(difference, np.array(pose.quaternion), inverse)
    mujoco.mju_quat2Vel(rotation, difference, 1.0)
    return np.concatenate([np.subtract(pose.position, present.position), rotation])
