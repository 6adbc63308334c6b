"""Tests for prior_from.py, by way of the loader."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario import Scenario, load_scenario
from tests.scenario.bad_scenarios import GOOD


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run").mkdir()
    header, rows = "x,n,size,mode,cost,gain", ("1,2,16,safe,1,1", "2,3,16,safe,2,0", "3,4,16,fast,2,2")
    (tmp_path / "run" / "history.csv").write_text("\n".join([header, *rows]) + "\n")
    return tmp_path


def loaded(*overrides: str, source: Any = None, **sections: Any) -> Scenario:
    document = copy.deepcopy(GOOD) | sections
    return load_scenario(document if source is None else source, prior_from="run", overrides=overrides)


def test_the_front_of_the_run_becomes_the_prior_and_the_design() -> None:
    scenario = loaded(design_of_experiment={"type": "sobol", "number_of_samples": 9})
    (prior,) = scenario.joint_priors
    assert (prior.type, prior.options["file"], prior.options["points"]["x"]) == ("kde", "run", [1, 3])
    assert (scenario.design.type, scenario.design.number_of_samples) == ("prior_sampling", 9)
    assert scenario.notes == ()


def test_priors_of_the_scenario_are_dropped_with_a_note() -> None:
    parameters = copy.deepcopy(GOOD["input_parameters"])
    parameters["x"]["prior"] = {"type": "gaussian", "mean": 0, "std": 1}
    parameters["mode"]["prior"] = {"type": "weights", "weights": [1, 2]}
    joint = [{"type": "mixture", "components": [{"mean": {"n": 2}, "std": {"n": 1}}]}]
    scenario = loaded(input_parameters=parameters, priors=joint)
    assert set(scenario.joint_priors[0].options["points"]) == {"x", "n", "size", "mode"}
    assert all(parameter.prior is None for parameter in scenario.parameters)
    assert scenario.notes == ("--prior-from run takes the place of the priors of x, mode and the joint prior",)


def test_priors_of_the_objectives_are_dropped_with_a_note() -> None:
    objectives = copy.deepcopy(GOOD["objectives"])
    objectives[1]["priors"] = {"x": {"type": "gaussian", "mean": 0, "std": 1}}
    scenario = loaded(objectives=objectives)
    assert scenario.objective_priors == ()
    assert scenario.objectives[1].name == "gain"
    assert scenario.notes == ("--prior-from run takes the place of the priors of the objectives",)


def test_overrides_come_on_top() -> None:
    scenario = loaded("design_of_experiment.type=sobol", "priors.0.rows=all", "input_parameters.n.prior.type=beta",
                      "input_parameters.n.prior.shape=decay")  # fmt: skip
    assert scenario.design.type == "sobol"
    assert scenario.joint_priors[0].options["points"] == {
        "x": [1, 2, 3],
        "size": [16] * 3,
        "mode": ["safe"] * 2 + ["fast"],
    }


def test_it_is_looked_for_in_the_working_directory(folder: Path) -> None:
    (folder / "sub" / "run").mkdir(parents=True)
    (folder / "sub" / "s.json").write_text('{"objectives": [{"name": "cost"}], "input_parameters": '
                                           '{"x": {"parameter_type": "real", "values": [0, 5]}}}')  # fmt: skip
    assert loaded(source=folder / "sub" / "s.json").joint_priors[0].options["points"] == {"x": [1]}


def test_a_mistake_in_it_names_the_option() -> None:
    with pytest.raises(ScenarioError, match=r"--prior-from rum: \$\.priors\[0\]\.file.*no file 'rum'"):
        load_scenario(GOOD, prior_from="rum")


def test_mistakes_elsewhere_keep_their_place() -> None:
    with pytest.raises(ScenarioError, match=r"\$\.input_parameters\.x: the key 'values' is missing"):
        loaded(input_parameters={"x": {"parameter_type": "real", "prior": "uniform"}})


@pytest.mark.parametrize("sections", [{"input_parameters": 3}, {"input_parameters": {"x": 3}}, {"priors": 3}])
def test_sections_of_the_wrong_type_are_left_to_the_schemas(sections: dict[str, Any]) -> None:
    if "priors" in sections:
        assert loaded(**sections).joint_priors
    else:
        with pytest.raises(ScenarioError, match="3 is a number"):
            loaded(**sections)
