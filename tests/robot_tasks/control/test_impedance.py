"""Tests for impedance.py: the arm as a spring, in free space."""

import mujoco
import numpy as np
import pytest

from robot_tasks.control.impedance import POSTURE, ImpedanceController, posture_torque, self_motion, within_reach
from robot_tasks.geometry import Pose

START = (0.56, 0.08, -0.15, -1.72, 1.07, 1.41, -0.69)
TICK = 0.02


class Arm:
    """The arm holding its start pose, with a push at the tip."""

    def __init__(self, simulation):
        simulation.reset()
        simulation.place_arm(START)
        self.simulation = simulation
        self.tip = simulation.site_position("tool_tip")
        self.pose = Pose(tuple(self.tip.tolist()), simulation.site_quaternion("tool_tip"))
        self.controller = ImpedanceController(simulation)
        self.tool = simulation.id_of("body", "tool_body")

    def run(self, seconds, push=(0.0, 0.0, 0.0)):
        model, data = self.simulation.model, self.simulation.data
        for _ in range(round(seconds / TICK)):
            data.xfrc_applied[self.tool, :3] = push
            data.xfrc_applied[self.tool, 3:] = np.cross(self.tip - data.xipos[self.tool], push)
            self.controller.update(self.pose, TICK)
            mujoco.mj_step(model, data, 10)
        mujoco.mj_kinematics(model, data)
        return self.tip - self.pose.position


@pytest.fixture
def arm(simulation):
    return Arm(simulation)


@pytest.mark.parametrize("push", [(10.0, 0.0, 0.0), (0.0, -10.0, 0.0), (0.0, 0.0, 10.0), (4.0, 5.0, 6.0)])
def test_a_push_deflects_the_tip_by_force_over_stiffness(arm, push):
    assert arm.run(4.0, push) == pytest.approx(np.divide(push, 400.0), abs=5e-5)


def test_a_stiffer_spring_deflects_less_after_its_ramp(arm):
    arm.controller.aim_stiffness((800.0, 800.0, 800.0, 50.0))
    arm.run(0.78)
    assert not arm.controller.is_settled
    arm.run(0.04)
    assert arm.controller.is_settled
    assert arm.run(4.0, (10.0, 0.0, 0.0)) == pytest.approx([10.0 / 800.0, 0.0, 0.0], abs=5e-5)


def test_a_feed_forward_force_ramps_up_and_pushes_like_a_hand(arm):
    arm.controller.aim_force((0.0, 0.0, -8.0))
    arm.run(0.4)
    assert arm.simulation.data.ctrl[5] == pytest.approx(-4.0)
    assert arm.run(4.0) == pytest.approx([0.0, 0.0, -8.0 / 400.0], abs=5e-5)


def test_the_tip_does_not_drift_while_the_elbow_moves_to_its_posture(arm):
    before = arm.simulation.data.qpos[2]
    assert arm.run(6.0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-5)
    assert abs(arm.simulation.data.qpos[2] - before) > 0.01


def test_the_tip_keeps_its_orientation_under_a_push(arm):
    arm.run(4.0, (10.0, 10.0, 0.0))
    quaternion = arm.simulation.site_quaternion("tool_tip")
    assert abs(np.dot(quaternion, arm.pose.quaternion)) == pytest.approx(1.0, abs=1e-6)


def test_a_step_of_the_reference_settles_without_a_limit_cycle(arm):
    x, y, z = arm.pose.position
    arm.pose = Pose((x + 0.05, y, z + 0.05), arm.pose.quaternion)
    arm.run(8.0)
    assert np.abs(arm.simulation.data.qvel).max() < 1e-4


def test_joint_torques_stay_within_the_effort_limits(arm):
    arm.pose = Pose((-1.5, 1.5, 1.5), arm.pose.quaternion)
    limits = arm.simulation.model.jnt_actfrcrange[:, 1]
    for _ in range(50):
        arm.run(TICK)
        assert (np.abs(arm.simulation.data.qfrc_actuator) <= limits + 1e-9).all()


def test_a_far_reference_pulls_with_no_more_than_100_newton(arm):
    arm.pose = Pose((-1.5, 1.5, 1.5), arm.pose.quaternion)
    for _ in range(20):
        before = arm.tip.copy()
        arm.controller.update(arm.pose, TICK)
        assert np.linalg.norm(arm.simulation.data.ctrl[0:6:2] - before) == pytest.approx(0.25)
        arm.run(TICK)


def test_a_far_reference_is_pulled_in_along_the_line_and_a_near_one_left_alone():
    stiffness = (400.0, 400.0, 400.0)
    assert within_reach((1.0, 2.0, 3.0), [1.0, 2.0, 2.8], stiffness) == (1.0, 2.0, 3.0)
    assert within_reach((1.0, 0.6, 0.8), [1.0, 0.0, 0.0], stiffness) == pytest.approx((1.0, 0.15, 0.2))


def test_an_axis_without_stiffness_does_not_count_for_the_reach():
    assert within_reach((1.0, 0.1, 0.8), [1.0, 0.0, 0.0], (500.0, 500.0, 0.0)) == (1.0, 0.1, 0.8)


def test_an_axis_without_stiffness_is_still_damped(arm):
    arm.controller.aim_stiffness((400.0, 400.0, 0.0, 50.0))
    arm.run(1.0)
    arm.controller.aim_force((0.0, 0.0, -2.0))
    before = arm.tip[2]
    arm.run(2.0)
    assert 0.0 < before - arm.tip[2] < 2.0 * 2.0 / 20.0  # slower than force / damping


def test_asking_again_for_the_same_changes_nothing(arm):
    arm.controller.aim_stiffness((400.0, 400.0, 400.0, 50.0))
    arm.controller.aim_force((0.0, 0.0, 0.0))
    assert arm.controller.is_settled


@pytest.mark.parametrize("seed", range(5))
def test_self_motion_leaves_the_tip_at_rest(simulation, seed):
    simulation.reset()
    joints = np.random.default_rng(seed).uniform(-1.9, 1.9, 7)
    simulation.place_arm(joints)
    jacobian = np.zeros((6, 7))
    mujoco.mj_jacSite(
        simulation.model, simulation.data, jacobian[:3], jacobian[3:], simulation.id_of("site", "tool_tip")
    )
    motion = np.array(self_motion(joints))
    assert np.linalg.norm(motion) > 1e-3
    assert jacobian @ (motion / np.linalg.norm(motion)) == pytest.approx(np.zeros(6), abs=1e-9)


def test_posture_torque_does_no_work_on_the_tip_and_pulls_to_the_posture():
    joints = np.array(START)
    torque = np.array(posture_torque(joints, [0.0] * 7))
    motion = np.array(self_motion(joints))
    assert np.cross(torque[:3], motion[:3]) == pytest.approx(np.zeros(3), abs=1e-9)
    assert torque @ (np.array(POSTURE) - joints) > 0.0


def test_posture_torque_damps_the_self_motion():
    motion = np.array(self_motion(POSTURE))
    assert np.array(posture_torque(POSTURE, motion)) == pytest.approx(-4.0 * motion)


def test_posture_torque_is_zero_where_the_self_motion_is_not_unique():
    assert posture_torque([0.0] * 7, [0.1] * 7) == (0.0,) * 7
