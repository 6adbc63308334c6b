"""Tests for the files in scenario_schemas: that they are complete, and say what the code says."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from hypermap_lite.acquisition import ACQUISITIONS
from hypermap_lite.assembly import FEASIBILITY_WEIGHTINGS, PRIOR_WEIGHTINGS
from hypermap_lite.design import DESIGNS
from hypermap_lite.evaluation import EVALUATORS
from hypermap_lite.maximizers import MAXIMIZERS
from hypermap_lite.objectives import FeasibleOutput, Goal, Objective
from hypermap_lite.optimizers import OPTIMIZERS, SEARCHES
from hypermap_lite.priors import JOINT_PRIORS, PRIORS
from hypermap_lite.priors.beta import SHAPES
from hypermap_lite.scalarization import SCALARIZATIONS, WEIGHTS
from hypermap_lite.scenario.building import EVALUATOR_KEYS
from hypermap_lite.scenario.defaults import EXPONENT_OF_SEVERAL, fill
from hypermap_lite.scenario.hypermapper import is_hypermapper
from hypermap_lite.scenario.model import BudgetSpec, EvaluatorSpec, ParameterSpec, Scenario
from hypermap_lite.scenario.schemas import (
    STUDY,
    Schema,
    all_properties,
    kind_key,
    load_schemas,
    properties_of,
    resolve,
    validator,
)
from hypermap_lite.space import PARAMETERS
from hypermap_lite.surrogates import SURROGATES

ROOT = Path(__file__).parents[1]
EXAMPLES = [
    file
    for file in sorted((ROOT / "example_scenarios").rglob("*.json"))
    if not is_hypermapper(json.loads(file.read_text()))
]
BASE = "https://hypermap-lite.example/schemas"

FAMILIES: dict[str, Mapping[str, type]] = {
    "prior": PRIORS,
    "joint_prior": JOINT_PRIORS,
    "surrogate": SURROGATES,
    "acquisition": ACQUISITIONS,
    "scalarization": SCALARIZATIONS,
    "weights": WEIGHTS,
    "prior_weighting": PRIOR_WEIGHTINGS,
    "feasibility_weighting": FEASIBILITY_WEIGHTINGS,
    "maximizer": MAXIMIZERS,
    "evaluator": EVALUATORS,
}
"""Sections whose options are the fields of a family's members."""

AROUND = {
    "acquisition": ("scalarization", "weights", "prior_weighting", "feasibility_weighting"),
    "evaluator": EVALUATOR_KEYS,
}
"""Keys of a section that are not options of the member, besides its kind."""

FROM_ELSEWHERE = {"objectives", "search_path", "working_directory", "parameters", "space", "feasible_output", "folders"}
"""Fields of evaluators that the rest of the scenario fills in."""

MEMBERS = [
    pytest.param(section, kind, member, id=f"{section}-{kind}")
    for section, family in [*FAMILIES.items(), ("optimizer", SEARCHES)]
    for kind, member in family.items()
]


def schema_of(section: str) -> Schema:
    return load_schemas()[f"{section}.schema.json"]


def properties() -> Iterator[Any]:
    for file, schema in load_schemas().items():
        for key, sub in all_properties(schema).items():
            yield pytest.param(sub, id=f"{file.removesuffix('.schema.json')}-{key}")


def fields_of(member: type) -> dict[str, Any]:
    """Return the options of a family's member with their defaults."""
    return {
        field.name: None if field.default is dataclasses.MISSING else field.default
        for field in dataclasses.fields(member)
        if field.init and not (member in EVALUATORS.values() and field.name in FROM_ELSEWHERE)
    }


@pytest.mark.parametrize("file", load_schemas())
def test_a_schema_is_valid_and_called_by_its_file(file: str) -> None:
    schema = load_schemas()[file]
    Draft202012Validator.check_schema(schema)
    assert schema["$id"] == f"{BASE}/{file}"
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"


@pytest.mark.parametrize("file", load_schemas())
def test_a_section_explains_itself(file: str) -> None:
    schema = load_schemas()[file]
    assert schema["title"]
    assert schema["description"].endswith(".")
    assert schema["examples"]


@pytest.mark.parametrize("file", load_schemas())
def test_a_section_allows_no_unknown_keys(file: str) -> None:
    schema = load_schemas()[file]
    closed = schema.get("unevaluatedProperties") is False or schema.get("additionalProperties") is False
    assert closed or "properties" not in schema


@pytest.mark.parametrize("schema", list(properties()))
def test_a_property_has_title_and_description(schema: Schema) -> None:
    assert schema["title"]
    assert schema["description"].endswith(".")


