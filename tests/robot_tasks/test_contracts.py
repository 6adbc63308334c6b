"""What must hold for every task and every reward in the tables, members to come included."""

import pickle

import numpy as np
import pytest

import robot_tasks
from robot_tasks.evaluation import evaluate
from robot_tasks.rewards import REWARDS, RewardTerm
from robot_tasks.simulation import Simulation
from robot_tasks.skills import Behaviour
from robot_tasks.tasks import TASKS

every_task = pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
ALL_TERMS = [pytest.param(term, id=f"{task.name}-{term.name}") for task in TASKS.values() for term in task.terms]


def middle(task):
    return {parameter.name: (parameter.low + parameter.high) / 2 for parameter in task.parameters}


@every_task
def test_every_task_has_an_evaluator_that_pickles_by_name(task):
    function = getattr(robot_tasks, task.name)
    assert pickle.loads(pickle.dumps(function)) is function


@every_task
def test_every_element_of_a_scene_has_a_name(task):
    simulation = Simulation.from_scene(task.scene)
    for kind in ("body", "joint", "geom", "site", "actuator", "camera", "sensor"):
        assert all(simulation.names(kind))


@every_task
def test_a_task_refers_only_to_what_its_scene_has(task):
    simulation = Simulation.from_scene(task.scene)
    if task.obstacle:
        simulation.id_of("geom", task.obstacle)
    if task.object_body:
        simulation.place_body(task.object_body, simulation.pose_of(task.object_body))
    for shift in task.randomization.shifts:
        body = simulation.id_of("body", shift.body)
        assert simulation.model.body_weldid[body] == 0


@every_task
def test_start_states_lie_within_the_joint_limits_and_touch_nothing(task):
    simulation = Simulation.from_scene(task.scene)
    for start in task.randomization.starts:
        task.randomization.nominal(start).apply(simulation)
        assert (np.abs(simulation.data.qpos[:7]) < simulation.model.jnt_range[:7, 1]).all()
        assert not simulation.data.nefc


@every_task
def test_the_tree_of_a_task_is_a_fresh_one_each_time(task):
    first, second = (task.build_tree(middle(task)) for _ in range(2))
    assert isinstance(first, Behaviour)
    assert first is not second


@every_task
@pytest.mark.parametrize("corner", ["low", "high"])
def test_evaluations_are_finite_and_deterministic_at_the_corners_of_the_box(task, corner):
    configuration = {parameter.name: getattr(parameter, corner) for parameter in task.parameters}
    first, second = (evaluate(task.name, configuration, seed=3) for _ in range(2))
    assert np.isfinite(list(first.values())).all()
    assert first == second


@every_task
def test_objectives_come_first_and_are_the_sums_of_their_terms(task):
    numbers = evaluate(task.name, middle(task), seed=1)
    assert list(numbers)[: len(task.objectives)] == list(task.objectives)
    for name, terms in task.objectives.items():
        assert numbers[name] == pytest.approx(sum(numbers[term.name] for term in terms))


@every_task
def test_names_of_columns_do_not_collide(task):
    names = [*task.objectives, *(term.name for term in task.terms), *(parameter.name for parameter in task.parameters)]
    assert len(names) == len(set(names))


@every_task
def test_seeds_reach_every_start_state(task):
    starts = {task.randomization.sample(np.random.default_rng(seed)).start for seed in range(100)}
    assert starts == set(task.randomization.starts.values())


@pytest.mark.parametrize("term", ALL_TERMS)
def test_a_reward_is_finite_anywhere_one_number_per_step_and_leaves_the_episode_alone(term, make_episode):
    tips = np.random.default_rng(0).uniform(-1.0, 1.5, (50, 3))
    episode = make_episode(tips.copy())
    rewards = term.reward(episode)
    assert rewards.shape == (49,)
    assert np.isfinite(rewards).all()
    assert (episode.tip_positions == tips).all()


@pytest.mark.parametrize("term", ALL_TERMS)
def test_the_last_sample_repeated_adds_the_same_reward_again(term, make_episode):
    tips = np.random.default_rng(0).uniform(-1.0, 1.5, (5, 3))
    rewards = term.reward(make_episode(np.vstack([tips, tips[-1:], tips[-1:]])))
    assert rewards[-1] == rewards[-2] == rewards[-3]


def test_every_reward_in_the_table_is_used_by_a_task():
    used = {type(term.reward) for task in TASKS.values() for term in task.terms}
    assert set(REWARDS.values()) == used
    assert all(isinstance(term, RewardTerm) for task in TASKS.values() for term in task.terms)
