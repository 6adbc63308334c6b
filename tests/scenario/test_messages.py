"""Tests for messages.py; the messages themselves are tested over all of `bad_scenarios`."""

from __future__ import annotations

from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.messages import check_document, describe, enumerate_names, show
from tests.scenario.bad_scenarios import GOOD


@pytest.mark.parametrize(
    ("schema", "words"),
    [
        pytest.param({"type": "integer", "minimum": 1}, "an integer >= 1", id="integer"),
        pytest.param({"type": "number", "minimum": 0, "exclusiveMaximum": 1}, "a number >= 0 and < 1", id="range"),
        pytest.param({"type": ["number", "null"], "exclusiveMinimum": 0}, "a number > 0 or null", id="nullable"),
        pytest.param({"enum": ["a", None]}, "a, null", id="enum"),
        pytest.param({"type": "boolean"}, "true or false", id="boolean"),
        pytest.param({"type": "string", "minLength": 1}, "a string that is not empty", id="text"),
        pytest.param(
            {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
            "a list of 2 numbers",
            id="pair",
        ),
        pytest.param({}, "any value", id="anything"),
    ],
)
def test_schemas_read_as_words(schema: dict[str, Any], words: str) -> None:
    assert describe(schema) == words


def test_a_long_value_is_cut() -> None:
    assert len(show(list(range(1000)))) <= 60
    assert show("é") == '"é"'


def test_a_long_list_of_names_is_cut() -> None:
    assert enumerate_names([f"x{i}" for i in range(30)], limit=3) == "x0, x1, x2, ... (27 more)"


def test_an_unknown_kind_is_blamed_before_the_options_that_do_not_fit_it() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.surrogate\.type"):
        check_document(GOOD | {"surrogate": {"type": "forest", "number_of_trees": 3}})


def test_a_misspelt_key_is_blamed_before_the_one_it_leaves_missing() -> None:
    document = GOOD | {"input_parameters": {"x": {"parameter_typ": "real", "values": [0, 1]}}}
    with pytest.raises(ScenarioError, match=r"\$\.input_parameters\.x\.parameter_typ[\s\S]*'parameter_type'"):
        check_document(document)


def test_a_wrong_option_does_not_make_its_neighbours_unknown() -> None:
    document = GOOD | {"surrogate": {"type": "random_forest", "number_of_trees": 0, "max_features": 0.5}}
    with pytest.raises(ScenarioError, match=r"\$\.surrogate\.number_of_trees: 0 is too small"):
        check_document(document)


def test_a_good_document_passes() -> None:
    check_document(GOOD)
