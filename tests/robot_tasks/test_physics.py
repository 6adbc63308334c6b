"""Trust in the physics: scenes, contacts and arm against numbers that are known from elsewhere."""

from itertools import pairwise

import mujoco
import numpy as np
import pytest

from robot_tasks.geometry import TOOL_DOWN, Pose, rotation_angle, turned
from robot_tasks.tasks.object_pushing import OBJECT_PUSHING
from tests.robot_tasks.arm import START, Arm, place_tip

GRAVITY = 9.81
RIM = 0.703
"""Height of the block's top in [m]."""
HOLE_BOTTOM = 0.609
"""Height of the bottom of the hole in [m]."""
DOWN = np.array([0.0, 0.0, -1.0])


def direction(degrees):
    angle = np.radians(degrees)
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def pose_over_block(x, y, z, yaw=0.0):
    """Pose of the tool straight down, its tip x, y in [m] from the axis of the hole, turned by a yaw in [degrees]."""
    return turned(Pose((-0.6 + x, y, z), TOOL_DOWN), np.radians(yaw))


def arm_at(simulation, pose):
    simulation.reset()
    place_tip(simulation, pose)
    return Arm(simulation)


def overlap(simulation):
    """Largest overlap of two bodies in [m] in the last tick; negative if all are apart."""
    return -simulation.sensor_history("deepest").min()


# The hole of the block


def is_jammed(simulation, block_offset):
    simulation.shift_body("block", block_offset)
    mujoco.mj_fwdPosition(simulation.model, simulation.data)
    return simulation.data.ncon > 0 and simulation.data.contact.dist.min() < 0.0


def play(simulation, towards):
    """Find by bisection how far in [m] the block can be moved against the peg in its hole."""
    free, jammed = 0.0, 0.004
    for _ in range(14):
        middle = 0.5 * (free + jammed)
        free, jammed = (free, middle) if is_jammed(simulation, middle * towards) else (middle, jammed)
    return free


@pytest.mark.parametrize("height", [0.69, 0.64], ids=["just inserted", "deep"])
@pytest.mark.parametrize("yaw", [0.0, 3.75, 7.5, 11.25, 77.0])
def test_a_peg_in_the_hole_has_a_play_of_1_5_millimetres_in_every_direction(peg_simulation, yaw, height):
    peg_simulation.reset()
    place_tip(peg_simulation, pose_over_block(0.0, 0.0, height, yaw))
    plays = [play(peg_simulation, direction(degrees)) for degrees in range(0, 360, 5)]
    assert min(plays) > 1.4e-3
    assert max(plays) < 1.8e-3


def look_down(simulation, x, y):
    """Height in [m] of what lies under a point, given in [m] from the axis of the hole."""
    above = np.array([-0.6 + x, y, 0.8])
    return 0.8 - mujoco.mj_ray(simulation.model, simulation.data, above, DOWN, None, True, -1, None)


def test_the_block_has_no_gap_but_the_hole_and_the_hole_no_obstacle(peg_simulation):
    peg_simulation.reset()
    peg_simulation.place_arm(START)
    grid = np.arange(-74.5, 75.0, 1.0) * 1e-3
    heights = np.array([[look_down(peg_simulation, x, y) for y in grid] for x in grid])
    radii = np.hypot(*np.meshgrid(grid, grid, indexing="ij"))
    assert heights[radii > 25.6e-3] == pytest.approx(RIM, abs=1e-9)
    assert heights[radii < 25.0e-3] == pytest.approx(HOLE_BOTTOM, abs=1e-9)


@pytest.mark.parametrize("degrees", range(0, 360, 3))
def test_the_edge_of_the_hole_is_within_half_a_millimetre_of_its_circle(peg_simulation, degrees):
    peg_simulation.reset()
    peg_simulation.place_arm(START)
    x, y, _ = direction(degrees)
    assert look_down(peg_simulation, 0.02499 * x, 0.02499 * y) == pytest.approx(HOLE_BOTTOM, abs=1e-9)
    assert look_down(peg_simulation, 0.0256 * x, 0.0256 * y) == pytest.approx(RIM, abs=1e-9)


@pytest.mark.parametrize("degrees", [0.0, 11.25, 22.5, 45.0, 90.0, 200.0])
def test_an_inserted_peg_sinks_little_into_the_wall_it_is_pushed_against(peg_simulation, degrees):
    arm = arm_at(peg_simulation, pose_over_block(0.0, 0.0, 0.66))
    arm.run(2.0, 20.0 * direction(degrees))
    force = peg_simulation.data.sensor("tool_force").data
    assert np.linalg.norm(force) == pytest.approx(20.0, rel=0.05)  # 0.6 N of it deflect the arm to the wall
    assert 0.0 < overlap(peg_simulation) < 0.15e-3


