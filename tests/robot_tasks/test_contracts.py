"""What must hold for every task, every variant of it and every reward in the tables, members to come included."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

import robot_tasks
from robot_tasks import RolloutFunction
from robot_tasks.errors import UnknownNameError
from robot_tasks.evaluation import VARIANTS, evaluate, find_task, load
from robot_tasks.names import N_JOINTS, TOOL
from robot_tasks.rewards import REWARDS, RewardTerm
from robot_tasks.rollout import rollout
from robot_tasks.simulation import Simulation
from robot_tasks.skills import Behaviour
from robot_tasks.tasks import PUBLISHED, TASKS
from tests.robot_tasks.skills.scripted import RUNNING, Scripted

every_task = pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
every_variant = pytest.mark.parametrize(
    ("variant", "task"),
    [
        pytest.param(variant, task, id=f"{variant}-{name}")
        for variant, tasks in VARIANTS.items()
        for name, task in tasks.items()
    ],
)
every_term = pytest.mark.parametrize(
    ("task", "term"),
    [
        pytest.param(task, term, id=f"{variant}-{task.name}-{term.name}")
        for variant, tasks in (("paper", TASKS), ("published_code", PUBLISHED))
        for task in tasks.values()
        for term in task.terms
    ],
)


def middle(task):
    return {parameter.name: (parameter.low + parameter.high) / 2 for parameter in task.parameters}


@pytest.fixture
def make_random_episode(make_episode):
    """Make an episode with tip, reference, forces and, if the task has one, object anywhere."""

    def make(task, n_samples, n_repeated=0):
        rng = np.random.default_rng(0)
        table = rng.uniform(-1.0, 1.5, (n_samples, 16))
        table[:, 12:] /= np.linalg.norm(table[:, 12:], axis=1, keepdims=True)
        table = np.vstack([table, *[table[-1:]] * n_repeated])
        return make_episode(
            table[:, 0:3],
            reference_positions=table[:, 3:6],
            commanded_forces=table[:, 6:9],
            object_poses=table[:, 9:] if task.object_body else None,
            shifts={body: (0.01, -0.01, 0.0) for shift in task.randomization.shifts for body in shift.bodies},
        )

    return make


def arm_contacts(simulation):
    """Distances of present contacts in which the arm or the tool takes part."""
    model, contacts = simulation.model, simulation.data.contact
    root = model.body_rootid[simulation.id_of("body", TOOL)]
    is_arm = model.body_rootid[model.geom_bodyid[contacts.geom]] == root  # (n_contacts, 2)
    return contacts.dist[is_arm.any(axis=1)]


def test_every_variant_of_every_task_is_a_function_by_name():
    suffixes = {"paper": "", "published_code": "_as_published_code", "real": "_real"}
    for variant, tasks in VARIANTS.items():
        for name in tasks:
            assert getattr(robot_tasks, name + suffixes[variant]) == RolloutFunction(name, variant)


def test_a_task_that_was_just_added_is_a_function_too(monkeypatch):
    mine = replace(TASKS["obstacle_avoidance"], name="a_task_of_mine")
    monkeypatch.setitem(VARIANTS, "paper", {**TASKS, "a_task_of_mine": mine})
    assert robot_tasks.a_task_of_mine == RolloutFunction("a_task_of_mine")
    with pytest.raises(AttributeError, match="module 'robot_tasks' has no attribute 'a_task_of_mine_real'"):
        robot_tasks.a_task_of_mine_real  # noqa: B018


def test_a_task_without_a_variant_says_which_it_has(monkeypatch):
    monkeypatch.setitem(VARIANTS, "real", {})
    with pytest.raises(UnknownNameError, match=r"variant of task 'peg_insertion' 'real'. Known: paper, published_code"):
        find_task("peg_insertion", "real")


@every_variant
def test_every_evaluator_pickles(variant, task):
    function = RolloutFunction(task.name, variant)
    assert pickle.loads(pickle.dumps(function)) == function


def test_variants_are_of_tasks_that_exist_with_the_same_parameters_objectives_and_columns():
    for tasks in VARIANTS.values():
        assert set(tasks) <= set(TASKS)
        for name, task in tasks.items():
            assert task.parameters == TASKS[name].parameters
            assert list(task.objectives) == list(TASKS[name].objectives)
            assert [term.name for term in task.terms] == [term.name for term in TASKS[name].terms]


@every_task
def test_every_element_of_a_scene_has_a_name(task):
    simulation = Simulation.from_scene(task.scene)
    for kind in ("body", "joint", "geom", "site", "actuator", "camera", "sensor"):
        assert all(simulation.names(kind))


@every_variant
def test_a_task_refers_only_to_what_its_scene_has(variant, task):
    simulation = load(task)
    named = {"geom": {task.obstacle} - {None}, "body": {getattr(term.reward, "follows", None) for term in task.terms}}
    assert named["geom"] <= set(simulation.names("geom"))
    assert named["body"] - {None} <= set(simulation.names("body"))
    assert {placement.body for placement in task.randomization.objects} == {task.object_body} - {None}
    for placement in task.randomization.objects:
        simulation.place_body(placement.body, placement.pose)
    for shift in task.randomization.shifts:
        assert not any(simulation.model.body_weldid[simulation.id_of("body", body)] for body in shift.bodies)


@every_task
def test_rewards_follow_only_bodies_that_are_shifted(task):
    shifted = {body for shift in task.randomization.shifts for body in shift.bodies}
    assert {getattr(term.reward, "follows", None) for term in task.terms} <= shifted | {None}


@every_variant
def test_start_states_lie_within_the_joint_limits(variant, task):
    simulation = load(task)
    for start in task.randomization.starts.values():
        assert (np.abs(start) < simulation.model.jnt_range[:N_JOINTS, 1]).all()


@every_variant
def test_whatever_the_seed_arm_and_tool_start_without_a_contact_and_nothing_overlaps(variant, task):
    simulation = load(task)
    variations = [task.randomization.nominal(start) for start in task.randomization.starts]
    variations += [task.randomization.sample(np.random.default_rng(seed)) for seed in range(20)]
    for variation in variations:
        variation.apply(simulation)
        assert (arm_contacts(simulation) > 0.0).all()
        assert (simulation.data.contact.dist > -1e-6).all()  # what lies on a table touches it


@every_variant
def test_a_scene_at_rest_reports_no_touch_no_force_and_no_intervention(variant, task):
    idle = replace(task, build_tree=lambda parameters: Scripted(RUNNING))
    for seed in range(3):
        variation = task.randomization.sample(np.random.default_rng(seed))
        episode = rollout(idle, {}, variation, load(task))
        assert (episode.contact.touches, episode.tool_contact.seconds, episode.interventions) == (0, 0.0, 0)
        assert not episode.is_success


@every_task
def test_the_tree_of_a_task_is_a_fresh_one_each_time(task):
    first, second = (task.build_tree(middle(task)) for _ in range(2))
    assert isinstance(first, Behaviour)
    assert first is not second


@every_variant
@pytest.mark.parametrize("corner", ["low", "high"])
def test_evaluations_are_finite_and_deterministic_at_the_corners_of_the_box(variant, task, corner):
    configuration = {parameter.name: getattr(parameter, corner) for parameter in task.parameters}
    first, second = (evaluate(task.name, configuration, seed=3, variant=variant) for _ in range(2))
    assert np.isfinite(list(first.values())).all()
    assert first == second


@every_variant
def test_objectives_come_first_and_are_the_sums_of_their_terms(variant, task):
    numbers = evaluate(task.name, middle(task), seed=1, variant=variant)
    assert list(numbers)[: len(task.objectives)] == list(task.objectives)
    for name, terms in task.objectives.items():
        assert numbers[name] == pytest.approx(sum(numbers[term.name] for term in terms))


@every_variant
def test_all_numbers_are_plain_floats(variant, task):
    assert {type(value) for value in evaluate(task.name, middle(task), variant=variant).values()} == {float}


@every_task
def test_names_of_columns_do_not_collide(task):
    names = [*task.objectives, *(term.name for term in task.terms), *(parameter.name for parameter in task.parameters)]
    assert len(names) == len(set(names))


@every_variant
def test_seeds_reach_every_start_state(variant, task):
    starts = {task.randomization.sample(np.random.default_rng(seed)).start for seed in range(100)}
    assert starts == set(task.randomization.starts.values())


@every_term
def test_a_reward_is_finite_anywhere_one_number_per_step_and_leaves_the_episode_alone(task, term, make_random_episode):
    episode, untouched = (make_random_episode(task, 50) for _ in range(2))
    rewards = term.reward(episode)
    assert rewards.shape == (49,)
    assert np.isfinite(rewards).all()
    for array in ("tip_positions", "reference_positions", "commanded_forces", "object_poses"):
        assert np.array_equal(getattr(episode, array), getattr(untouched, array))


@every_term
def test_the_last_sample_repeated_adds_the_same_reward_again(task, term, make_random_episode):
    rewards = term.reward(make_random_episode(task, 5, n_repeated=2))
    assert rewards[-1] == rewards[-2] == rewards[-3]


def test_every_reward_in_the_table_is_used_by_a_task():
    terms = [term for tasks in (TASKS, PUBLISHED) for task in tasks.values() for term in task.terms]
    assert {type(term.reward) for term in terms} == set(REWARDS.values())
    assert all(isinstance(term, RewardTerm) for term in terms)
