"""Tests for loader.py."""

from __future__ import annotations

import copy
import json
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario import load_scenario
from tests.scenario.bad_scenarios import BAD, GOOD, Bad

FOUND_BY_LOADING = {name: bad for name, bad in BAD.items() if bad.when_loaded}


def with_sections(**sections: Any) -> dict[str, Any]:
    return copy.deepcopy(GOOD) | sections


@pytest.mark.parametrize("bad", FOUND_BY_LOADING.values(), ids=FOUND_BY_LOADING.keys())
def test_a_mistake_is_named_with_place_value_and_remedy(bad: Bad, tmp_path: Path) -> None:
    file = tmp_path / "bad.json"
    file.write_text(bad.text)
    with pytest.raises(ScenarioError, match=r"bad\.json") as caught:
        load_scenario(file)
    message = str(caught.value)
    assert [part for part in bad.says if part not in message] == [], message
    assert len(message.splitlines()) <= 4


@pytest.mark.parametrize("bad", [bad for bad in BAD.values() if not bad.when_loaded])
def test_what_the_parts_check_themselves_loads(bad: Bad, tmp_path: Path) -> None:
    file = tmp_path / "bad.json"
    file.write_text(bad.text)
    assert load_scenario(file).application_name == "demo"


def test_defaults_fill_a_minimal_scenario() -> None:
    scenario = load_scenario(GOOD)
    assert scenario.budget.evaluations == 50
    assert scenario.design.type == "sobol"
    assert scenario.design.number_of_samples == 8
    assert (scenario.surrogate.type, scenario.surrogate.path) == ("gaussian_process", "$.surrogate")
    assert scenario.surrogate.options["noise"] is True
    assert scenario.acquisition.function.type == "noisy_expected_hypervolume_improvement"
    assert scenario.evaluator.component is None
    assert scenario.output.directory == "outputs/demo"


def test_a_prior_makes_the_default_design_sample_from_it() -> None:
    priors = [{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}]
    assert load_scenario(with_sections(priors=priors)).design.type == "prior_sampling"


def test_the_budget_has_no_part_in_the_default_design() -> None:
    small, large = (load_scenario(with_sections(budget={"evaluations": n})) for n in (3, 30))
    assert small.design == large.design
    assert load_scenario(small.canonical) == small


def test_a_bare_string_is_short_for_an_object_with_that_type() -> None:
    bare = load_scenario(with_sections(surrogate="random_forest", acquisition={"scalarization": "linear"}))
    assert bare.surrogate.type == "random_forest"
    assert bare.acquisition.scalarization.type == "linear"


def test_the_canonical_form_loads_to_the_same_scenario() -> None:
    scenario = load_scenario(with_sections(preset="paper", surrogate="random_forest"))
    assert load_scenario(scenario.canonical) == scenario


def test_the_canonical_form_says_nothing_of_where_it_came_from() -> None:
    canonical = load_scenario(with_sections(preset="paper", versions={"numpy": "2"})).canonical
    assert not {"preset", "extends", "versions"} & set(canonical)


def test_null_means_the_default() -> None:
    assert load_scenario(with_sections(budget=None, seed=None)) == load_scenario(GOOD)


def test_whole_floats_are_integers_where_integers_are_wanted() -> None:
    evaluations = load_scenario(with_sections(budget={"evaluations": 20.0})).budget.evaluations
    assert isinstance(evaluations, int)


def test_real_bounds_are_floats() -> None:
    assert load_scenario(GOOD).parameters[0].values == (-5.0, 10.0)
    assert isinstance(load_scenario(GOOD).parameters[0].values[0], float)


def test_no_prior_weighting_is_none() -> None:
    assert load_scenario(with_sections(acquisition={"prior_weighting": "none"})).acquisition.prior_weighting is None


def test_the_folder_of_the_file_is_known(tmp_path: Path) -> None:
    (tmp_path / "s.json").write_text('{"input_parameters": {"x": {"parameter_type": "real", "values": [0, 1]}}}')
    assert load_scenario(tmp_path / "s.json", overrides=['objectives=[{"name": "y"}]']).directory == tmp_path


