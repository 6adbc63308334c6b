"""Tests for presets.py."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

from hypermap_lite.history.added_later import ADDED_LATER
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.scenario.presets import PRESETS
from hypermap_lite.scenario.schemas import root_schema
from tests.scenario.bad_scenarios import GOOD

PRIORS = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]


def with_preset(name: str, **sections: Any) -> Scenario:
    return load_scenario(copy.deepcopy(GOOD) | {"preset": name} | sections)


def test_the_paper_preset_is_the_method_of_the_paper() -> None:
    scenario = with_preset("paper", priors=PRIORS)
    weighting = scenario.acquisition.prior_weighting
    assert scenario.design.type == "prior_sampling"
    assert scenario.surrogate.type == "gaussian_process"
    assert scenario.acquisition.function.type == "noisy_expected_improvement"
    assert scenario.acquisition.scalarization.type == "linear"
    assert scenario.acquisition.weights.options == {"alpha": 1.0, "ends": 0.0, "redraws": 0}
    assert weighting is not None
    always_guided = {"prior_free": 0.0, "safeguard": False, "make_up": False}
    assert weighting.options == {"beta": None, "floor": 1e-6, "unbounded": False, **always_guided}
    assert scenario.design.options == {"uniform_share": 0.0}


def test_the_paper_preset_samples_at_random_without_priors() -> None:
    assert with_preset("paper").design.type == "random_sampling"


def test_the_users_own_keys_win() -> None:
    acquisition = {"type": "upper_confidence_bound", "prior_weighting": {"floor": 0.1}}
    scenario = with_preset("paper", acquisition=acquisition, design_of_experiment="grid")
    assert scenario.design.type == "grid"
    assert scenario.acquisition.function.type == "upper_confidence_bound"
    assert scenario.acquisition.scalarization.type == "linear"
    assert scenario.acquisition.prior_weighting is not None
    assert scenario.acquisition.prior_weighting.options["floor"] == pytest.approx(0.1)


def test_a_preset_can_be_set_on_the_command_line() -> None:
    assert load_scenario(GOOD, overrides=["preset=paper"]) == with_preset("paper")


def test_the_schema_lists_the_presets() -> None:
    assert root_schema()["properties"]["preset"]["enum"] == [*PRESETS, None]


def test_the_papers_method_has_no_option_that_came_later() -> None:
    """What was not there when the paper's experiments were run has the value that changes nothing."""
    parameters = {"x": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": 0, "std": 1}}}
    document = {"preset": "paper", "input_parameters": parameters, "objectives": [{"name": "f"}, {"name": "g"}]}
    canonical = load_scenario(document).canonical
    for place, value in ADDED_LATER.items():
        section: Any = canonical
        for name in place.removeprefix("$.").split("."):
            section = section[name]
        assert section == json.loads(value), place
