"""Tests for rollout.py."""

from dataclasses import replace

import numpy as np
import pytest

from robot_tasks.errors import SimulationError
from robot_tasks.evaluation import measure
from robot_tasks.rollout import rollout
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import TASKS
from tests.robot_tasks.conftest import (
    LOWERED_ONTO_THE_ENGINE,
    OPERATOR_MEANS,
    PUSHES_INTO_THE_CORNER,
    SEARCHES_FOR_THE_HOLE,
    STRAIGHT_THROUGH_THE_ENGINE,
)
from tests.robot_tasks.skills.scripted import FAILURE, RUNNING, SUCCESS, Scripted

TASK = TASKS["obstacle_avoidance"]
NEVER_CROSSES = OPERATOR_MEANS | {"mp2_threshold": 1.5}
ENDS_EARLY = {
    "success": OPERATOR_MEANS,
    "stuck at the engine": STRAIGHT_THROUGH_THE_ENGINE,
    "lowered onto the engine": LOWERED_ONTO_THE_ENGINE,
    "waiting at the first way-point": NEVER_CROSSES,
}


def run(simulation, parameters, *, start="s0", **options):
    return rollout(TASK, parameters, TASK.randomization.nominal(start), simulation, **options)


@pytest.mark.parametrize("parameters", ENDS_EARLY.values(), ids=ENDS_EARLY)
def test_an_early_end_changes_no_number_by_more_than_a_thousandth(simulation, parameters):
    early = run(simulation, parameters)
    full = run(simulation, parameters, stop_when_still=False)
    assert early.simulated_seconds < 12.0
    assert full.simulated_seconds == pytest.approx(12.0)
    early_numbers, full_numbers = measure(TASK, early), measure(TASK, full)
    del early_numbers["simulated_seconds"], full_numbers["simulated_seconds"]
    assert early_numbers == pytest.approx(full_numbers, rel=1e-3, abs=1e-4)


@pytest.mark.parametrize("seed", range(6))
def test_an_early_end_is_as_harmless_for_random_parameters(simulation, seed):
    rng = np.random.default_rng(seed)
    parameters = {parameter.name: rng.uniform(parameter.low, parameter.high) for parameter in TASK.parameters}
    variation = TASK.randomization.sample(rng)
    early, full = (rollout(TASK, parameters, variation, simulation, stop_when_still=stop) for stop in (True, False))
    for term in TASK.terms:
        assert term.total(early) == pytest.approx(term.total(full), rel=1e-3)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["peg_insertion", "object_pushing"])
def test_an_early_end_is_as_harmless_in_contact(request, name, seed):
    task, rng = TASKS[name], np.random.default_rng(seed)
    simulation = request.getfixturevalue({"peg_insertion": "peg_simulation", "object_pushing": "push_simulation"}[name])
    parameters = {parameter.name: rng.uniform(parameter.low, parameter.high) for parameter in task.parameters}
    variation = task.randomization.sample(rng)
    early, full = (rollout(task, parameters, variation, simulation, stop_when_still=stop) for stop in (True, False))
    for term in task.terms:
        assert term.total(early) == pytest.approx(term.total(full), rel=1e-3)


def test_a_peg_that_does_not_search_ends_early(peg_simulation):
    task = TASKS["peg_insertion"]
    parameters = {"PathVelocity": 0.0, "PathDistance": 0.01, "Radius": 0.02, "Force": -10.0}
    episode = rollout(task, parameters, task.randomization.nominal("s0"), peg_simulation)
    assert episode.simulated_seconds < 10.0


def test_the_grid_has_a_sample_every_tenth_of_a_second(simulation):
    episode = run(simulation, OPERATOR_MEANS)
    assert episode.times == pytest.approx(np.arange(121) / 10)
    assert episode.n_steps == 120


def test_the_first_sample_is_the_start_and_the_last_is_held(simulation):
    episode = run(simulation, OPERATOR_MEANS)
    assert episode.joint_positions[0] == pytest.approx(TASK.randomization.starts["s0"])
    last = round(episode.simulated_seconds * 10)
    assert (episode.tip_positions[last:] == episode.tip_positions[last]).all()
    assert (episode.tip_positions[last - 20] != episode.tip_positions[last]).any()


def test_success_is_the_first_tick_within_the_success_distance(simulation):
    episode = run(simulation, OPERATOR_MEANS)
    distances = np.linalg.norm(episode.tip_positions - [-0.6, 0.0, 0.7], axis=1)
    assert episode.success_time == pytest.approx(episode.times[np.argmax(distances < 0.05)], abs=0.1)


def test_the_reference_never_runs_far_ahead_of_the_arm_in_free_space(simulation):
    episode = run(simulation, OPERATOR_MEANS)
    assert np.linalg.norm(episode.reference_positions - episode.tip_positions, axis=1).max() < 0.08


@pytest.mark.parametrize("parameters", ENDS_EARLY.values(), ids=ENDS_EARLY)
def test_an_arm_that_gets_stuck_does_not_whip_free(simulation, parameters):
    joints = run(simulation, parameters, stop_when_still=False).joint_positions
    assert np.abs(np.diff(joints, axis=0)).max() / 0.1 < 1.8  # rad/s


