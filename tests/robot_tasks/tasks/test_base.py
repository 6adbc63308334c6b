"""Tests for base.py: which configurations a task accepts."""

import numpy as np
import pytest

from robot_tasks.errors import ParameterError
from robot_tasks.tasks import TASKS
from tests.robot_tasks.conftest import OPERATOR_MEANS

TASK = TASKS["obstacle_avoidance"]


def test_a_complete_configuration_is_returned_as_floats_in_the_tasks_order():
    shuffled = dict(reversed(OPERATOR_MEANS.items())) | {"mp2_position_y": np.float64(0.0), "mp2_position_z": 1}
    checked = TASK.check(shuffled)
    assert list(checked.items()) == list(OPERATOR_MEANS.items())
    assert {type(value) for value in checked.values()} == {float}


def test_bounds_themselves_are_allowed():
    assert TASK.check(OPERATOR_MEANS | {"mp1_position_y": 1.5, "mp1_position_z": 0.5})["mp1_position_y"] == 1.5


def test_a_missing_parameter_is_named_with_its_range():
    incomplete = {name: value for name, value in OPERATOR_MEANS.items() if name != "mp2_threshold"}
    message = r"task 'obstacle_avoidance', parameter 'mp2_threshold': missing. Give a number in \[0.5, 1.5\] m."
    with pytest.raises(ParameterError, match=message):
        TASK.check(incomplete)


def test_an_unknown_parameter_is_named_with_those_known():
    with pytest.raises(
        ParameterError, match=r"'mp4_threshold': not a parameter of this task. Give only mp1_position_y, "
    ):
        TASK.check(OPERATOR_MEANS | {"mp4_threshold": 1.0})


@pytest.mark.parametrize("value", [0.49, 1.51, -1000.0])
def test_a_value_out_of_bounds_is_given_with_the_bounds(value):
    with pytest.raises(
        ParameterError, match=rf"'mp1_position_z': {value:g} is out of bounds. Give a number in \[0.5, "
    ):
        TASK.check(OPERATOR_MEANS | {"mp1_position_z": value})


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "1.0", True, None, [1.0]])
def test_what_is_not_a_finite_number_is_refused(value):
    with pytest.raises(ParameterError, match=r"'mp1_position_z': .* is not a finite number. Give a number in "):
        TASK.check(OPERATOR_MEANS | {"mp1_position_z": value})
