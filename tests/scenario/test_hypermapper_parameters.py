"""HyperMapper's input parameters in our form."""

from __future__ import annotations

from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.hypermapper import PARAMETER_KEYS, translate
from tests.scenario.hypermapper_scenarios import CATEGORICAL, INTEGER, ORDINAL, REAL, note_on, parameter, scenario

PERMUTATION = {"parameter_type": "permutation", "values": [4]}

KEY_CASES: dict[str, tuple[dict[str, Any], dict[str, Any], dict[str, Any], str]] = {
    "parameter_type": (REAL, {"parameter_type": "integer"}, {"parameter_type": "integer"}, ""),
    "values": (REAL, {"values": [0, 3]}, {"values": [0, 3]}, ""),
    "parameter_default": (REAL, {"parameter_default": 2.5}, {"parameter_default": 2.5}, ""),
    "prior": (REAL, {"prior": "decay"}, {"prior": {"type": "beta", "shape": "decay"}}, ""),
    "custom_gaussian_prior_means": (
        REAL,
        {"prior": "custom_gaussian", "custom_gaussian_prior_means": [3]},
        {"prior": {"type": "gaussian", "mean": 3, "std": 7.5}},
        "",
    ),
    "custom_gaussian_prior_stds": (
        REAL,
        {"prior": "custom_gaussian", "custom_gaussian_prior_stds": [2]},
        {"prior": {"type": "gaussian", "mean": 0, "std": 2}},
        "",
    ),
    "prior_parameters": (
        REAL,
        {"prior": "gaussian", "prior_parameters": [1, 2]},
        {"prior": {"type": "gaussian", "mean": 1, "std": 2}},
        "",
    ),
    "transform": ({"parameter_type": "real", "values": [1, 10]}, {"transform": "log"}, {"scale": "log"}, ""),
    "constraints": (REAL, {"constraints": ["p >= 0"]}, {}, ""),
    "dependencies": (REAL, {"dependencies": ["q"]}, {}, "they follow from the constraints"),
    "parametrization": (PERMUTATION, {"parametrization": "kendall"}, {"kernel": "kendall"}, ""),
}
"""By key: an entry, its change, what that adds to ours, and what is said."""


def test_every_key_has_a_case() -> None:
    assert set(KEY_CASES) == set(PARAMETER_KEYS)


@pytest.mark.parametrize("key", KEY_CASES)
def test_a_key_takes_effect(key: str) -> None:
    entry, change, added, said = KEY_CASES[key]
    translation = translate(scenario(input_parameters={"p": {**entry, **change}}))
    ours = parameter(entry) | added
    assert translation.document["input_parameters"]["p"] == ours
    assert said in note_on(translation, f"input_parameters.p.{key}")


@pytest.mark.parametrize("entry", [REAL, INTEGER, ORDINAL, CATEGORICAL], ids=lambda entry: entry["parameter_type"])
def test_types_and_values_are_ours(entry: dict[str, Any]) -> None:
    assert parameter(entry) == entry


def test_a_permutation_has_hypermappers_kernel() -> None:
    assert parameter(PERMUTATION) == {**PERMUTATION, "kernel": "spearman"}
    assert parameter(PERMUTATION, parametrization="mallows")["kernel"] == "spearman"


@pytest.mark.parametrize("entry", [REAL, INTEGER], ids=["real", "integer"])
def test_a_default_outside_the_bounds_is_left_out_with_a_note(entry: dict[str, Any]) -> None:
    translation = translate(scenario(input_parameters={"p": {**entry, "parameter_default": 99}}))
    assert "parameter_default" not in translation.document["input_parameters"]["p"]
    assert "99 lies outside" in note_on(translation, "input_parameters.p.parameter_default")


def test_the_first_of_several_defaults_counts() -> None:
    translation = translate(scenario(input_parameters={"p": {**REAL, "parameter_default": [3, 4]}}))
    assert translation.document["input_parameters"]["p"]["parameter_default"] == 3
    assert "only the first" in note_on(translation, "input_parameters.p.parameter_default")


@pytest.mark.parametrize("default", [[2, 0, 1], [[2, 0, 1]], "(2, 0, 1)"])
def test_the_default_of_a_permutation_is_a_list(default: Any) -> None:
    entry = {"parameter_type": "permutation", "values": [3]}
    assert parameter(entry, parameter_default=default)["parameter_default"] == [2, 0, 1]


def test_numbers_among_the_categories_become_texts() -> None:
    entry = parameter({"parameter_type": "categorical", "values": [1, 2.5, "a"]}, parameter_default=1)
    assert entry["values"] == ["1", "2.5", "a"]
    assert entry["parameter_default"] == "1"


def test_constraints_are_gathered_and_written_in_words() -> None:
    entries = {
        "p": {**REAL, "constraints": ["(p >= 0) & (q < 3)", "p != q"]},
        "q": {**REAL, "constraints": ["p != q", "~(q == 1) | (p > 1)"]},
    }
    constraints = translate(scenario(input_parameters=entries)).document["constraints"]
    assert constraints == ["(p >= 0) and (q < 3)", "p != q", "not (q == 1) or (p > 1)"]


@pytest.mark.parametrize(
    ("entry", "path", "says"),
    [
        pytest.param({"values": [0, 1]}, "", "the key 'parameter_type' is missing", id="no type"),
        pytest.param({"parameter_type": "real"}, "", "the key 'values' is missing", id="no values"),
        pytest.param(
            {**REAL, "parameter_type": "float"}, ".parameter_type", 'unknown parameter type "float"', id="type"
        ),
        pytest.param({**REAL, "values": [0, 1, 2]}, ".values", r"has 3 items(.|\n)*\[low, high\]", id="three bounds"),
        pytest.param({**REAL, "values": 3}, ".values", r"3 is a number(.|\n)*Write \[3\]", id="no list"),
        pytest.param({**REAL, "values": ["0", 1]}, ".values", "is a string", id="text as bound"),
        pytest.param({**REAL, "parameter_default": "a"}, ".parameter_default", "is a string", id="text as default"),
        pytest.param({**ORDINAL, "parameter_default": 3}, ".parameter_default", "none of the levels", id="level"),
        pytest.param({**REAL, "pror": "decay"}, ".pror", "Did you mean 'prior'", id="slip"),
        pytest.param({**REAL, "transform": "sqrt"}, ".transform", "none, log", id="transform"),
        pytest.param(7, "", "7 is a number", id="no object"),
    ],
)
def test_a_mistake_is_named_where_it_stands(entry: Any, path: str, says: str) -> None:
    with pytest.raises(ScenarioError, match=says) as caught:
        translate(scenario(input_parameters={"p": entry}))
    assert caught.value.path == f"$.input_parameters.p{path}"


def test_a_name_that_is_no_name_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r'the name "a.b" is not of the right form'):
        translate(scenario(input_parameters={"a.b": REAL}))


def test_an_unknown_key_that_is_no_slip_is_noted() -> None:
    translation = translate(scenario(input_parameters={"p": {**REAL, "colour": "red"}}))
    assert note_on(translation, "input_parameters.p.colour") == "unknown; it does nothing"
