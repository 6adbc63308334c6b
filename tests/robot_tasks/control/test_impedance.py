"""Tests for impedance.py: the arm as a spring, in free space."""

import numpy as np
import pytest

from robot_tasks.control.impedance import (
    POSTURE,
    ImpedanceController,
    posture_torque,
    self_motion,
    within_reach,
)
from robot_tasks.geometry import Pose
from robot_tasks.simulation import TICK
from tests.robot_tasks.arm import START, Arm, tip_jacobian


@pytest.fixture
def arm(simulation):
    simulation.reset()
    simulation.place_arm(START)
    return Arm(simulation)


@pytest.mark.parametrize("stiffness", [400.0, 700.0])
@pytest.mark.parametrize(
    "push",
    [
        pytest.param((10.0, 0.0, 0.0), id="x"),
        pytest.param((0.0, -10.0, 0.0), id="y"),
        pytest.param((0.0, 0.0, 10.0), id="z"),
        pytest.param((4.0, 5.0, -6.0), id="askew"),
    ],
)
def test_a_push_deflects_the_tip_by_force_over_stiffness(arm, stiffness, push):
    arm.controller.aim_stiffness((stiffness, stiffness, stiffness, 50.0))
    assert arm.run(5.0, push) == pytest.approx(np.divide(push, stiffness), abs=5e-5)


def test_axes_of_different_stiffness_deflect_each_by_their_own(arm):
    arm.controller.aim_stiffness((500.0, 700.0, 400.0, 50.0))
    assert arm.run(5.0, (5.0, 7.0, -4.0)) == pytest.approx([0.01, 0.01, -0.01], abs=5e-5)


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


def test_a_force_compensation_is_added_to_a_vertical_force_and_not_reported(arm):
    arm.controller = ImpedanceController(arm.simulation, force_compensation=-5.0)
    arm.controller.aim_force((0.0, 0.0, -7.0))
    assert arm.run(5.0) == pytest.approx([0.0, 0.0, -12.0 / 400.0], abs=5e-5)
    assert arm.controller.force == (0.0, 0.0, -7.0)
    arm.controller.aim_force((4.0, 0.0, 0.0))
    assert arm.run(5.0) == pytest.approx([0.01, 0.0, 0.0], abs=5e-5)


def test_the_tip_does_not_drift_while_the_elbow_moves_to_its_posture(arm):
    before = arm.simulation.data.qpos[2]
    assert arm.run(6.0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-5)
    assert abs(arm.simulation.data.qpos[2] - before) > 0.01


def test_the_tip_keeps_its_orientation_under_a_push(arm):
    arm.run(4.0, (10.0, 10.0, 0.0))
    quaternion = arm.simulation.pose_of("tool_tip").quaternion
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
    motion = np.array(self_motion(joints))
    assert np.linalg.norm(motion) > 1e-3
    assert tip_jacobian(simulation) @ (motion / np.linalg.norm(motion)) == pytest.approx(np.zeros(6), abs=1e-9)


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
