"""Tests for errors.py."""

from robot_tasks.errors import ParameterError, RobotTasksError, SimulationError, UnknownNameError


def test_unknown_name_lists_what_exists_and_suggests_the_closest():
    message = str(UnknownNameError("site", "tipp", ["world", "tip"]))
    assert message == "unknown site 'tipp'. Known: tip, world. Did you mean 'tip'?"


def test_unknown_name_without_a_close_one_suggests_nothing():
    assert str(UnknownNameError("site", "zzz", ["tip"])) == "unknown site 'zzz'. Known: tip."


def test_parameter_error_names_task_parameter_problem_and_remedy():
    message = str(ParameterError("lift", "height", "missing", "a number in [0, 1] m"))
    assert message == "task 'lift', parameter 'height': missing. Give a number in [0, 1] m."


def test_errors_are_also_the_matching_built_in_errors():
    assert (RobotTasksError, LookupError) == UnknownNameError.__bases__
    assert (RobotTasksError, ValueError) == ParameterError.__bases__
    assert (RobotTasksError, RuntimeError) == SimulationError.__bases__
