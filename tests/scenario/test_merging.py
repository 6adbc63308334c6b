"""Tests for merging.py."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.merging import apply_override, merge, merge_layers, read_layers
from hypermap_lite.scenario.schemas import root_schema
from tests.scenario.bad_scenarios import GOOD

REAL = {"parameter_type": "real", "values": [0, 1]}


def merged(base: dict[str, Any], over: dict[str, Any]) -> Any:
    return merge(root_schema(), merge(root_schema(), {}, base), over)


def write(folder: Path, **documents: Any) -> None:
    for name, document in documents.items():
        (folder / f"{name}.json").write_text(json.dumps(document))


def test_objects_merge_and_lists_are_replaced() -> None:
    base = {"budget": {"evaluations": 9, "batch_size": 3}, "objectives": [{"name": "a"}, {"name": "b"}]}
    over = {"budget": {"evaluations": 5}, "objectives": [{"name": "c"}]}
    assert merged(base, over) == {"budget": {"evaluations": 5, "batch_size": 3}, "objectives": [{"name": "c"}]}


def test_null_takes_a_key_back_to_its_default() -> None:
    assert merged({"budget": {"evaluations": 9, "minutes": 3}}, {"budget": {"minutes": None}}) == {
        "budget": {"evaluations": 9}
    }


def test_null_removes_a_parameter() -> None:
    assert merged({"input_parameters": {"x": REAL, "y": REAL}}, {"input_parameters": {"x": None}}) == {
        "input_parameters": {"y": REAL}
    }


def test_null_for_a_parameter_that_no_base_has_names_the_file_and_the_nearest(tmp_path: Path) -> None:
    write(tmp_path, base=GOOD, leaf={"extends": "base.json", "input_parameters": {"sizes": None}})
    with pytest.raises(ScenarioError, match=r"leaf\.json: \$\.input_parameters\.sizes: null removes[\s\S]*'size'"):
        load_scenario(tmp_path / "leaf.json")


def test_null_among_versions_is_nothing() -> None:
    assert load_scenario(GOOD | {"versions": {"numpy": None}}) == load_scenario(GOOD)


def test_parameters_keep_the_base_order_and_new_ones_follow() -> None:
    base = {"input_parameters": {"b": REAL, "a": REAL}}
    over = {"input_parameters": {"c": REAL, "a": {"values": [0, 2]}}}
    assert list(merged(base, over)["input_parameters"]) == ["b", "a", "c"]


def test_a_section_of_another_type_drops_the_options_of_the_first() -> None:
    base = {"surrogate": {"type": "gaussian_process", "noise": False}}
    assert merged(base, {"surrogate": {"type": "random_forest"}}) == {"surrogate": {"type": "random_forest"}}


def test_a_section_of_another_type_keeps_what_all_types_share() -> None:
    base = {"evaluator": {"type": "python", "function": "a:b", "replicates": 7}}
    over = {"evaluator": {"type": "command", "command": ["run"]}}
    assert merged(base, over) == {"evaluator": {"type": "command", "command": ["run"], "replicates": 7}}


def test_a_section_of_the_same_type_keeps_its_options() -> None:
    base = {"acquisition": {"samples": 16}}
    over = {"acquisition": {"type": "noisy_expected_hypervolume_improvement", "prior_weighting": "none"}}
    assert merged(base, over)["acquisition"]["samples"] == 16


def test_a_bare_string_over_an_object_is_a_change_of_type() -> None:
    assert merged(
        {"surrogate": {"type": "random_forest", "number_of_trees": 5}}, {"surrogate": "gaussian_process"}
    ) == {"surrogate": {"type": "gaussian_process"}}


def test_files_extend_over_several_levels_relative_to_themselves(tmp_path: Path) -> None:
    (tmp_path / "common").mkdir()
    write(
        tmp_path / "common", root={"seed": 1, "budget": {"evaluations": 9}}, middle={"extends": "root.json", "seed": 2}
    )
    write(tmp_path, leaf={"extends": "common/middle.json", "description": "leaf"})
    layers = read_layers(tmp_path / "leaf.json")
    assert merge_layers(layers) == {"seed": 2, "budget": {"evaluations": 9}, "description": "leaf"}


def test_later_bases_win_over_earlier_ones(tmp_path: Path) -> None:
    write(tmp_path, a={"seed": 1, "description": "a"}, b={"seed": 2}, leaf={"extends": ["a.json", "b.json"]})
    assert merge_layers(read_layers(tmp_path / "leaf.json")) == {"seed": 2, "description": "a"}


def test_two_bases_may_share_a_base(tmp_path: Path) -> None:
    write(tmp_path, root={"seed": 1}, a={"extends": "root.json"}, b={"extends": "root.json"})
    write(tmp_path, leaf={"extends": ["a.json", "b.json"]})
    assert merge_layers(read_layers(tmp_path / "leaf.json")) == {"seed": 1}


def test_a_loop_names_the_chain(tmp_path: Path) -> None:
    write(tmp_path, a={"extends": "b.json"}, b={"extends": "c.json"}, c={"extends": "b.json"})
    with pytest.raises(ScenarioError, match=r"b\.json -> c\.json -> b\.json"):
        read_layers(tmp_path / "a.json")


def test_a_missing_base_names_one_with_a_close_name(tmp_path: Path) -> None:
    write(tmp_path, base={}, leaf={"extends": "bse.json"})
    with pytest.raises(ScenarioError, match=r'\$\.extends: there is no file "bse\.json"[\s\S]*\'base\.json\''):
        read_layers(tmp_path / "leaf.json")


@pytest.mark.parametrize(
    ("override", "path", "expected"),
    [
        pytest.param("seed=3", ("seed",), 3, id="number"),
        pytest.param("application_name=peg", ("application_name",), "peg", id="string"),
        pytest.param('application_name="7"', ("application_name",), "7", id="quoted_string"),
        pytest.param("budget.evaluations=30", ("budget", "evaluations"), 30, id="new_section"),
        pytest.param("objectives.1.goal=minimize", ("objectives", 1, "goal"), "minimize", id="list_item"),
        pytest.param("input_parameters.x.values=[0, 1]", ("input_parameters", "x", "values"), [0, 1], id="list"),
        pytest.param(
            "input_parameters.x.values.0=-9", ("input_parameters", "x", "values"), [-9, 10], id="number_in_list"
        ),
        pytest.param("surrogate=random_forest", ("surrogate",), {"type": "random_forest"}, id="bare_string"),
        pytest.param("description=a=b", ("description",), "a=b", id="equals_in_value"),
    ],
)
def test_an_override_sets_one_value(override: str, path: tuple[str | int, ...], expected: Any) -> None:
    changed, _ = apply_override(GOOD, override)
    found: Any = changed
    for key in path:
        found = found[key]
    assert found == expected


def test_an_override_leaves_the_document_as_it_was() -> None:
    before = json.dumps(GOOD)
    apply_override(GOOD, "objectives.0.goal=maximize")
    apply_override(GOOD, "input_parameters.x.values.0=-9")
    assert json.dumps(GOOD) == before


def test_an_override_with_null_takes_a_key_back_to_its_default() -> None:
    assert load_scenario(GOOD | {"seed": 3}, overrides=["seed=null"]).seed == 0
    assert load_scenario(GOOD, overrides=["budget.minutes=null"]) == load_scenario(GOOD)


def test_an_override_of_a_type_drops_the_options_of_the_first() -> None:
    document = GOOD | {"surrogate": {"type": "random_forest", "number_of_trees": 5}}
    assert load_scenario(document, overrides=["surrogate.type=gaussian_process"]) == load_scenario(GOOD)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        pytest.param("seed", "this sets nothing", id="no_equals_sign"),
        pytest.param("=3", "this sets nothing", id="no_path"),
        pytest.param("budget..x=3", "this sets nothing", id="empty_key"),
        pytest.param("extends=base.json", "only a file can extend", id="extends"),
        pytest.param(
            "objectives.5.goal=minimize", r"\$\.objectives: the list has no item '5'[\s\S]*0 to 1", id="no_item"
        ),
        pytest.param("objectives.gain.goal=minimize", "no item 'gain'", id="name_in_a_list"),
        pytest.param("seed.x=3", r"\$\.seed: .* is an object", id="inside_a_number"),
        pytest.param("budget.²=3", r"\$\.budget\.²: unknown key", id="digit_that_is_no_number"),
        pytest.param("objectives.99999999999999999999=3", "no item '9999", id="huge_index"),
        pytest.param("budget.minutes=NaN", r"\$\.budget\.minutes: nan is no JSON number", id="not_a_number"),
        pytest.param("evaluator.timeout_seconds=Infinity", r"\$\.evaluator\.timeout_seconds: inf", id="infinity"),
        pytest.param("seed=" + "9" * 5000, r"\$\.seed: inf is no JSON number, or one too large", id="huge_integer"),
        pytest.param('budget={"minutes": 1, "minutes": 2}', r"\$\.budget: .*stands twice", id="repeated_key"),
        pytest.param('budget={"minutes": [1e999]}', r"\$\.budget\.minutes\[0\]: inf", id="infinity_inside"),
        pytest.param("description=" + "[" * 100_000, "nested too deeply", id="deep"),
        pytest.param("input_parameters.y=null", r"\$\.input_parameters\.y: null removes", id="null_for_nothing"),
        pytest.param("bugdet.evaluations=3", r"\$\.bugdet: unknown key[\s\S]*'budget'", id="unknown_section"),
    ],
)
def test_an_override_that_makes_no_sense_is_named(override: str, message: str) -> None:
    with pytest.raises(ScenarioError, match=message) as caught:
        load_scenario(GOOD, overrides=[override])
    assert f"--set {override}" in str(caught.value)
