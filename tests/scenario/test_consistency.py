"""Tests for consistency.py; its messages are tested over all of `bad_scenarios`."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.consistency import RESERVED_NAMES, check_consistency
from hypermap_lite.scenario.loader import complete_document
from tests.scenario.bad_scenarios import GOOD


def complete(**sections: Any) -> dict[str, Any]:
    return complete_document(copy.deepcopy(GOOD) | sections)


def test_a_good_document_passes() -> None:
    check_consistency(complete())


@pytest.mark.parametrize("name", sorted(RESERVED_NAMES))
def test_columns_of_the_result_files_are_no_names(name: str) -> None:
    with pytest.raises(ScenarioError, match=rf"\$\.objectives\[0\]\.name: '{name}'"):
        complete(objectives=[{"name": name}])


def test_a_parameter_may_not_be_called_like_the_standard_error_of_an_objective() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.input_parameters\.cost_sem"):
        complete(input_parameters={"cost_sem": GOOD["input_parameters"]["x"]})


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("x", "a parameter is called 'x' too"),
        ("cost", "an objective is called 'cost' too"),
        ("Timestamp", "'Timestamp' is the name of a column"),
        ("cost_sem", "'cost_sem' is the name of a column"),
    ],
)
def test_the_feasible_output_has_a_name_of_its_own(name: str, problem: str) -> None:
    with pytest.raises(ScenarioError, match=rf"\$\.feasible_output\.name: {problem}"):
        complete(feasible_output={"name": name})


def test_the_feasible_output_may_be_called_feasible() -> None:
    check_consistency(complete(feasible_output={"name": "feasible"}))


def test_two_joint_priors_may_not_share_a_parameter() -> None:
    prior = {"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}
    with pytest.raises(ScenarioError, match=r"\$\.priors\[1\].*'x' already has a prior at \$\.priors\[0\]"):
        complete(priors=[prior, prior])


def test_a_joint_prior_may_have_several_components() -> None:
    component = {"mean": {"x": 1, "n": 2}, "std": {"x": 2, "n": 1}}
    check_consistency(complete(priors=[{"type": "mixture", "components": [component, component]}]))


def test_a_design_of_the_default_size_may_be_larger_than_the_budget() -> None:
    check_consistency(complete(budget={"evaluations": 3}))
    with pytest.raises(ScenarioError, match="a design of 4 does not fit into a budget of 3"):
        complete(budget={"evaluations": 3}, design_of_experiment={"number_of_samples": 4})


def test_an_objective_may_be_called_like_a_placeholder() -> None:
    check_consistency(complete(objectives=[{"name": "python"}]))


@pytest.mark.parametrize(
    ("evaluator", "allowed"),
    [
        pytest.param({"replicates": 3, "racing": {}}, "2 to 2", id="no replicate after the first look"),
        pytest.param({"racing": {}}, "no racing with fewer than 3 replicates", id="one replicate"),
    ],
)
def test_a_race_needs_replicates_to_save(evaluator: dict[str, Any], allowed: str) -> None:
    with pytest.raises(ScenarioError, match=r"\$.evaluator.racing.minimum: replicates is \d, so that none") as info:
        check_consistency(complete(evaluator=evaluator))
    assert info.value.allowed == allowed


def test_not_all_evaluations_can_repeat_others() -> None:
    budget = {"evaluations": 10, "confirm_front": 10}
    problem = r"\$.budget.confirm_front: 10 of 10 evaluations cannot repeat others"
    with pytest.raises(ScenarioError, match=problem) as info:
        check_consistency(complete(budget=budget))
    assert info.value.allowed == "0 to 9"


def test_a_design_may_take_the_whole_budget() -> None:
    check_consistency(complete(budget={"evaluations": 8}, design_of_experiment={"number_of_samples": 8}))


def test_a_uniform_prior_without_a_range_leaves_room_for_a_joint_one() -> None:
    x = GOOD["input_parameters"]["x"]
    joint = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    check_consistency(complete(input_parameters={"x": x | {"prior": {"type": "uniform"}}}, priors=joint))
    with pytest.raises(ScenarioError, match="'x' already has a prior"):
        complete(input_parameters={"x": x | {"prior": {"type": "uniform", "low": 2}}}, priors=joint)


def test_a_density_may_speak_of_any_kind_of_parameter() -> None:
    check_consistency(complete(priors=[{"type": "kde", "points": {"x": [1], "size": [32], "mode": ["safe"]}}]))


def test_a_client_is_asked_once_for_a_configuration() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.evaluator\.replicates: a client cannot be asked 2 times"):
        complete(evaluator={"type": "client_server", "replicates": 2})


@pytest.mark.parametrize(
    ("output", "problem"),
    [
        ({"samples_file": "a.csv", "pareto_file": "./a.csv"}, "'./a.csv' is the samples_file already"),
        ({"directory": "runs/a", "samples_file": "runs/a/history.csv"}, "is the run folder's history.csv"),
        ({"directory": "runs/a", "pareto_file": "runs/a"}, "'runs/a' is the run folder"),
    ],
)
def test_two_output_files_of_one_name_are_refused(output: dict[str, str], problem: str) -> None:
    with pytest.raises(ScenarioError, match=problem):
        complete(output=output)