@pytest.mark.parametrize("file", load_schemas())
def test_a_property_is_required_or_has_a_default(file: str) -> None:
    schema = load_schemas()[file]
    branches = [schema, *(branch["then"] for branch in schema.get("allOf", ()))]
    required = {key for branch in branches for key in branch.get("required", ())}
    optional = {key for key, sub in all_properties(schema).items() if "default" in sub}
    assert required | optional == set(all_properties(schema))
    assert not required & optional


@pytest.mark.parametrize("file", load_schemas())
def test_examples_and_defaults_are_valid(file: str) -> None:
    schema = load_schemas()[file]
    for example in schema["examples"]:
        assert not list(validator().evolve(schema={"$ref": schema["$id"]}).iter_errors(example))
    for sub in all_properties(schema).values():
        if "default" in sub:
            assert not list(validator().evolve(schema=sub).iter_errors(sub["default"]))


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_examples_are_valid_as_an_editor_sees_them(file: Path) -> None:
    document = json.loads(file.read_text())
    schema = validator(STUDY) if file.parent.name == "studies" else validator()
    errors = [error.message for error in schema.iter_errors(document)]
    missing = [message for message in errors if "is a required property" in message]
    assert errors == (missing if "extends" in document else [])


@pytest.mark.parametrize(
    ("section", "names"),
    [pytest.param(section, set(family), id=section) for section, family in FAMILIES.items()]
    + [
        pytest.param("parameter", set(PARAMETERS), id="parameter"),
        pytest.param("design_of_experiment", {"auto", *DESIGNS}, id="design"),
        pytest.param("optimizer", set(OPTIMIZERS), id="optimizer"),
    ],
)
def test_the_names_are_those_of_the_family(section: str, names: set[str]) -> None:
    schema = schema_of(section)
    key = kind_key(schema)
    assert key is not None
    without_one = {"none"} if section in ("evaluator", "prior_weighting", "feasibility_weighting") else set()
    assert set(schema["properties"][key]["enum"]) == names | without_one


DERIVED = {"feasibility_weighting": {"exponent": EXPONENT_OF_SEVERAL}, "surrogate": {"doubt_noise": False}}
"""Options that follow from other keys where they are null, and what they are with several objectives."""


@pytest.mark.parametrize(("section", "kind", "member"), MEMBERS)
def test_the_options_and_defaults_are_those_of_the_member(section: str, kind: str, member: type) -> None:
    schema = schema_of(section)
    around = (kind_key(schema), *AROUND.get(section, ()))
    options = properties_of(schema, {kind_key(schema): kind})
    stated = {key: sub.get("default") for key, sub in options.items() if key not in around}
    for key, value in DERIVED.get(section, {}).items():
        if key in stated:
            assert stated[key] is None
            stated[key] = value
    assert stated == fields_of(member)


@pytest.mark.parametrize(
    ("section", "part", "keys"),
    [
        pytest.param("budget", BudgetSpec, ("evaluations", "batch_size", "minutes"), id="budget"),
        pytest.param("evaluator", EvaluatorSpec, EVALUATOR_KEYS, id="evaluator"),
        pytest.param("parameter", ParameterSpec, ("scale", "parameter_default", "description"), id="parameter"),
        pytest.param("scenario", Scenario, ("seed", "description"), id="scenario"),
        pytest.param("objective", Objective, ("reference_point",), id="objective"),
        pytest.param("feasible_output", FeasibleOutput, ("name", "true_value", "false_value"), id="feasible_output"),
    ],
)
def test_the_defaults_are_those_of_the_dataclasses(section: str, part: type, keys: tuple[str, ...]) -> None:
    stated = {key: all_properties(schema_of(section))[key]["default"] for key in keys}
    assert stated == {field.name: field.default for field in dataclasses.fields(part) if field.name in keys}


def test_goals_and_shapes_are_those_of_the_code() -> None:
    assert set(schema_of("objective")["properties"]["goal"]["enum"]) == {goal.value for goal in Goal}
    assert schema_of("objective")["properties"]["goal"]["default"] == Objective(name="y").goal.value
    assert set(all_properties(schema_of("prior"))["shape"]["enum"]) == {None, *SHAPES}


def test_every_section_can_be_left_out_with_a_default() -> None:
    root = schema_of("scenario")
    sections = {key for key in root["properties"] if key not in root["required"]}
    filled = fill(root, {})
    assert sections <= set(filled)
    assert all("type" in filled[key] for key in sections if kind_key(resolve(root["properties"][key])))
