"""Tests for sources.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from hypermap_lite.scenario.sources import Layer, folders_of, keys_of, layer_of, origin_of, path_of

LAYERS = (
    Layer("base.json", {"seed": 1, "objectives": [{"name": "a"}], "budget": {"evaluations": 5}}),
    Layer("leaf.json", {"budget": {"minutes": 3}}),
    Layer("--set objectives.0.goal=x", {"objectives": {0: {"goal": "x"}}}),
)


@pytest.mark.parametrize(
    ("path", "origin"),
    [
        pytest.param("$.seed", "base.json", id="only_in_the_base"),
        pytest.param("$.budget.evaluations", "base.json", id="below_a_shared_section"),
        pytest.param("$.budget", "leaf.json", id="last_writer_of_a_section"),
        pytest.param("$.objectives[0].goal", "--set objectives.0.goal=x", id="override"),
        pytest.param("$.objectives[0].name", "base.json", id="beside_an_override"),
        pytest.param("$.budget.minutes.x", "leaf.json", id="nearest_above"),
        pytest.param("$", "leaf.json", id="whole_document"),
        pytest.param("$.evaluator", "leaf.json", id="nowhere"),
    ],
)
def test_the_origin_is_the_layer_that_wrote_the_value(path: str, origin: str) -> None:
    assert origin_of(path, LAYERS) == origin


def test_a_bare_string_is_the_type_of_what_it_is_short_for() -> None:
    layers = (Layer("s.json", {"surrogate": {"type": "a", "trees": 3}}), Layer("--set surrogate=b", {"surrogate": "b"}))
    assert origin_of("$.surrogate.type", layers) == "--set surrogate=b"
    assert origin_of("$.surrogate.trees", layers) == "s.json"


def test_layers_know_their_folder() -> None:
    layers = (Layer("a/base.json", {"seed": 1}, Path("a")), Layer("--set seed=2", {"seed": 2}))
    assert [getattr(layer_of(path, layers), "directory", "") for path in ("$.budget", "$.seed")] == [Path("a"), None]
    assert layer_of("$.seed", ()) is None


def test_keys_and_paths_are_inverse() -> None:
    keys = ("priors", 0, "components", 12, "mean", "x-1")
    assert keys_of(path_of(keys)) == keys
    assert path_of(keys) == "$.priors[0].components[12].mean.x-1"


def test_files_are_looked_for_beside_their_layer_then_beside_the_scenario() -> None:
    layers = (Layer("a/base.json", {"seed": 1}, Path("/a")), Layer("--set seed=2", {"budget": 2}))
    assert folders_of("$.seed", layers, Path("/b")) == (Path("/a"), Path("/b"))
    assert folders_of("$.budget", layers, Path("/b")) == (Path("/b"),)
    assert folders_of("$.seed", (), Path("/b")) == (Path("/b"),)
