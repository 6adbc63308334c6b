"""Tests for model.py."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.sources import Layer
from tests.scenario.bad_scenarios import GOOD


def test_a_scenario_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError, match="seed"):
        load_scenario(GOOD).seed = 3  # type: ignore[misc]


def test_where_a_scenario_was_written_does_not_make_it_another() -> None:
    scenario = load_scenario(GOOD)
    moved = dataclasses.replace(scenario, directory=Path("elsewhere"), layers=(Layer("s.json", GOOD),))
    assert moved == scenario
    assert moved.origin_of("$.objectives[0].name") == "s.json"


def test_another_seed_makes_it_another() -> None:
    assert load_scenario(GOOD | {"seed": 3}) != load_scenario(GOOD)
