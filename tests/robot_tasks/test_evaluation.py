"""Tests for evaluation.py: one call, many calls, other simulations, threads and processes."""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from robot_tasks import obstacle_avoidance
from robot_tasks.errors import ParameterError, UnknownNameError
from robot_tasks.evaluation import VARIANTS, evaluate, find_task, load, measure
from robot_tasks.rollout import rollout
from robot_tasks.tasks import TASKS
from tests.robot_tasks.conftest import (
    GOOD_PARAMETERS,
    LOWERED_ONTO_THE_ENGINE,
    OPERATOR_MEANS,
    PUSHES_PAST_THE_CORNER,
    STANDS_ON_THE_BLOCK,
    STRAIGHT_THROUGH_THE_ENGINE,
)

every_case = pytest.mark.parametrize(
    ("task", "variant"),
    [
        pytest.param(task, variant, id=f"{variant}-{task}")
        for variant, tasks in VARIANTS.items()
        for task in GOOD_PARAMETERS
        if task in tasks
    ],
)
OTHERS = {
    "peg_insertion": STANDS_ON_THE_BLOCK,
    "object_pushing": PUSHES_PAST_THE_CORNER,
    "obstacle_avoidance": STRAIGHT_THROUGH_THE_ENGINE,
}

IN_A_FRESH_PROCESS = """
import json, sys
from robot_tasks.evaluation import evaluate
calls = json.load(sys.stdin)
json.dump([evaluate(task, parameters, seed=5, variant=variant) for task, parameters, variant in calls], sys.stdout)
"""

SUMMARY = [
    "success",
    "time_to_success",
    "touches",
    "contact_seconds",
    "peak_contact_force",
    "deepest_penetration",
    "tool_peak_force",
    "tool_mean_force",
    "tool_impulse",
    "commanded_impulse",
    "interventions",
    "simulated_seconds",
]
OBJECTIVES_AND_TERMS = {
    "peg_insertion": [
        "insertion_reward",
        "force",
        "success_bonus",
        "goal_distance",
        "hole_distance",
        "commanded_force",
    ],
    "object_pushing": [
        "object_push",
        "force",
        "tip_distance",
        "object_position",
        "object_orientation",
        "tracking_force",
    ],
    "obstacle_avoidance": [
        "performance",
        "safety",
        "success_bonus",
        "goal_distance",
        "table_avoidance",
        "engine_avoidance",
    ],
}


@pytest.mark.parametrize("task", GOOD_PARAMETERS)
def test_the_evaluator_reports_objectives_terms_and_summary(task):
    columns = list(evaluate(task, GOOD_PARAMETERS[task]))
    assert columns[:6] == OBJECTIVES_AND_TERMS[task]
    assert [name for name in columns[6:] if name != "clearance"] == SUMMARY


def test_a_clearance_is_reported_where_there_is_an_obstacle():
    reported = {task for task in GOOD_PARAMETERS if "clearance" in evaluate(task, GOOD_PARAMETERS[task])}
    assert reported == {"obstacle_avoidance"}


@every_case
def test_good_parameters_succeed_as_the_paper_and_its_code_have_it_and_the_real_robot_may_differ(task, variant):
    numbers = evaluate(task, GOOD_PARAMETERS[task], seed=1, variant=variant)
    assert numbers["success"] == 1.0 or variant == "real"


def test_a_success_is_reported_with_its_time():
    numbers = obstacle_avoidance(OPERATOR_MEANS, seed=1)
    assert numbers["success"] == 1.0
    assert 6.5 < numbers["time_to_success"] < 8.0
    assert numbers["touches"] == numbers["contact_seconds"] == numbers["peak_contact_force"] == 0.0


def test_a_failure_is_reported_with_the_length_of_the_episode_and_its_contacts():
    numbers = obstacle_avoidance(STRAIGHT_THROUGH_THE_ENGINE, seed=1)
    assert numbers["success"] == 0.0
    assert numbers["time_to_success"] == 12.0
    assert numbers["touches"] >= 1.0
    assert numbers["peak_contact_force"] > 10.0
    assert numbers["clearance"] <= 0.0


