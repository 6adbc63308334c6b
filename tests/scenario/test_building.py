"""Tests for building.py."""

from __future__ import annotations

import copy
from typing import Any

from hypermap_lite.objectives import Goal
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.model import Scenario
from tests.scenario.bad_scenarios import GOOD


def built(**sections: Any) -> Scenario:
    return load_scenario(copy.deepcopy(GOOD) | sections)


def test_parts_know_their_place_in_the_json() -> None:
    x = GOOD["input_parameters"]["x"] | {"prior": {"type": "uniform"}}
    scenario = built(input_parameters={"x": x})
    assert scenario.parameters[0].prior is not None
    assert scenario.parameters[0].prior.path == "$.input_parameters.x.prior"
    assert scenario.acquisition.scalarization.path == "$.acquisition.scalarization"


def test_objectives_have_goals() -> None:
    assert [objective.goal for objective in built().objectives] == [Goal.MINIMIZE, Goal.MAXIMIZE]


def test_options_of_the_evaluator_are_not_mixed_with_those_of_the_calls() -> None:
    evaluator = built(evaluator={"type": "python", "function": "a:b", "replicates": 7}).evaluator
    assert evaluator.component is not None
    assert evaluator.component.options == {"function": "a:b", "batch": False}
    assert evaluator.replicates == 7


def test_options_of_the_acquisition_are_not_mixed_with_what_is_around_it() -> None:
    function = built(acquisition={"type": "upper_confidence_bound", "beta": 3}).acquisition.function
    assert (function.type, function.options, function.path) == ("upper_confidence_bound", {"beta": 3}, "$.acquisition")


def test_real_parameters_have_floats_and_integers_stay_integers() -> None:
    x, n, *_ = built().parameters
    assert [type(value) for value in (*x.values, *n.values)] == [float, float, int, int]


def test_only_priors_that_say_something_count() -> None:
    uniform = GOOD["input_parameters"]["x"] | {"prior": "uniform"}
    assert not built(input_parameters={"x": uniform}).has_priors
    assert built(priors=[{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 1}}]}]).has_priors