PLACES_TO_PRESS = {
    "beside the hole": pose_over_block(0.0, 0.05, RIM + 0.002),
    "over the edge of the hole": pose_over_block(0.008, 0.0, RIM + 0.002),
    "on the bottom of the hole": pose_over_block(0.0, 0.0, HOLE_BOTTOM + 0.002),
}


def press(simulation, pose, newton):
    """Press the tool down by force alone until all is still."""
    arm = arm_at(simulation, pose)
    arm.controller.aim_stiffness((500.0, 500.0, 0.0, 50.0))
    arm.controller.aim_force((0.0, 0.0, -newton))
    arm.run(5.0)


def vertical_force_range(simulation):
    """Smallest and largest vertical force on the tool in [N] in the last tick."""
    forces = np.abs(simulation.sensor_history("tool_force")[:, 2])
    return forces.min(), forces.max()


@pytest.mark.parametrize("pose", PLACES_TO_PRESS.values(), ids=PLACES_TO_PRESS)
@pytest.mark.parametrize("newton", [1.0, 10.0, 20.0])
def test_a_steady_press_has_the_force_that_was_commanded(peg_simulation, pose, newton):
    press(peg_simulation, pose, newton)
    assert vertical_force_range(peg_simulation) == pytest.approx((newton, newton), rel=0.02)


@pytest.mark.parametrize("pose", PLACES_TO_PRESS.values(), ids=PLACES_TO_PRESS)
def test_a_pressing_peg_sinks_little_into_the_block(peg_simulation, pose):
    press(peg_simulation, pose, 20.0)
    assert 0.0 < overlap(peg_simulation) < 0.15e-3


@pytest.mark.parametrize("newton", [7.0, 20.0])
def test_a_square_tool_presses_on_the_table_with_the_force_that_was_commanded(push_simulation, newton):
    press(push_simulation, Pose((-0.4, 0.25, 0.602), TOOL_DOWN), newton)
    assert vertical_force_range(push_simulation) == pytest.approx((newton, newton), rel=0.02)
    assert overlap(push_simulation) < 0.15e-3


# Energy


def energy(arm):
    """Kinetic energy of the arm and energy of the controller's springs of 400 N/m and 50 Nm/rad in [J]."""
    model, data = arm.simulation.model, arm.simulation.data
    mujoco.mj_forward(model, data)
    inertia = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, inertia)
    deflection = arm.tip - arm.pose.position
    angle = rotation_angle(arm.simulation.pose_of("tool_tip").quaternion, arm.pose.quaternion)
    kinetic = 0.5 * data.qvel @ inertia @ data.qvel
    return kinetic + 0.5 * 400.0 * deflection @ deflection + 0.5 * 50.0 * angle**2


def energies_after_a_kick(arm, joint_speeds, seconds):
    """Let the arm swing and return its energy in [J] before each physics step."""
    model, data = arm.simulation.model, arm.simulation.data
    arm.run(3.0)  # until the elbow is in its posture
    arm.pose = arm.simulation.pose_of("tool_tip")
    arm.controller.update(arm.pose, 0.02)
    data.qvel[:7] = joint_speeds
    energies = []
    for _ in range(round(seconds / model.opt.timestep)):
        energies.append(energy(arm))
        mujoco.mj_step(model, data)
    return np.array(energies)


@pytest.mark.parametrize("seed", range(3))
def test_an_arm_that_was_kicked_loses_energy_at_every_step(simulation, seed):
    simulation.reset()
    simulation.place_arm(START)
    speeds = np.random.default_rng(seed).uniform(-0.5, 0.5, 7)
    energies = energies_after_a_kick(Arm(simulation), speeds, seconds=2.0)
    assert energies[0] > 0.1
    assert all(after < before for before, after in pairwise(energies))
    assert energies[-1] < 0.01 * energies[0]


@pytest.mark.parametrize("seed", range(3))
def test_a_peg_that_rattles_in_its_hole_loses_energy_at_every_step(peg_simulation, seed):
    speeds = np.random.default_rng(seed).uniform(-0.5, 0.5, 7)
    energies = energies_after_a_kick(arm_at(peg_simulation, pose_over_block(0.0, 0.0, 0.66)), speeds, seconds=2.0)
    assert energies[0] > 0.1
    assert all(after < before for before, after in pairwise(energies))
    assert energies[-1] < 0.01 * energies[0]


