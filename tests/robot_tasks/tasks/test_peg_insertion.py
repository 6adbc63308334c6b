"""Tests for peg_insertion.py: magnitudes of its objectives, its geometry, and how good and bad parameters fare."""

from dataclasses import replace

import numpy as np
import pytest

from robot_tasks.evaluation import measure
from robot_tasks.motion import ArchimedesSpiral, SteppedSpiral
from robot_tasks.randomization import Variation
from robot_tasks.rollout import rollout
from robot_tasks.tasks.peg_insertion import GOAL, HOLE, MOUTH, PEG_INSERTION, PEG_INSERTION_PUBLISHED, STARTS
from tests.robot_tasks.conftest import SEARCHES_FOR_THE_HOLE, STANDS_ON_THE_BLOCK
from tests.robot_tasks.skills.scripted import context

TASK = PEG_INSERTION
every_start = pytest.mark.parametrize("start", STARTS)


def run(simulation, parameters, start="s0", *, block=(0.0, 0.0, 0.0), task=TASK):
    return rollout(task, parameters, Variation(start=STARTS[start], shifts={"block": block}), simulation)


def test_an_episode_spent_at_the_mouth_of_the_hole_has_the_published_value(make_episode):
    numbers = measure(TASK, make_episode([MOUTH] * 181, success_time=0.0))
    assert numbers["success_bonus"] == 180 * 8.0
    assert numbers["goal_distance"] == pytest.approx(180 * 22.89, abs=0.5)
    assert numbers["force"] == 0.0


def test_an_episode_spent_in_the_hole_has_the_published_value(make_episode):
    numbers = measure(TASK, make_episode([GOAL] * 181, success_time=0.0))
    assert numbers["hole_distance"] == pytest.approx(180 * 12.5)
    assert numbers["goal_distance"] == pytest.approx(180 * 22.734, abs=0.5)  # 47 mm below the mouth
    assert numbers["insertion_reward"] == pytest.approx(180 * (8.0 + 22.734 + 12.5), abs=0.5)


def test_an_episode_spent_far_away_has_the_published_value(make_episode):
    numbers = measure(TASK, make_episode([(-0.6, 0.0, 1.0)] * 181))
    assert numbers["goal_distance"] == pytest.approx(180 * 17.28, abs=0.5)
    assert numbers["hole_distance"] == pytest.approx(180 * 0.15 / (2.0 * 0.307))
    assert numbers["success_bonus"] == 0.0


def test_a_whole_episode_of_pressing_costs_ten_times_its_force(make_episode):
    forces = np.tile((0.0, 0.0, -7.0), (181, 1))
    numbers = measure(TASK, make_episode([GOAL] * 181, commanded_forces=forces))
    assert numbers["force"] == numbers["commanded_force"] == pytest.approx(-10.0 * 7.0 * 180)


def test_the_goals_of_the_rewards_are_in_the_hole_of_the_scene(peg_simulation):
    TASK.randomization.nominal("s0").apply(peg_simulation)
    rim = peg_simulation.pose_of("hole").position
    assert peg_simulation.pose_of("goal").position == pytest.approx(GOAL)
    assert peg_simulation.pose_of("block").position == pytest.approx(GOAL)
    assert rim == pytest.approx((-0.6, 0.0, 0.703))
    assert pytest.approx((rim[0], rim[1], rim[2] - 0.003)) == MOUTH
    assert np.mean([HOLE.low, HOLE.high], axis=0)[:2] == pytest.approx(rim[:2])


@every_start
def test_an_arm_starts_30_centimetres_above_the_rim_with_the_tool_down(peg_simulation, start):
    TASK.randomization.nominal(start).apply(peg_simulation)
    x, y, z = peg_simulation.site_position("tool_tip")
    assert np.hypot(x + 0.6, y) < 0.088
    assert z - 0.703 == pytest.approx(0.3, abs=0.01)
    assert np.abs(peg_simulation.pose_of("tool_tip").quaternion) == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=0.016)


@pytest.mark.parametrize("seed", range(6))
def test_a_fine_search_finds_the_hole(peg_simulation, seed):
    variation = TASK.randomization.sample(np.random.default_rng(seed))
    episode = rollout(TASK, SEARCHES_FOR_THE_HOLE, variation, peg_simulation)
    assert episode.is_success
    assert episode.success_time < 10.0
    assert episode.contact.touches == 0


