"""Tests for reference.py."""

import numpy as np
import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.plotting.reference import common_reference_point, number
from hypermap_lite.plotting.runs import load_runs
from tests.plotting.run_folders import write_run


def objectives(first=None, second=None):
    return (
        {"name": "gain", "goal": "maximize", "reference_point": first},
        {"name": "cost", "goal": "minimize", "reference_point": second},
    )


def runs_with(tmp_path, *specs):
    values = [[[10.0, 1.0], [20.0, 3.0], [5.0, 9.0]], [[30.0, 5.0]]]
    folders = [write_run(tmp_path / str(i), values[i], objectives=objectives(*spec)) for i, spec in enumerate(specs)]
    return load_runs(folders)


def test_scenarios_point_is_taken_in_the_users_units(tmp_path):
    reference = common_reference_point(runs_with(tmp_path, (1.0, 8.0)))
    assert reference.values.tolist() == [1.0, 8.0]
    assert str(reference) == "reference point: gain 1, cost 8"


def test_inferred_point_lies_beyond_the_nadir_of_all_runs_in_the_worse_direction(tmp_path):
    reference = common_reference_point(runs_with(tmp_path, (), ()))  # front (10, 1), (20, 3), (30, 5)
    np.testing.assert_allclose(reference.values, [8.0, 5.4])
    assert str(reference) == "inferred reference point: gain 8, cost 5.4"


def test_only_the_missing_values_are_inferred(tmp_path):
    reference = common_reference_point(runs_with(tmp_path, (None, 8.0)))
    np.testing.assert_allclose(reference.values, [9.0, 8.0])
    assert reference.is_inferred


def test_one_scenario_may_speak_for_all(tmp_path):
    reference = common_reference_point(runs_with(tmp_path, (1.0, 8.0), ()))
    assert reference.values.tolist() == [1.0, 8.0]
    assert not reference.is_inferred


def test_given_values_come_first(tmp_path):
    reference = common_reference_point(runs_with(tmp_path, (1.0, 8.0)), {"cost": 100.0})
    assert reference.values.tolist() == [1.0, 100.0]


def test_scenarios_that_disagree_are_an_error_unless_one_is_given(tmp_path):
    runs = runs_with(tmp_path, (1.0, 8.0), (2.0, 8.0))
    with pytest.raises(UsageError, match=r"reference points for 'gain' differ \(1, 2\)"):
        common_reference_point(runs)
    assert common_reference_point(runs, {"gain": 3.0}).values.tolist() == [3.0, 8.0]


def test_unknown_objective_is_an_error_with_the_nearest_name(tmp_path):
    with pytest.raises(UsageError, match=r"unknown objective 'gian'; known: gain, cost. Did you mean 'gain'"):
        common_reference_point(runs_with(tmp_path, ()), {"gian": 1.0})


def test_infinite_value_is_an_error(tmp_path):
    with pytest.raises(UsageError, match="'cost': expected a finite number, got inf"):
        common_reference_point(runs_with(tmp_path, ()), {"cost": np.inf})


@pytest.mark.parametrize(
    ("value", "text"),
    [(1234.56, "1235"), (-20000.0, "-20000"), (0.0, "0"), (0.0123449, "0.01234"), (1.5e9, "1.5e+09"), (3.0, "3")],
)
def test_numbers_are_written_for_people(value, text):
    assert number(value) == text


def test_numbers_keep_as_many_digits_as_asked():
    assert number(134.2, 2) == "130"