def test_a_mistake_in_an_override_names_the_override() -> None:
    with pytest.raises(ScenarioError, match=r"--set budget\.evaluation=3: \$\.budget\.evaluation: unknown key"):
        load_scenario(GOOD, overrides=["budget.evaluation=3"])


def test_a_mistake_that_a_part_finds_names_the_file(tmp_path: Path) -> None:
    texts = {"name": "Valid", "true_value": "a", "false_value": "a"}
    (tmp_path / "s.json").write_text(json.dumps({**GOOD, "feasible_output": texts}))
    with pytest.raises(ScenarioError, match=r"s\.json: \$\.feasible_output\.false_value: .* both called 'a'"):
        load_scenario(tmp_path / "s.json")


def test_a_mistake_in_a_base_names_the_base(tmp_path: Path) -> None:
    (tmp_path / "base.json").write_text('{"budget": {"evaluation": 3}}')
    (tmp_path / "s.json").write_text('{"extends": "base.json", "objectives": [{"name": "y"}]}')
    with pytest.raises(ScenarioError, match=r"base\.json: \$\.budget\.evaluation"):
        load_scenario(tmp_path / "s.json")


def test_a_mapping_that_is_not_json_is_an_error() -> None:
    with pytest.raises(ScenarioError, match="not JSON"):
        load_scenario(with_sections(seed={3}))


def test_numpy_numbers_are_numbers() -> None:
    x = {"parameter_type": "real", "values": np.array([0.0, 5.0]), "parameter_default": np.float32(0.5)}
    scenario = load_scenario(with_sections(seed=np.int64(3), input_parameters={"x": x}))
    assert scenario.seed == 3
    assert (scenario.parameters[0].values, scenario.parameters[0].parameter_default) == ((0.0, 5.0), 0.5)


def test_a_mapping_that_extends_a_number_is_an_error() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.extends: 5 names no file"):
        load_scenario({"extends": 5})


def test_a_mapping_that_holds_itself_is_an_error() -> None:
    loop: dict[str, Any] = {}
    loop["budget"] = loop
    with pytest.raises(ScenarioError, match="not JSON"):
        load_scenario(loop)


def test_the_home_folder_may_be_written_short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/home/me")
    scenario = load_scenario(GOOD, overrides=["output.directory=~/runs/a"])
    assert scenario.output.directory == "/home/me/runs/a"
    assert scenario.canonical["output"]["directory"] == "~/runs/a"


def test_a_mapping_can_extend_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "base.json").write_text(json.dumps(GOOD))
    assert load_scenario({"extends": "base.json", "seed": 3}) == load_scenario(GOOD | {"seed": 3})


def test_a_mapping_is_left_as_it_was() -> None:
    given = with_sections(surrogate="random_forest")
    before = copy.deepcopy(given)
    load_scenario(given, overrides=["seed=4"])
    assert given == before


def test_a_scenario_can_be_pickled() -> None:
    scenario = load_scenario(GOOD)
    assert pickle.loads(pickle.dumps(scenario)) == scenario


def test_one_parameter_may_have_only_one_prior() -> None:
    gaussian = {"type": "gaussian", "mean": 0, "std": 1}
    document = with_sections(priors=[{"type": "mixture", "components": [{"mean": {"x": 1}, "std": {"x": 2}}]}])
    document["input_parameters"]["x"]["prior"] = gaussian
    with pytest.raises(
        ScenarioError, match=r"\$\.priors\[0\].*'x' already has a prior at \$\.input_parameters\.x\.prior"
    ):
        load_scenario(document)


def test_the_beta_of_pibo_stays_open_until_the_budget_is_known() -> None:
    weighting = load_scenario(GOOD).acquisition.prior_weighting
    assert weighting is not None
    assert weighting.options["beta"] is None
    assert math.isclose(weighting.options["floor"], 0.05)


