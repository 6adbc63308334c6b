"""The composition root."""

import json
from pathlib import Path

import numpy as np
import pytest

from hypermap_lite import assembly
from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates import RandomForest
from tests.optimizers.runs import scenario_of

PARAMETERS = {
    "r": {"parameter_type": "real", "values": [1, 100], "scale": "log"},
    "o": {"parameter_type": "ordinal", "values": [8, 2, 4], "prior": {"type": "weights", "weights": [5, 1, 2]}},
    "c": {"parameter_type": "categorical", "values": ["a", "b"]},
    "n": {"parameter_type": "integer", "values": [0, 9]},
}


def load(**changes: object):
    return load_scenario(scenario_of(input_parameters=PARAMETERS) | changes)


def test_the_space_has_the_parameters_in_their_order() -> None:
    space = assembly.build_space(load())
    assert space.names == ("r", "o", "c", "n")
    assert space.encode([{"r": 10, "o": 2, "c": "b", "n": 9}])[0] == pytest.approx([0.5, 1 / 6, 0.75, 0.95])


def test_weights_of_an_ordinal_follow_the_values_as_written() -> None:
    scenario = load()
    space = assembly.build_space(scenario)
    prior = assembly.build_prior(scenario, space)
    points = space.encode([{"r": 10, "o": o, "c": "a", "n": 0} for o in (8, 2, 4)])
    assert np.exp(prior.log_density(points)) / 3 == pytest.approx([5 / 8, 1 / 8, 2 / 8])


def test_joint_priors_find_their_axes() -> None:
    joint = [{"type": "mixture", "components": [{"mean": {"n": 3, "r": 10}, "std": {"n": 0.1, "r": 0.01}}]}]
    scenario = load(priors=joint)
    space = assembly.build_space(scenario)
    x = space.decode(assembly.build_prior(scenario, space).sample(5, np.random.default_rng(0)))
    assert {c["n"] for c in x} == {3}
    assert [c["r"] for c in x] == pytest.approx([10] * 5, rel=0.1)


def test_a_parameter_with_two_priors_is_refused() -> None:
    joint = [{"type": "mixture", "components": [{"mean": {"o": 3}, "std": {"o": 1}}]}]
    with pytest.raises(ScenarioError, match=r"\$\.priors\[0\].*'o'"):
        assembly.validate(load(priors=joint))


def test_the_automatic_design_draws_from_priors_where_there_are_some() -> None:
    without = {"r": PARAMETERS["r"]}
    assert type(assembly.build_design(load())).__name__ == "PriorSampling"
    assert type(assembly.build_design(load(input_parameters=without))).__name__ == "Sobol"


def test_options_reach_the_member() -> None:
    method = assembly.build_method(load(surrogate={"type": "random_forest", "number_of_trees": 7}))
    assert method.surrogate == RandomForest(number_of_trees=7)


def test_a_member_that_refuses_its_options_is_named_by_its_place() -> None:
    broken = PARAMETERS | {"o": {**PARAMETERS["o"], "prior": {"type": "weights", "weights": [1, 1]}}}
    scenario = load(input_parameters=broken)
    with pytest.raises(ScenarioError, match=r"\$\.input_parameters\.o\.prior\.weights: 2 weights for the 3 levels"):
        assembly.validate(scenario)


def test_without_an_evaluator_the_message_says_what_to_do() -> None:
    with pytest.raises(ScenarioError, match=r"hypermap_lite\.optimize"):
        assembly.build_evaluator(load())


def write_layers(tmp_path: Path, evaluator: dict[str, object]) -> Path:
    """Write `common/base.json`, which says what to call, and a leaf beside it that extends it; return the leaf."""
    for folder in ("common", "mine"):
        (tmp_path / folder).mkdir()
    (tmp_path / "common" / "base.json").write_text(json.dumps(scenario_of(evaluator=evaluator)))
    leaf = tmp_path / "mine" / "leaf.json"
    leaf.write_text('{"extends": "../common/base.json"}')
    return leaf


@pytest.mark.parametrize("folder", ["common", "mine"])
def test_a_module_is_found_beside_the_file_that_names_it_or_beside_the_scenario(tmp_path: Path, folder: str) -> None:
    leaf = write_layers(tmp_path, {"type": "python", "function": f"black_box_in_{folder}:f"})
    (tmp_path / folder / f"black_box_in_{folder}.py").write_text("def f(c): return 1")
    assembly.build_evaluator(load_scenario(leaf))


