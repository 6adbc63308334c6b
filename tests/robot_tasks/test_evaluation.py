"""Tests for evaluation.py: one call, many calls, other threads and other processes."""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from robot_tasks import obstacle_avoidance
from robot_tasks.errors import ParameterError, UnknownNameError
from robot_tasks.evaluation import evaluate
from tests.robot_tasks.conftest import LOWERED_ONTO_THE_ENGINE, OPERATOR_MEANS, STRAIGHT_THROUGH_THE_ENGINE

IN_A_FRESH_PROCESS = """
import json, robot_tasks, sys
print(json.dumps(robot_tasks.obstacle_avoidance(json.loads(sys.argv[1]), seed=int(sys.argv[2]))))
"""


def test_the_evaluator_reports_objectives_terms_and_summary():
    assert list(obstacle_avoidance(OPERATOR_MEANS)) == [
        "performance",
        "safety",
        "success_bonus",
        "goal_distance",
        "table_avoidance",
        "engine_avoidance",
        "success",
        "time_to_success",
        "touches",
        "contact_seconds",
        "peak_contact_force",
        "deepest_penetration",
        "clearance",
        "tool_peak_force",
        "tool_mean_force",
        "tool_impulse",
        "commanded_impulse",
        "simulated_seconds",
    ]


def test_all_numbers_are_plain_floats():
    assert {type(value) for value in obstacle_avoidance(OPERATOR_MEANS).values()} == {float}


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


def test_seeds_change_the_circumstances():
    results = [obstacle_avoidance(OPERATOR_MEANS, seed=seed)["safety"] for seed in range(7)]
    assert len(set(results)) == 7
    assert np.std(results) < 0.2 * abs(np.mean(results))


def test_nothing_that_ran_before_has_an_influence():
    first = obstacle_avoidance(OPERATOR_MEANS, seed=4)
    for seed, parameters in enumerate((STRAIGHT_THROUGH_THE_ENGINE, LOWERED_ONTO_THE_ENGINE)):
        obstacle_avoidance(parameters, seed=seed)
        assert obstacle_avoidance(OPERATOR_MEANS, seed=4) == first


def test_a_fresh_process_computes_the_same_bits():
    arguments = [sys.executable, "-c", IN_A_FRESH_PROCESS, json.dumps(STRAIGHT_THROUGH_THE_ENGINE), "5"]
    output = subprocess.run(arguments, capture_output=True, text=True, check=True).stdout
    assert json.loads(output) == obstacle_avoidance(STRAIGHT_THROUGH_THE_ENGINE, seed=5)


def test_threads_do_not_share_a_simulation():
    alone = [obstacle_avoidance(OPERATOR_MEANS, seed=seed) for seed in range(4)]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(lambda seed: obstacle_avoidance(OPERATOR_MEANS, seed=seed), range(4)))
    assert together == alone


def test_a_wrong_configuration_is_refused_before_anything_runs():
    with pytest.raises(ParameterError, match="'mp1_position_z': 9 is out of bounds"):
        obstacle_avoidance(OPERATOR_MEANS | {"mp1_position_z": 9.0})


def test_an_unknown_task_is_named_with_those_known():
    with pytest.raises(UnknownNameError, match=r"unknown task 'peg'. Known: obstacle_avoidance"):
        evaluate("peg", {})


def test_importing_the_package_loads_neither_mujoco_nor_numpy():
    program = "import robot_tasks, sys; print([name for name in ('mujoco', 'numpy') if name in sys.modules])"
    output = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert output.strip() == "[]"