NUMBERS = st.floats(-5, 10)
STDS = st.floats(0.1, 5)
PARAMETERS = st.one_of(
    st.fixed_dictionaries(
        {"parameter_type": st.just("real"), "values": st.just([-5, 10.5])},
        optional={
            "parameter_default": NUMBERS,
            "prior": st.fixed_dictionaries({"type": st.just("gaussian"), "mean": NUMBERS, "std": STDS}),
        },
    ),
    st.fixed_dictionaries(
        {"parameter_type": st.just("integer"), "values": st.just([1, 8.0])},
        optional={"scale": st.sampled_from(["linear", "log"]), "prior": st.sampled_from(["uniform", None])},
    ),
    st.fixed_dictionaries({"parameter_type": st.just("categorical"), "values": st.just(["a", "b"])}),
)
SCENARIOS = st.fixed_dictionaries(
    {
        "input_parameters": st.dictionaries(st.sampled_from("abcdef"), PARAMETERS, min_size=1),
        "objectives": st.sampled_from([[{"name": "y"}], [{"name": "y", "goal": "maximize"}, {"name": "z"}]]),
    },
    optional={
        "seed": st.integers(0, 2**40),
        "preset": st.sampled_from(["paper", None]),
        "budget": st.fixed_dictionaries({}, optional={"evaluations": st.integers(1, 99), "minutes": STDS}),
        "optimizer": st.sampled_from(["bayesian", {"type": "random_search"}]),
        "surrogate": st.sampled_from(["random_forest", {"noise": False}, {"type": "random_forest", "max_features": 1}]),
        "acquisition": st.sampled_from(["thompson_sampling", {"scalarization": "linear", "prior_weighting": "none"}]),
        "evaluator": st.sampled_from(["none", {"type": "python", "function": "a:b", "replicates": 2.0}]),
    },
)


@settings(max_examples=50, deadline=None)
@given(SCENARIOS)
def test_any_scenario_loads_from_its_canonical_form(document: dict[str, Any]) -> None:
    scenario = load_scenario(document)
    assert load_scenario(json.loads(json.dumps(scenario.canonical))) == scenario


@pytest.mark.parametrize("given", [{"scalarization": "linear"}, {"weights": {"alpha": 2}}])
def test_who_gives_a_scalarization_gets_it(given: dict) -> None:
    assert load_scenario(GOOD | {"acquisition": given}).acquisition.function.type == "noisy_expected_improvement"
    spelt_out = {**given, "type": "noisy_expected_hypervolume_improvement"}
    assert load_scenario(GOOD | {"acquisition": spelt_out}).acquisition.function.type == spelt_out["type"]


PRIOR = {"type": "gaussian", "mean": 1, "std": 2}


@pytest.mark.parametrize(
    ("sections", "columns"),
    [
        pytest.param({}, (), id="no priors"),
        pytest.param({"own": True}, ("prior_trust", "prior_of"), id="of an objective"),
        pytest.param({"common": True}, ("prior_trust",), id="common"),
        pytest.param({"own": True, "acquisition": {"prior_weighting": {"safeguard": False}}}, ("prior_of",), id="safe"),
        pytest.param({"common": True, "preset": "paper"}, (), id="paper"),
        pytest.param({"common": True, "acquisition": {"prior_weighting": "none"}}, (), id="none"),
        pytest.param({"common": True, "optimizer": "random_search"}, (), id="no model"),
    ],
)
def test_the_history_has_the_columns_that_say_something_of_priors(sections: dict, columns: tuple[str, ...]) -> None:
    document = copy.deepcopy(GOOD) | {k: v for k, v in sections.items() if k not in ("own", "common")}
    if "own" in sections:
        document["objectives"][0]["priors"] = {"x": PRIOR}
    if "common" in sections:
        document["input_parameters"]["x"]["prior"] = PRIOR
    assert load_scenario(document).prior_columns == columns


def test_priors_of_an_objective_that_say_nothing_are_none() -> None:
    document = copy.deepcopy(GOOD)
    document["objectives"][0]["priors"] = {"x": "uniform"}
    scenario = load_scenario(document)
    assert scenario.objective_priors == ()
    assert not scenario.has_priors