@pytest.mark.parametrize("command", [["./simulate"], ["sh", "simulate"]], ids=["program", "argument"])
@pytest.mark.parametrize("folder", ["common", "mine"])
def test_a_command_runs_in_the_folder_that_holds_its_files(tmp_path: Path, folder: str, command: list[str]) -> None:
    leaf = write_layers(tmp_path, {"type": "command", "command": command})
    (tmp_path / folder / "simulate").write_text("#!/bin/sh\n")
    (tmp_path / folder / "simulate").chmod(0o755)
    assert assembly.build_evaluator(load_scenario(leaf)).working_directory == tmp_path / folder


def test_a_command_of_installed_programs_runs_beside_the_file_that_names_it(tmp_path: Path) -> None:
    leaf = write_layers(tmp_path, {"type": "command", "command": ["echo"]})
    assert assembly.build_evaluator(load_scenario(leaf)).working_directory == tmp_path / "common"
    override = 'evaluator.command=["echo", "1"]'
    assert assembly.build_evaluator(load_scenario(leaf, overrides=[override])).working_directory == tmp_path / "mine"


def test_a_given_function_takes_the_place_of_the_evaluator() -> None:
    assert assembly.build_evaluator(load(), lambda c: {"near": 0, "far": 0}) is not None


def test_a_density_of_points_finds_its_axes() -> None:
    priors = [{"type": "kde", "points": {"n": [3, 4], "c": ["b", "b"], "r": [10, 12]}}]
    scenario = load(priors=priors)
    space = assembly.build_space(scenario)
    prior = assembly.build_prior(scenario, space)
    likely, unlikely = space.encode([{"r": r, "o": 8, "c": c, "n": n} for r, c, n in ((11, "b", 3), (90, "a", 9))])
    assert prior.log_density(likely[None])[0] > prior.log_density(unlikely[None])[0] + 3
    assembly.validate(scenario)


def test_a_uniform_prior_counts_only_with_a_range() -> None:
    def prior_of(entry: object):
        scenario = load(input_parameters={"r": {**PARAMETERS["r"], "prior": entry}})
        return assembly.build_prior(scenario, assembly.build_space(scenario)), assembly.build_design(scenario)

    without, design = prior_of("uniform")
    assert (without.is_uniform, type(design).__name__) == (True, "Sobol")
    ranged, design = prior_of({"type": "uniform", "low": 10})
    assert np.exp(ranged.log_density(np.array([[0.4], [0.6]]))) == pytest.approx([0, 2])
    assert type(design).__name__ == "PriorSampling"


def test_a_client_is_asked_for_the_whole_design_first() -> None:
    design, budget = {"number_of_samples": 5}, {"batch_size": 2}
    plan = assembly.build_plan(load(evaluator="client_server", design_of_experiment=design, budget=budget))
    assert (plan.first, plan.size) == (5, 2)
    assert assembly.build_plan(load(design_of_experiment=design, budget=budget)).first is None


def test_a_batch_function_may_be_named_or_given() -> None:
    assert assembly.build_evaluator(load(evaluator={"batch": True}), lambda columns: []).batch
    named = {"type": "python", "function": "tests.evaluation.black_boxes:batch_of_spheres", "batch": True}
    assert assembly.build_evaluator(load(evaluator=named)).batch


def test_a_table_is_found_beside_the_file_that_names_it_and_its_gaps_are_told(tmp_path: Path) -> None:
    parameters = {"n": PARAMETERS["n"]}
    for folder in ("common", "mine"):
        (tmp_path / folder).mkdir()
    content = scenario_of(input_parameters=parameters, evaluator={"type": "exhaustive", "file": "table.csv"})
    (tmp_path / "common" / "base.json").write_text(json.dumps(content))
    (tmp_path / "common" / "table.csv").write_text("n,near,far\n" + "".join(f"{n},1,2\n" for n in range(5)))
    (tmp_path / "mine" / "leaf.json").write_text('{"extends": "../common/base.json"}')
    assert assembly.validate(load_scenario(tmp_path / "mine" / "leaf.json")) == [
        "$.evaluator.file: the table holds 5 configurations of 10 (50 %); any other is a failed evaluation."
    ]
    (tmp_path / "common" / "table.csv").unlink()
    with pytest.raises(ScenarioError, match=r"\$\.evaluator\.file: there is no file"):
        assembly.validate(load_scenario(tmp_path / "mine" / "leaf.json"))
