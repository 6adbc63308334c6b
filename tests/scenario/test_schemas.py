"""Tests for schemas.py."""

from __future__ import annotations

import pytest

from hypermap_lite.scenario.schemas import (
    all_properties,
    allows_any_key,
    allows_bare_string,
    child_schema,
    kind_key,
    kind_of,
    load_schemas,
    properties_of,
    root_schema,
)

SURROGATE = "surrogate.schema.json"


def test_a_section_knows_the_options_of_its_variant_only() -> None:
    surrogate = load_schemas()[SURROGATE]
    assert list(properties_of(surrogate, {"type": "gaussian_process"}))[:2] == ["type", "noise"]
    assert "number_of_trees" not in properties_of(surrogate, {"type": "gaussian_process"})
    assert "noise" not in properties_of(surrogate, {"type": "random_forest"})


def test_a_section_without_a_type_is_of_the_default_type() -> None:
    surrogate = load_schemas()[SURROGATE]
    assert kind_of(surrogate, {}) == "gaussian_process"
    assert "noise" in properties_of(surrogate, {})


def test_all_properties_joins_the_variants() -> None:
    assert {"noise", "number_of_trees"} <= set(all_properties(load_schemas()[SURROGATE]))


@pytest.mark.parametrize(
    ("file", "key"),
    [
        pytest.param(SURROGATE, "type", id="type"),
        pytest.param("parameter.schema.json", "parameter_type", id="parameter_type"),
        pytest.param("prior_weighting.schema.json", "method", id="method"),
        pytest.param("budget.schema.json", None, id="no_variants"),
    ],
)
def test_the_kind_key_chooses_the_variant(file: str, key: str | None) -> None:
    assert kind_key(load_schemas()[file]) == key


def test_only_sections_named_by_type_may_be_bare_strings() -> None:
    names = {name for name, sub in properties_of(root_schema(), {}).items() if allows_bare_string(sub)}
    assert names == {"design_of_experiment", "optimizer", "surrogate", "acquisition", "maximizer", "evaluator"}


def test_parameter_names_are_free_and_their_schema_is_known() -> None:
    parameters = load_schemas()["input_parameters.schema.json"]
    assert allows_any_key(parameters)
    assert child_schema(parameters, {}, "anything")["title"] == "Parameter"


def test_the_schema_of_an_unknown_key_allows_anything() -> None:
    assert child_schema(root_schema(), {}, "no_such_key") == {}
