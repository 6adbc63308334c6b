"""Tests for simulation.py: names, reset, and the arm's geometry against the published description."""

import mujoco
import numpy as np
import pytest

from robot_tasks.errors import SimulationError, UnknownNameError
from robot_tasks.simulation import TICK, Simulation

# Joint angles; tip position in m; tilt of the tool from straight down and yaw of its x axis in degrees, as published.
START_STATES = {
    "obstacle 0": ("0.47 1.54 -0.30 -0.84 1.48 1.34 -1.28", "-0.4997 0.5738 0.7479", 0.20, 0.25),
    "obstacle 1": ("0.43 1.65 -0.32 -0.56 1.46 1.37 -1.11", "-0.5387 0.5930 0.7522", 0.15, -0.11),
    "obstacle 2": ("0.44 1.58 -0.30 -0.90 1.49 1.34 -1.38", "-0.4488 0.6026 0.7512", 0.38, -0.32),
    "obstacle 3": ("0.49 1.45 -0.28 -1.10 1.50 1.32 -1.45", "-0.4472 0.5515 0.7490", 0.53, 0.22),
    "obstacle 4": ("0.48 1.52 -0.30 -0.74 1.46 1.35 -1.15", "-0.5504 0.5489 0.7522", 0.12, -0.11),
    "peg 0": ("0.67 0.28 -0.27 -1.40 1.10 1.49 -0.58", "-0.6184 0.0038 0.9986", 1.76, -0.05),
    "peg 1": ("0.70 0.20 -0.27 -1.46 1.09 1.47 -0.56", "-0.6016 -0.0253 1.0026", 1.08, 0.43),
    "peg 2": ("0.56 0.08 -0.15 -1.72 1.07 1.41 -0.69", "-0.5291 0.0000 1.0033", 0.59, -0.14),
    "peg 3": ("0.50 0.17 -0.15 -1.72 1.09 1.42 -0.80", "-0.5311 0.0507 1.0024", 0.26, -0.14),
    "peg 4": ("0.52 0.26 -0.15 -1.55 1.09 1.44 -0.72", "-0.5817 0.0493 1.0005", 0.67, 0.02),
    "push 0": ("0.33 0.89 -0.16 -1.39 1.19 1.39 -1.23", "-0.5339 0.3748 0.9367", 0.43, -0.11),
    "push 1": ("0.29 0.85 -0.14 -1.87 1.25 1.25 -1.66", "-0.3574 0.3692 0.8954", 0.69, -0.09),
    "push 2": ("0.31 1.15 -0.08 -1.63 1.34 1.17 -1.71", "-0.3596 0.4654 0.8147", 0.32, 0.16),
    "push 3": ("0.27 1.34 -0.13 -1.47 1.34 1.23 -1.31", "-0.3249 0.5414 0.8130", 0.06, -25.6),
}


@pytest.mark.parametrize(("joints", "tip", "tilt", "yaw"), START_STATES.values(), ids=START_STATES)
def test_forward_kinematics_agrees_with_the_published_table(simulation, joints, tip, tilt, yaw):
    simulation.reset()
    simulation.place_arm([float(angle) for angle in joints.split()])
    matrix = simulation.data.site_xmat[simulation.id_of("site", "tool_tip")].reshape(3, 3)
    assert simulation.site_position("tool_tip") == pytest.approx([float(x) for x in tip.split()], abs=1e-4)
    assert np.degrees(np.arccos(-matrix[2, 2])) == pytest.approx(tilt, abs=0.02)
    assert np.degrees(np.arctan2(matrix[1, 0], matrix[0, 0])) == pytest.approx(yaw, abs=0.02)


def test_forward_kinematics_of_the_zero_configuration(simulation):
    simulation.reset()
    assert not simulation.data.qpos.any()
    simulation.place_arm([0.0] * 7)
    assert simulation.site_position("tool_tip") == pytest.approx([-0.4705, -0.7371, 1.6137], abs=1e-4)


@pytest.mark.parametrize("kind", ["body", "joint", "geom", "site", "actuator", "camera", "sensor"])
def test_a_missing_name_lists_those_present(simulation, kind):
    with pytest.raises(UnknownNameError, match=f"unknown {kind} 'nose'. Known: .*{simulation.names(kind)[0]}"):
        simulation.id_of(kind, "nose")