def test_the_commanded_impulse_is_the_force_times_its_duration(make_episode):
    forces = [(0.0, 0.0, 0.0), *[(0.0, 3.0, -4.0)] * 30, *[(0.0, 0.0, 0.0)] * 150]
    numbers = measure(TASKS["peg_insertion"], make_episode(np.zeros((181, 3)), commanded_forces=forces))
    assert numbers["commanded_impulse"] == pytest.approx(5.0 * 3.0)


@pytest.mark.parametrize("task", GOOD_PARAMETERS)
def test_seeds_change_the_circumstances(task):
    results = {tuple(evaluate(task, GOOD_PARAMETERS[task], seed=seed).values()) for seed in range(5)}
    assert len(results) == 5


def test_circumstances_change_the_safety_of_good_parameters_by_less_than_a_fifth():
    results = [obstacle_avoidance(OPERATOR_MEANS, seed=seed)["safety"] for seed in range(7)]
    assert 0.0 < np.std(results) < 0.2 * abs(np.mean(results))


@pytest.mark.parametrize("task", GOOD_PARAMETERS)
def test_nothing_that_ran_before_has_an_influence(task):
    first = evaluate(task, GOOD_PARAMETERS[task], seed=4)
    evaluate(task, OTHERS[task], seed=0)
    evaluate("obstacle_avoidance", LOWERED_ONTO_THE_ENGINE, seed=1)
    assert evaluate(task, GOOD_PARAMETERS[task], seed=4) == first


@every_case
def test_a_fresh_simulation_gives_the_same_trajectory_bit_for_bit(task, variant):
    found = find_task(task, variant)
    used, fresh = load(found), load(found)
    rollout(found, OTHERS[task], found.randomization.sample(np.random.default_rng(0)), used)
    variation = found.randomization.sample(np.random.default_rng(5))
    episodes = [rollout(found, GOOD_PARAMETERS[task], variation, simulation) for simulation in (used, fresh)]
    for array in ("tip_positions", "reference_positions", "joint_positions", "commanded_forces", "object_poses"):
        first, second = (getattr(episode, array) for episode in episodes)
        assert np.array_equal(first, second)
    assert measure(found, episodes[0]) == measure(found, episodes[1])


def test_a_fresh_process_computes_the_same_bits():
    calls = [(task, OTHERS[task], variant) for task in OTHERS for variant in VARIANTS]
    arguments = [sys.executable, "-c", IN_A_FRESH_PROCESS]
    output = subprocess.run(arguments, input=json.dumps(calls), capture_output=True, text=True, check=True).stdout
    here = [evaluate(task, parameters, seed=5, variant=variant) for task, parameters, variant in reversed(calls)]
    assert json.loads(output) == here[::-1]


@pytest.mark.parametrize("task", GOOD_PARAMETERS)
def test_threads_do_not_share_a_simulation(task):
    alone = [evaluate(task, GOOD_PARAMETERS[task], seed=seed) for seed in (0, 1)]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(lambda seed: evaluate(task, GOOD_PARAMETERS[task], seed=seed), (0, 1)))
    assert together == alone


def test_a_wrong_configuration_is_refused_before_anything_runs():
    with pytest.raises(ParameterError, match="'mp1_position_z': 9 is out of bounds"):
        obstacle_avoidance(OPERATOR_MEANS | {"mp1_position_z": 9.0})


def test_an_unknown_task_is_named_with_those_known():
    with pytest.raises(UnknownNameError, match=r"unknown task 'peg'. Known: .*, peg_insertion\."):
        evaluate("peg", {})


def test_an_unknown_variant_is_named_with_those_known():
    with pytest.raises(UnknownNameError, match=r"unknown variant 'reel'. Known: .*real\. Did you mean 'real'"):
        evaluate("peg_insertion", {}, variant="reel")


def test_importing_the_package_loads_neither_mujoco_nor_numpy():
    program = "import robot_tasks, sys; print([name for name in ('mujoco', 'numpy') if name in sys.modules])"
    output = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert output.strip() == "[]"