@every_start
def test_without_a_search_the_peg_stands_on_the_block_beside_the_hole(peg_simulation, start):
    episode = run(peg_simulation, STANDS_ON_THE_BLOCK, start, block=(0.007, -0.007, 0.0))
    assert not episode.is_success
    assert episode.tip_positions[-1, 2] == pytest.approx(0.703, abs=1e-4)
    assert episode.tool_contact.seconds > 10.0


@every_start
@pytest.mark.parametrize("block", [(0.007, -0.007, 0.0), (-0.007, 0.007, 0.0)])
def test_a_search_finds_a_hole_that_is_off_by_the_most(peg_simulation, start, block):
    assert run(peg_simulation, SEARCHES_FOR_THE_HOLE, start, block=block).is_success


def test_the_inserted_peg_is_led_to_its_goal_or_as_near_as_the_hole_lets_it(peg_simulation):
    in_place = run(peg_simulation, SEARCHES_FOR_THE_HOLE).tip_positions[-1]
    shifted = run(peg_simulation, SEARCHES_FOR_THE_HOLE, block=(0.007, 0.0, 0.0)).tip_positions[-1]
    assert in_place == pytest.approx(GOAL, abs=1e-4)
    assert shifted[:2] == pytest.approx((-0.6 + 0.007 - 0.0015, 0.0), abs=5e-4)


def test_the_force_is_charged_as_it_was_commanded_until_the_success(peg_simulation):
    episode = run(peg_simulation, SEARCHES_FOR_THE_HOLE)
    forces = episode.commanded_forces[:, 2]
    time = episode.success_time
    assert (forces[episode.times > time + 0.8] == 0.0).all()
    assert (forces[(episode.times > 0.8) & (episode.times < time)] == -7.0).all()
    assert measure(TASK, episode)["force"] == pytest.approx(10.0 * forces[1:].sum())


def test_a_search_that_fails_is_worth_less_in_both_objectives(peg_simulation):
    good, bad = (
        measure(TASK, run(peg_simulation, parameters, block=(0.007, -0.007, 0.0)))
        for parameters in (SEARCHES_FOR_THE_HOLE, STANDS_ON_THE_BLOCK)
    )
    assert bad["insertion_reward"] < good["insertion_reward"] - 2000.0
    assert bad["force"] < good["force"] - 5000.0


def test_rewards_know_where_the_hole_is(peg_simulation, make_episode):
    block = (0.007, -0.007, 0.0)
    in_the_hole = [(GOAL[0] + 0.007, GOAL[1] - 0.007, GOAL[2])] * 3
    shifted = measure(TASK, make_episode(in_the_hole, shifts={"block": block}))
    assert shifted == pytest.approx(measure(TASK, make_episode([GOAL] * 3)))
    published = measure(PEG_INSERTION_PUBLISHED, make_episode(in_the_hole, shifts={"block": block}))
    assert published["hole_distance"] == pytest.approx(2 * 0.15 / (2.0 * (np.hypot(0.006, 0.006) + 0.006)))


def test_the_published_code_differs_in_spiral_shift_and_what_rewards_know():
    mended = replace(
        PEG_INSERTION_PUBLISHED,
        build_tree=TASK.build_tree,
        objectives=TASK.objectives,
        randomization=replace(PEG_INSERTION_PUBLISHED.randomization, shifts=TASK.randomization.shifts),
    )
    assert mended == TASK
    (ours,), (theirs,) = TASK.randomization.shifts, PEG_INSERTION_PUBLISHED.randomization.shifts
    assert theirs == replace(ours, sigma=0.008)


def test_the_published_rewards_are_the_same_but_for_following_the_block():
    bonus, *located = TASK.objectives["insertion_reward"]
    blind = (replace(term, reward=replace(term.reward, follows=None)) for term in located)
    assert {term.reward.follows for term in located} == {"block"}
    assert PEG_INSERTION_PUBLISHED.objectives == TASK.objectives | {"insertion_reward": (bonus, *blind)}


@pytest.mark.parametrize(("task", "kind"), [(TASK, ArchimedesSpiral), (PEG_INSERTION_PUBLISHED, SteppedSpiral)])
def test_the_skill_asks_for_the_spiral_and_the_force_of_its_parameters(task, kind):
    here = context((-0.6, 0.0, 1.0))
    task.build_tree(SEARCHES_FOR_THE_HOLE).tick(here)
    assert here.overlay == kind(pitch=0.005, speed=0.05, radius=0.012)
    assert here.force == (0.0, 0.0, -7.0)
    assert here.goal.position == GOAL