def test_a_missing_scene_lists_those_present():
    with pytest.raises(UnknownNameError, match=r"unknown scene 'obstacle.xml'. Known: .*obstacle_avoidance.xml"):
        Simulation.from_scene("obstacle.xml")


def test_the_quaternion_of_a_tool_pointing_down_is_half_a_turn_about_x(simulation):
    simulation.reset()
    simulation.place_arm([0.48, 1.52, -0.30, -0.74, 1.46, 1.35, -1.15])
    assert np.abs(simulation.pose_of("tool_tip").quaternion) == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=2e-3)


def test_poses_of_bodies_and_sites_are_the_present_ones(simulation):
    simulation.reset()
    simulation.place_arm([0.48, 1.52, -0.30, -0.74, 1.46, 1.35, -1.15])
    assert simulation.pose_of("engine").position == pytest.approx((-0.52, 0.3, 0.751))
    assert simulation.pose_of("tool_tip").position == pytest.approx(simulation.site_position("tool_tip"))
    with pytest.raises(UnknownNameError, match=r"unknown body or site 'engin'. .* Did you mean 'engine'"):
        simulation.pose_of("engin")


def test_only_a_free_body_can_be_placed(simulation):
    with pytest.raises(ValueError, match="body 'engine' is not free to be placed anywhere"):
        simulation.place_body("engine", simulation.pose_of("engine"))


@pytest.mark.parametrize("timestep", [None, 0.0005, 0.001])
def test_the_history_of_a_sensor_holds_every_step_of_a_tick_in_order(timestep):
    simulation = Simulation.from_scene("obstacle_avoidance.xml", timestep=timestep)
    simulation.reset()
    simulation.place_arm([0.48, 1.52, -0.30, -0.74, 1.46, 1.35, -1.15])
    simulation.shift_body("table", (0.0, 0.0, 0.155))  # the table is pushed 3 mm into the tool
    mujoco.mj_forward(simulation.model, simulation.data)
    model, data, deepest = simulation.model, simulation.data, []
    n_steps = round(TICK / model.opt.timestep)
    history = simulation.sensor_history("deepest")
    for _ in range(3):  # ticks; deepest ends as the list of the last one's readings
        deepest = []
        for _ in range(n_steps):
            mujoco.mj_step(model, data)
            deepest.append(data.sensor("deepest").data.item())
    assert len(set(deepest)) == n_steps
    assert history[:, 0].tolist() == deepest


def test_a_history_of_another_length_than_a_tick_is_refused(simulation, monkeypatch):
    monkeypatch.setattr(simulation.model.opt, "timestep", 0.001)
    with pytest.raises(ValueError, match="sensor 'deepest' keeps 10 samples; a tick has 20"):
        simulation.sensor_history("deepest")


def test_reset_restores_bodies_gains_and_state():
    used, fresh = (Simulation.from_scene("obstacle_avoidance.xml") for _ in range(2))
    used.shift_body("engine", (0.02, 0.01, 0.0))
    used.model.actuator_biasprm[0, 1:3] = -800.0, -50.0
    used.model.actuator_gainprm[3, 0] = 80.0
    used.data.qfrc_applied[:] = 1.0
    mujoco.mj_step(used.model, used.data, 10)
    used.reset()
    specification = mujoco.mjtState.mjSTATE_INTEGRATION
    states = [np.empty(mujoco.mj_stateSize(fresh.model, specification)) for _ in range(2)]
    for simulation, state in zip((used, fresh), states, strict=True):
        mujoco.mj_getState(simulation.model, simulation.data, state, specification)
    assert (states[0] == states[1]).all()
    for field in ("body_pos", "actuator_gainprm", "actuator_biasprm"):
        assert (getattr(used.model, field) == getattr(fresh.model, field)).all()


def test_divergence_is_an_error_and_not_a_silent_reset(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warnings to a file in the working directory
    simulation = Simulation.from_scene("obstacle_avoidance.xml")
    simulation.raise_if_diverged()
    simulation.data.qvel[0] = np.nan
    mujoco.mj_step(simulation.model, simulation.data)
    with pytest.raises(SimulationError, match="huge value in QVEL at DOF 0"):
        simulation.raise_if_diverged()


def test_a_step_that_does_not_divide_a_tick_is_refused():
    with pytest.raises(ValueError, match=r"a physics step of 0.003 s: a tick of 0.02 s must have a whole number"):
        Simulation.from_scene("obstacle_avoidance.xml", timestep=0.003)