def test_half_the_physics_step_gives_the_same_motion(simulation):
    coarse = run(simulation, OPERATOR_MEANS, start="s1")
    fine = run(Simulation.from_scene(TASK.scene, timestep=0.001), OPERATOR_MEANS, start="s1")
    assert fine.tip_positions == pytest.approx(coarse.tip_positions, abs=5e-4)


def test_a_watcher_sees_every_tick_and_the_end_and_changes_nothing(simulation):
    times, heights = [], []

    def watch(time):
        times.append(time)
        heights.append(simulation.site_position("tool_tip")[2])

    watched = run(simulation, OPERATOR_MEANS, on_tick=watch)
    assert times == pytest.approx(np.arange(len(times)) * 0.02)
    assert times[-1] == pytest.approx(watched.simulated_seconds)
    n_samples = len(heights[::5])
    assert (watched.tip_positions[:n_samples, 2] == heights[::5]).all()
    assert (run(simulation, OPERATOR_MEANS).tip_positions == watched.tip_positions).all()


def test_bodies_that_get_into_each_other_end_the_rollout_as_an_error(simulation, monkeypatch):
    monkeypatch.setattr("robot_tasks.contacts.DEEPEST_OVERLAP", 1e-4)
    with pytest.raises(SimulationError, match=r"simulation at t = .* s: two bodies overlap by .* mm"):
        run(simulation, STRAIGHT_THROUGH_THE_ENGINE)


@pytest.mark.parametrize("start", ["s0", "s3"])
def test_an_early_end_is_harmless_after_an_insertion(peg_simulation, start):
    task = TASKS["peg_insertion"]
    variation = task.randomization.nominal(start)
    early, full = (
        rollout(task, SEARCHES_FOR_THE_HOLE, variation, peg_simulation, stop_when_still=stop) for stop in (True, False)
    )
    assert early.simulated_seconds < 12.0 < full.simulated_seconds
    for term in task.terms:
        assert term.total(early) == pytest.approx(term.total(full), rel=1e-3)


def at_full_and_half_step(task, parameters):
    full = Simulation.from_scene(task.scene)
    half = Simulation.from_scene(task.scene, timestep=full.model.opt.timestep / 2)
    return [rollout(task, parameters, task.randomization.nominal("s0"), simulation) for simulation in (full, half)]


def test_half_the_physics_step_inserts_at_the_same_time():
    coarse, fine = at_full_and_half_step(TASKS["peg_insertion"], SEARCHES_FOR_THE_HOLE)
    assert fine.success_time == pytest.approx(coarse.success_time, abs=0.1)
    assert fine.tip_positions[-1] == pytest.approx(coarse.tip_positions[-1], abs=1e-4)


def test_half_the_physics_step_pushes_the_prism_to_the_same_place():
    coarse, fine = at_full_and_half_step(TASKS["object_pushing"], PUSHES_INTO_THE_CORNER)
    assert fine.object_poses[-1] == pytest.approx(coarse.object_poses[-1], abs=1e-4)


class Answers:
    """A relation that holds as a script says, sample by sample."""

    def __init__(self, *answers):
        self.answers = list(answers)

    def holds(self, world):
        return self.answers.pop(0)


def run_idle(simulation, **changes):
    task = replace(TASK, **{"build_tree": lambda parameters: Scripted(RUNNING), "duration": 0.5} | changes)
    return rollout(task, {}, TASK.randomization.nominal("s0"), simulation, stop_when_still=False)


@pytest.mark.parametrize(
    ("answers", "success_time"),
    [
        pytest.param([False, False, True, True, True, True], 0.2, id="from some time on"),
        pytest.param([True] * 6, 0.0, id="from the start"),
        pytest.param([False, True, True, False, True, True], 0.4, id="lost in between: the last time counts"),
        pytest.param([True, True, True, True, True, False], None, id="lost at the end"),
        pytest.param([False] * 6, None, id="never"),
    ],
)
def test_with_a_final_condition_success_is_its_holding_from_some_time_to_the_end(simulation, answers, success_time):
    episode = run_idle(simulation, final_condition=Answers(*answers))
    assert episode.success_time == pytest.approx(success_time)


@pytest.mark.parametrize("status", [SUCCESS, FAILURE])
@pytest.mark.parametrize("holds", [True, False])
def test_with_a_final_condition_the_end_of_the_skill_does_not_matter(simulation, status, holds):
    ended = {"build_tree": lambda parameters: Scripted(status), "final_condition": Answers(*[holds] * 6)}
    assert run_idle(simulation, **ended).is_success is holds


def test_an_episode_tells_how_its_bodies_were_shifted(peg_simulation):
    task = TASKS["peg_insertion"]
    variation = task.randomization.sample(np.random.default_rng(2))
    assert rollout(task, SEARCHES_FOR_THE_HOLE, variation, peg_simulation).shifts == variation.shifts


def test_the_pose_of_the_object_is_recorded_where_there_is_one(push_simulation, simulation):
    task = TASKS["object_pushing"]
    variation = task.randomization.sample(np.random.default_rng(2))
    episode = rollout(task, PUSHES_INTO_THE_CORNER, variation, push_simulation)
    assert episode.object_poses[0] == pytest.approx(np.concatenate(variation.objects["prism"]))
    assert run_idle(simulation).object_poses is None
