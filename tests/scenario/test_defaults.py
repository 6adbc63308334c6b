"""Tests for defaults.py."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from hypermap_lite.scenario.defaults import fill, fill_derived, has_priors
from hypermap_lite.scenario.schemas import root_schema
from tests.scenario.bad_scenarios import GOOD


def filled(**sections: Any) -> dict[str, Any]:
    return fill_derived(fill(root_schema(), copy.deepcopy(GOOD) | sections))


def test_filling_twice_changes_nothing() -> None:
    once = filled()
    assert fill_derived(fill(root_schema(), once)) == once


def test_sections_come_in_the_order_of_the_schema() -> None:
    assert list(filled(seed=3))[:4] == ["application_name", "description", "seed", "input_parameters"]


def test_options_of_the_chosen_type_are_filled_and_of_no_other() -> None:
    assert filled(surrogate={"type": "random_forest"})["surrogate"] == {
        "type": "random_forest",
        "number_of_trees": 100,
        "max_features": 0.5,
        "min_samples_leaf": 2,
        "min_samples_split": None,
        "bootstrap": None,
        "random_thresholds": False,
    }


def test_items_of_lists_are_filled() -> None:
    rest = {"goal": "minimize", "reference_point": None, "priors": None, "description": ""}
    assert filled()["objectives"][0] == {"name": "cost"} | rest


def test_the_design_has_two_points_per_parameter_and_at_least_six() -> None:
    assert filled()["design_of_experiment"]["number_of_samples"] == 8
    one = {"x": GOOD["input_parameters"]["x"]}
    assert filled(input_parameters=one)["design_of_experiment"]["number_of_samples"] == 6


def test_a_uniform_prior_says_nothing() -> None:
    uniform = copy.deepcopy(GOOD)
    uniform["input_parameters"]["x"]["prior"] = {"type": "uniform"}
    assert not has_priors(uniform)
    uniform["input_parameters"]["n"]["prior"] = {"type": "beta", "shape": "decay"}
    assert has_priors(uniform)


@pytest.mark.parametrize("end", ["low", "high"])
def test_a_uniform_prior_with_a_range_says_something(end: str) -> None:
    ranged = copy.deepcopy(GOOD)
    ranged["input_parameters"]["x"]["prior"] = {"type": "uniform", end: 0}
    assert has_priors(ranged)
    assert filled(input_parameters=ranged["input_parameters"])["design_of_experiment"]["type"] == "prior_sampling"


@pytest.mark.parametrize(("n", "given", "exponent"), [(1, None, 8), (2, None, 3), (3, None, 3), (1, 2.5, 2.5)])
def test_the_power_of_the_probability_of_being_feasible_follows_from_the_number_of_objectives(
    n: int, given: float | None, exponent: float
) -> None:
    document = copy.deepcopy(GOOD) | {"objectives": [{"name": f"f{k}"} for k in range(n)]}
    document["acquisition"] = {"feasibility_weighting": {"exponent": given}}
    filled = fill_derived(fill(root_schema(), document))
    assert filled["acquisition"]["feasibility_weighting"]["exponent"] == exponent


def test_without_the_probability_of_being_feasible_there_is_no_power() -> None:
    document = copy.deepcopy(GOOD) | {"acquisition": {"feasibility_weighting": {"method": "none"}}}
    assert "exponent" not in fill_derived(fill(root_schema(), document))["acquisition"]["feasibility_weighting"]