# The prism

VERTICES = np.array([(0.0, 0.0), (-0.3, 0.0), (-0.3, -0.15)])
"""Corners of the prism's triangle in its own frame in [m]; it is 70 mm high and 2.5 kg heavy."""
PRISM_DOFS = slice(7, 13)
FRICTION = 0.25 * 2.5 * GRAVITY
"""Friction between prism and table in [N]."""


@pytest.fixture
def scene_at_rest(push_simulation):
    """The pushing scene as it starts, the arm holding its pose."""
    OBJECT_PUSHING.randomization.nominal("s0").apply(push_simulation)
    return Arm(push_simulation)


def test_the_prism_has_the_mass_and_inertia_of_a_uniform_one(push_simulation):
    model, prism = push_simulation.model, push_simulation.id_of("body", "prism")
    centroid = VERTICES.mean(axis=0)
    # second moments of area of a triangle about its centroid: sum over corners of (v - c)(v - c)^T / 12
    second = (VERTICES - centroid).T @ (VERTICES - centroid) / 12.0
    covariance = np.zeros((3, 3))
    covariance[:2, :2], covariance[2, 2] = second, 0.07**2 / 12.0
    inertia = 2.5 * (np.trace(covariance) * np.eye(3) - covariance)
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, model.body_iquat[prism])
    axes = matrix.reshape(3, 3)
    assert model.body_mass[prism] == 2.5
    assert model.body_ipos[prism] == pytest.approx([*centroid, 0.035])
    assert axes @ np.diag(model.body_inertia[prism]) @ axes.T == pytest.approx(inertia, abs=1e-6)


def test_a_prism_that_lies_on_the_table_stays_where_it_is(scene_at_rest):
    simulation = scene_at_rest.simulation
    before = simulation.pose_of("prism")
    scene_at_rest.run(2.0)
    after = simulation.pose_of("prism")
    assert after.position == pytest.approx(before.position, abs=1e-4)
    assert rotation_angle(after.quaternion, before.quaternion) < 1e-4
    assert np.abs(simulation.data.qvel[PRISM_DOFS]).max() < 1e-6


def test_a_prism_at_rest_weighs_on_the_table_with_its_weight(scene_at_rest):
    simulation = scene_at_rest.simulation
    scene_at_rest.run(1.0)
    upward = simulation.data.qfrc_constraint[PRISM_DOFS][2]
    assert upward == pytest.approx(2.5 * GRAVITY, rel=1e-3)
    assert overlap(simulation) < 0.15e-3


@pytest.mark.parametrize("speed", [0.2, 0.5])
@pytest.mark.parametrize("degrees", [45.0, 90.0, 135.0])
def test_a_sliding_prism_stops_after_the_way_of_dry_friction(scene_at_rest, speed, degrees):
    simulation = scene_at_rest.simulation
    scene_at_rest.run(0.2)
    before = simulation.pose_of("prism")
    simulation.data.qvel[7:10] = speed * direction(degrees)
    scene_at_rest.run(1.0)
    after = simulation.pose_of("prism")
    way = speed**2 / (2.0 * 0.25 * GRAVITY)
    assert np.subtract(after.position, before.position) == pytest.approx(way * direction(degrees), abs=0.1 * way)
    assert rotation_angle(after.quaternion, before.quaternion) < np.radians(1.0)
    assert np.abs(simulation.data.qvel[PRISM_DOFS]).max() < 1e-4


def way_under_a_push(arm, newton, seconds):
    """Distance in [m] that the prism moves under a horizontal force at its centre of mass for a time in [s]."""
    simulation = arm.simulation
    arm.run(0.2)
    before = simulation.pose_of("prism").position
    simulation.data.xfrc_applied[simulation.id_of("body", "prism"), 1] = newton
    arm.run(seconds)
    return np.linalg.norm(np.subtract(simulation.pose_of("prism").position, before))


def test_the_prism_resists_a_push_of_less_than_its_friction(scene_at_rest):
    assert way_under_a_push(scene_at_rest, 0.9 * FRICTION, 1.0) < 1e-4


def test_the_prism_is_accelerated_by_what_a_push_is_more_than_its_friction(scene_at_rest):
    way = 0.5 * (0.5 * FRICTION / 2.5) * 0.5**2
    assert way_under_a_push(scene_at_rest, 1.5 * FRICTION, 0.5) == pytest.approx(way, rel=0.05)
