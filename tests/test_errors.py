"""Tests for errors.py."""

from __future__ import annotations

import pickle

import pytest

from hypermap_lite.errors import ScenarioError, nearest


def test_a_scenario_error_says_file_place_problem_allowed_and_remedy() -> None:
    error = ScenarioError("$.seed", "-1 is too small", allowed="an integer >= 0", hint="Drop the sign.", file="s.json")
    assert str(error).splitlines() == [
        "s.json: $.seed: -1 is too small",
        "  allowed: an integer >= 0",
        "  hint: Drop the sign.",
    ]


def test_below_moves_an_error_of_a_part_to_its_place() -> None:
    moved = ScenarioError("$.std", "0 is too small").below("$.input_parameters.x.prior")
    assert str(moved) == "$.input_parameters.x.prior.std: 0 is too small"


def test_within_keeps_the_file_an_error_already_knows() -> None:
    error = ScenarioError("$", "bad", file="base.json")
    assert error.within("child.json").file == "base.json"
    assert ScenarioError("$", "bad").within("child.json").file == "child.json"


def test_an_error_survives_pickling() -> None:
    error = ScenarioError("$", "bad", allowed="good", file="s.json")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        pytest.param("desgin", "Did you mean 'design'?", id="slip"),
        pytest.param("Design", "Did you mean 'design'?", id="case"),
        pytest.param("max", "Did you mean 'maximize'?", id="beginning"),
        pytest.param("design_type", "Did you mean 'design'?", id="more"),
        pytest.param("designs", "Did you mean 'design'?", id="plural"),
        pytest.param("designations_of_things", "", id="another word"),
        pytest.param("ei", "Did you mean 'expected_improvement'?", id="initials"),
        pytest.param("zzz", "", id="nothing_close"),
    ],
)
def test_nearest_understands_slips_beginnings_and_initials(given: str, expected: str) -> None:
    assert nearest(given, ["design", "maximize", "expected_improvement"]) == expected


@pytest.mark.parametrize(
    ("given", "expected"),
    [("type", "Did you mean 'parameter_type'?"), ("file", ""), ("ype", ""), ("_type", "")],
)
def test_nearest_understands_last_words_that_no_other_name_has(given: str, expected: str) -> None:
    assert nearest(given, ["parameter_type", "all_samples_file", "pareto_file", "values"]) == expected
