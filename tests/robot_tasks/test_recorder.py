"""Tests for recorder.py, with bodies moved by hand instead of by physics."""

import mujoco
import numpy as np
import pytest

from robot_tasks.errors import SimulationError
from robot_tasks.geometry import TOOL_DOWN, Pose
from robot_tasks.recorder import Recorder
from robot_tasks.tasks import TASKS
from robot_tasks.tasks.object_pushing import PRISM_GOAL, PRISM_START

REFERENCE, NO_FORCE = (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)
PUSH, OBSTACLE = TASKS["object_pushing"], TASKS["obstacle_avoidance"]


@pytest.fixture
def push(push_simulation):
    """Start a recording, and return it with a function that takes a sample of the prism at a pose."""
    variation = PUSH.randomization.nominal("s1")
    variation.apply(push_simulation)
    recorder = Recorder(PUSH, push_simulation, {"block": (0.001, 0.0, 0.0)})

    def sample(pose: Pose) -> None:
        push_simulation.place_body("prism", pose)
        push_simulation.place_arm(variation.start)
        recorder.sample(REFERENCE, (0.0, 0.0, -7.0))

    return recorder, sample


def test_an_episode_begins_with_the_samples_and_repeats_the_last_to_the_full_length(push):
    recorder, sample = push
    sample(PRISM_START)
    sample(Pose(PRISM_GOAL, TOOL_DOWN))
    episode = recorder.episode(is_stopped=False)
    assert episode.times == pytest.approx(np.arange(121) / 10)
    assert episode.object_track[0, :3] == pytest.approx(PRISM_START.position)
    assert episode.object_track[[1, 60, 120], :3] == pytest.approx(np.tile(PRISM_GOAL, (3, 1)))
    assert (episode.reference_positions == REFERENCE).all()
    assert (episode.commanded_forces == (0.0, 0.0, -7.0)).all()
    assert episode.shift_of("block") == (0.001, 0.0, 0.0)
    assert episode.simulated_seconds == pytest.approx(0.1)
    assert episode.clearance == np.inf


@pytest.mark.parametrize(
    ("places", "success_time"),
    [
        pytest.param("goal start", None, id="lost again"),
        pytest.param("start goal goal", 0.1, id="kept"),
        pytest.param("goal start start goal", 0.3, id="found again"),
    ],
)
def test_success_is_that_the_final_condition_holds_from_some_time_on(push, places, success_time):
    recorder, sample = push
    poses = {"start": PRISM_START, "goal": Pose(PRISM_GOAL, TOOL_DOWN)}
    for place in places.split():
        sample(poses[place])
    expected = success_time if success_time is None else pytest.approx(success_time)
    assert recorder.episode(is_stopped=False).success_time == expected


def touch_the_table(simulation) -> Recorder:
    """Report 5 N on the tool and a touch of the table at every step of one tick, between two samples."""
    OBSTACLE.randomization.nominal("s0").apply(simulation)
    recorder = Recorder(OBSTACLE, simulation, {})
    recorder.sample(REFERENCE, NO_FORCE)
    simulation.sensor_history("deepest")[:] = simulation.sensor_history("touch_table")[:, 3:] = -0.002
    simulation.sensor_history("tool_force")[:] = (0.0, 3.0, 4.0)
    recorder.contacts.observe()
    recorder.sample(REFERENCE, NO_FORCE)
    return recorder


def test_a_touch_of_something_else_is_no_touch_of_the_obstacle(simulation):
    episode = touch_the_table(simulation).episode(is_stopped=False)
    assert 0.02 < episode.clearance < 0.5


def test_an_overlap_with_the_obstacle_between_samples_counts_for_the_clearance(simulation):
    recorder = touch_the_table(simulation)
    simulation.sensor_history("touch_engine")[3, 3] = -0.001
    recorder.contacts.observe()
    recorder.sample(REFERENCE, NO_FORCE)
    assert recorder.episode(is_stopped=False).clearance == -0.001


def test_a_contact_at_the_end_lasts_to_the_full_length(simulation):
    episode = touch_the_table(simulation).episode(is_stopped=False)
    assert episode.contact.seconds == pytest.approx(0.02 + 11.9)
    assert episode.tool_contact.impulse == pytest.approx(5.0 * (0.02 + 11.9))
    assert episode.interventions == 0


def test_a_robot_that_is_stopped_is_taken_out_of_contact(simulation):
    episode = touch_the_table(simulation).episode(is_stopped=True)
    assert episode.contact.seconds == pytest.approx(0.02)
    assert episode.tool_contact.impulse == pytest.approx(5.0 * 0.02)
    assert episode.interventions == 1


def test_a_simulation_that_diverged_has_no_episode(simulation):
    recorder = touch_the_table(simulation)
    simulation.data.qvel[0] = np.nan
    mujoco.mj_step(simulation.model, simulation.data)
    with pytest.raises(SimulationError, match="Nan, Inf or huge value in QVEL"):
        recorder.episode(is_stopped=False)
    simulation.reset()
