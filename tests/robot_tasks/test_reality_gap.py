"""Tests for reality_gap.py: each difference of a stand-in has the effect that physics says it has."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from robot_tasks.errors import GapError, UnknownNameError
from robot_tasks.geometry import Pose
from robot_tasks.reality_gap import RealityGap, read_gaps
from robot_tasks.rollout import rollout
from robot_tasks.simulation import TICK, Simulation
from robot_tasks.skills import Behaviour
from robot_tasks.tasks import STAND_INS, TASKS
from tests.robot_tasks.arm import START, Arm
from tests.robot_tasks.conftest import STRAIGHT_THROUGH_THE_ENGINE
from tests.robot_tasks.skills.scripted import RUNNING

SCENE = "obstacle_avoidance.xml"
TASK = TASKS["obstacle_avoidance"]


def load(**differences):
    return Simulation.from_scene(SCENE, modify=RealityGap(**differences).apply)


def run(gap, parameters=STRAIGHT_THROUGH_THE_ENGINE, **changes):
    task = replace(TASK, gap=gap, **changes)
    simulation = Simulation.from_scene(SCENE, modify=gap.apply)
    return rollout(task, parameters, TASK.randomization.nominal("s0"), simulation)


def arm_of(simulation):
    simulation.place_arm(START)
    return Arm(simulation)


def test_no_gap_changes_nothing():
    plain, same = Simulation.from_scene(SCENE).model, load().model
    for field in ("geom_friction", "dof_damping", "dof_frictionloss", "body_mass", "body_inertia", "body_pos"):
        assert (getattr(plain, field) == getattr(same, field)).all()
    assert not same.actuator_delay.any()


def test_a_factor_on_friction_acts_on_sliding_of_geoms_and_of_pairs():
    scene = "object_pushing.xml"
    plain = Simulation.from_scene(scene).model
    rough = Simulation.from_scene(scene, modify=RealityGap(friction=1.4).apply).model
    assert rough.geom_friction[:, 0] == pytest.approx(1.4 * plain.geom_friction[:, 0])
    assert (rough.geom_friction[:, 1:] == plain.geom_friction[:, 1:]).all()
    assert plain.npair == 1
    assert rough.pair_friction[:, :2] == pytest.approx(1.4 * plain.pair_friction[:, :2])
    assert (rough.pair_friction[:, 2:] == plain.pair_friction[:, 2:]).all()


def test_a_payload_pulls_the_tip_down_by_its_weight_over_the_stiffness():
    deflection = arm_of(load(payload=0.25)).run(5.0)
    assert deflection == pytest.approx([0.0, 0.0, -0.25 * 9.81 / 400.0], abs=1e-4)


def test_a_payload_adds_its_mass_to_the_tool():
    plain, loaded = Simulation.from_scene(SCENE), load(payload=0.25)
    tool = plain.id_of("body", "tool_body")
    assert loaded.model.body_mass[tool] == pytest.approx(plain.model.body_mass[tool] + 0.25)
    assert loaded.model.body_inertia[tool] == pytest.approx(plain.model.body_inertia[tool] * 0.55 / 0.3)


def test_damping_and_dry_friction_are_those_of_the_arms_joints():
    model = Simulation.from_scene("object_pushing.xml", modify=RealityGap(joint_damping=1.5, joint_stiction=1.0).apply)
    assert model.model.dof_damping.tolist() == [0.5 + 1.5] * 7 + [0.0] * 6
    assert model.model.dof_frictionloss.tolist() == [1.0] * 7 + [0.0] * 6


def test_an_arm_with_dry_friction_yields_little_to_a_touch():
    pushed, alone = (arm_of(load(joint_stiction=2.0)).run(2.0, (newton, 0.0, 0.0)) for newton in (0.5, 0.0))
    assert np.linalg.norm(pushed - alone) < 0.5 * 0.5 / 400.0


def test_offsets_move_bodies_before_any_shift():
    simulation = load(offsets={"engine": (0.012, 0.015, 0.0)})
    simulation.shift_body("engine", (0.001, 0.0, 0.0))
    simulation.place_arm(START)
    assert simulation.pose_of("engine").position == pytest.approx((-0.52 + 0.013, 0.3 + 0.015, 0.751))


def test_a_command_has_no_effect_before_its_delay():
    simulation = load(command_delay=0.006)
    arm = arm_of(simulation)
    mujoco.mj_step(simulation.model, simulation.data, 10)
    x, y, z = arm.pose.position
    arm.controller.update(Pose((x, y, z + 0.05), arm.pose.quaternion), TICK)
    forces = []
    for _ in range(5):
        mujoco.mj_step(simulation.model, simulation.data)
        forces.append(simulation.data.actuator("impedance_z").force.item())
    assert forces[:3] == pytest.approx([0.0] * 3, abs=0.1)
    assert forces[3:] == pytest.approx([0.05 * 400.0] * 2, rel=0.05)


def test_an_arm_with_a_delay_holds_its_pose_from_the_start_as_one_without():
    delayed, prompt = (arm_of(load(command_delay=delay)) for delay in (0.006, 0.0))
    assert delayed.run(0.1).tolist() == prompt.run(0.1).tolist()


class Diary(Behaviour):
    """Write down where the tip is said to be."""

    def __init__(self, tips):
        super().__init__()
        self.tips = tips

    def _update(self, context):
        self.tips.append(context.tip)
        x, y, z = context.goal.position
        context.goal = Pose((x + 0.01, y, z), context.goal.quaternion)
        return RUNNING


@pytest.mark.parametrize("n_ticks", [0, 1, 3])
def test_a_skill_decides_on_a_tip_position_of_the_age_of_the_sensing_delay(n_ticks):
    said, true = [], []
    gap = RealityGap(sensing_delay=n_ticks * TICK)
    simulation = Simulation.from_scene(SCENE)
    task = replace(TASK, gap=gap, build_tree=lambda parameters: Diary(said), duration=0.4)
    start = TASK.randomization.nominal("s0")
    tip = simulation.site_position("tool_tip")
    rollout(task, {}, start, simulation, on_tick=lambda time: true.append(tuple(tip.tolist())))
    assert len(set(true)) == len(true) == 21
    assert said == [true[0]] * n_ticks + true[: 20 - n_ticks]


def test_the_operator_stops_a_robot_that_presses_too_hard():
    limited, unlimited = (run(RealityGap(force_limit=limit)) for limit in (50.0, float("inf")))
    assert limited.interventions == 1
    assert unlimited.interventions == 0
    assert limited.simulated_seconds < unlimited.simulated_seconds
    assert limited.contact.seconds < 0.2
    assert not limited.is_success


def test_a_robot_that_was_stopped_stays_where_it_is_and_is_charged_to_the_end():
    episode = run(RealityGap(force_limit=50.0))
    last = int(np.ceil(round(10.0 * episode.simulated_seconds, 6)))
    assert episode.n_steps == 120
    assert (episode.tip_positions[last:] == episode.tip_positions[last]).all()


def test_a_stand_in_is_the_task_across_its_gap_with_every_body_in_its_place():
    gaps = read_gaps(TASKS)
    assert set(gaps) == set(STAND_INS)
    for name, stand_in in STAND_INS.items():
        assert stand_in.gap == gaps[name] != RealityGap()
        assert stand_in.randomization.shifts == ()
        randomization = replace(stand_in.randomization, shifts=TASKS[name].randomization.shifts)
        assert replace(stand_in, gap=RealityGap(), randomization=randomization) == TASKS[name]


@pytest.mark.parametrize(
    ("differences", "message"),
    [
        pytest.param({"friction": 0.0}, "'friction': 0 is out of range. Give a positive number", id="friction"),
        pytest.param({"force_limit": 0.0}, "'force_limit': 0 is out of range. Give a positive number", id="limit"),
        pytest.param({"payload": -0.1}, "'payload': -0.1 is out of range. Give a finite number", id="payload"),
        pytest.param({"payload": np.nan}, "'payload': nan is out of range. Give a finite number", id="nan"),
        pytest.param({"joint_damping": -0.1}, "'joint_damping': -0.1 is out of range", id="damping"),
        pytest.param({"joint_stiction": np.inf}, "'joint_stiction': inf is out of range", id="stiction"),
        pytest.param({"command_delay": -0.002}, "'command_delay': -0.002 is out of range", id="delay"),
        pytest.param({"force_compensation": np.nan}, "'force_compensation': nan is not finite", id="compensation"),
        pytest.param({"sensing_delay": 0.03}, "'sensing_delay': 0.03 s. Give a multiple of a tick", id="tick"),
    ],
)
def test_a_gap_without_physical_meaning_names_the_number_and_what_is_allowed(differences, message):
    with pytest.raises(GapError, match=rf"reality gap, {message}"):
        RealityGap(**differences)


@pytest.mark.parametrize(
    ("differences", "message"),
    [
        ({"command_delay": 0.005}, "'command_delay': 0.005 s. Give a multiple of the physics step of 0.002 s"),
        ({"offsets": {"engin": (0.0, 0.0, 0.0)}}, "'offsets': the scene has no body 'engin'. Give names of its bodies"),
    ],
    ids=["delay", "body"],
)
def test_a_gap_that_does_not_fit_the_scene_is_refused(differences, message):
    with pytest.raises(GapError, match=rf"reality gap, {message}"):
        load(**differences)


def test_a_sensing_delay_is_counted_in_ticks():
    assert RealityGap(sensing_delay=0.06).ticks_of_sensing_delay == 3


@pytest.mark.parametrize(
    ("gaps", "message"),
    [
        ({"peg_insertio": {}}, "unknown task in reality_gaps.json 'peg_insertio'. .* Did you mean 'peg_insertion'"),
        (
            {"peg_insertion": {"frictio": 1.0}},
            "key of task 'peg_insertion' in .* 'frictio'. .* 'friction'",
        ),
    ],
    ids=["task", "key"],
)
def test_a_name_in_the_file_that_does_not_exist_is_named_with_those_that_do(monkeypatch, gaps, message):
    monkeypatch.setattr("robot_tasks.reality_gap.json.loads", lambda text: gaps)
    with pytest.raises(UnknownNameError, match=message):
        read_gaps(TASKS)
