"""Tests for obstacle_avoidance.py: magnitudes of its objectives and how good and bad parameters fare."""

from dataclasses import replace

import numpy as np
import pytest

from robot_tasks.evaluation import measure
from robot_tasks.rollout import rollout
from robot_tasks.tasks.obstacle_avoidance import (
    ENGINE,
    GOAL,
    OBSTACLE_AVOIDANCE,
    OBSTACLE_AVOIDANCE_PUBLISHED,
    STARTS,
    TABLE,
)
from tests.robot_tasks.conftest import LOWERED_ONTO_THE_ENGINE, OPERATOR_MEANS, STRAIGHT_THROUGH_THE_ENGINE

TASK = OBSTACLE_AVOIDANCE


def run(simulation, parameters, start="s0"):
    return rollout(TASK, parameters, TASK.randomization.nominal(start), simulation)


def test_an_episode_spent_at_the_goal_has_the_published_value(make_episode):
    numbers = measure(TASK, make_episode([GOAL] * 121, success_time=0.0))
    assert numbers["success_bonus"] == 960.0
    assert numbers["goal_distance"] == pytest.approx(120 * 22.89, abs=0.5)
    assert numbers["performance"] == pytest.approx(960.0 + 120 * 22.89, abs=0.5)
    assert numbers["table_avoidance"] == pytest.approx(120 * -1.268, abs=0.05)


def test_an_episode_spent_inside_the_engine_has_the_published_charge(make_episode):
    numbers = measure(TASK, make_episode([(-0.5, 0.3, 0.7)] * 121))
    assert numbers["engine_avoidance"] == pytest.approx(120 * -238.1, abs=5.0)
    assert numbers["safety"] == numbers["engine_avoidance"] + numbers["table_avoidance"]


def test_the_reward_boxes_are_those_of_the_scene(simulation):
    simulation.reset()
    simulation.place_arm(STARTS["s0"])
    for name, box in (("engine", ENGINE), ("table", TABLE)):
        geom = simulation.id_of("geom", name)
        top = simulation.data.geom_xpos[geom, 2] + simulation.model.geom_size[geom, 2]
        assert top == pytest.approx(box.high[2], abs=1.1e-3)


@pytest.mark.parametrize("start", STARTS)
def test_the_operators_parameters_reach_the_goal_without_touching_anything(simulation, start):
    episode = run(simulation, OPERATOR_MEANS, start)
    assert episode.is_success
    assert 6.5 < episode.success_time < 8.0
    assert episode.contact.touches == 0
    assert episode.clearance > 0.02


@pytest.mark.parametrize("start", STARTS)
def test_the_arm_keeps_its_shape_and_distance_from_its_joint_limits(simulation, start):
    joints = run(simulation, OPERATOR_MEANS, start).joint_positions
    limits = simulation.model.jnt_range[:, 1]
    assert (limits - np.abs(joints)).min() > 0.1
    assert (joints[:, 3] < -0.3).all()  # the elbow never stretches out and flips


def test_heading_straight_for_the_goal_gets_stuck_at_the_engine(simulation):
    episode = run(simulation, STRAIGHT_THROUGH_THE_ENGINE)
    assert not episode.is_success
    assert episode.contact.touches >= 1
    assert episode.contact.seconds > 5.0


def test_lowering_the_forearm_onto_the_engine_is_a_touch_and_not_a_success(simulation):
    episode = run(simulation, LOWERED_ONTO_THE_ENGINE)
    assert not episode.is_success
    assert episode.contact.touches >= 1
    assert episode.contact.deepest_penetration < 1e-3


def test_a_collision_with_the_engine_improves_no_objective(simulation):
    good, bad = (measure(TASK, run(simulation, p)) for p in (OPERATOR_MEANS, STRAIGHT_THROUGH_THE_ENGINE))
    assert bad["performance"] < good["performance"]
    assert bad["safety"] < good["safety"]


@pytest.mark.parametrize("bad", [STRAIGHT_THROUGH_THE_ENGINE, LOWERED_ONTO_THE_ENGINE])
def test_a_collision_ends_no_charge(simulation, bad):
    episode = run(simulation, bad)
    for term in TASK.objectives["safety"]:
        rewards = term.reward(episode)
        assert len(rewards) == 120
        assert (rewards < 0.0).all()
        assert rewards[-1] == pytest.approx(rewards[60], rel=1e-2)


def test_the_charge_knows_where_the_engine_is(make_episode):
    beside_the_engine = make_episode([(-0.48, 0.03, 0.7)] * 2, shifts={"engine": (0.02, -0.02, 0.0)})
    charge = measure(TASK, beside_the_engine)["engine_avoidance"]
    assert charge == pytest.approx(-1.5 / (7.0 * (0.1 + 0.03) ** 2))
    published_charge = measure(OBSTACLE_AVOIDANCE_PUBLISHED, beside_the_engine)["engine_avoidance"]
    assert published_charge == pytest.approx(-1.5 / (7.0 * (0.12 + 0.03) ** 2))


def test_the_published_code_differs_in_what_the_charge_knows_of_the_engine_alone():
    table, engine = TASK.objectives["safety"]
    blind = replace(engine, reward=replace(engine.reward, follows=None))
    assert engine.reward.follows == "engine"
    assert replace(TASK, objectives=TASK.objectives | {"safety": (table, blind)}) == OBSTACLE_AVOIDANCE_PUBLISHED


@pytest.mark.parametrize("start", STARTS)
def test_the_means_of_the_misleading_prior_do_not_reach_the_goal_and_touch_the_engine(simulation, start):
    misleading = {
        "mp1_position_y": 0.0,
        "mp1_position_z": 0.6,
        "mp2_position_y": 0.0,
        "mp2_position_z": 0.6,
        "mp2_threshold": 0.5,
        "mp3_threshold": 1.2,
    }
    episode = run(simulation, misleading, start)
    assert not episode.is_success
    assert episode.contact.touches >= 1
