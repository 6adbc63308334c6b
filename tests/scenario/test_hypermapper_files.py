"""HyperMapper's files and modes in our form, and its scenarios through the loader."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.cli import main
from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.hypermapper import is_hypermapper, translate
from tests.scenario.hypermapper_scenarios import (
    GOOD,
    HAS_FILES,
    MISSING,
    REAL,
    at,
    note_on,
    scenario,
    translated,
    write_rows,
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(path: Path, document: Any) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize(
    ("name", "ours"), [("demo", "demo"), ("a b/c", "a_b_c"), (".x", "x"), ("", "application"), ("é", "_")]
)
def test_an_application_may_be_called_anything(name: str, ours: str) -> None:
    document = translated(application_name=name)
    assert document["application_name"] == ours
    assert document["output"]["directory"] == f"{ours}_run"
    assert document["output"]["samples_file"] == f"{name}_output_samples.csv"


@pytest.mark.parametrize(
    ("directory", "file", "ours"),
    [
        (".", "s.csv", "s.csv"),
        ("", "s.csv", "s.csv"),
        ("out/", "s.csv", "out/s.csv"),
        ("/tmp/out", "s.csv", "/tmp/out/s.csv"),
        ("out", "/data/s.csv", "/data/s.csv"),
    ],
)
def test_results_are_relative_to_the_run_directory(directory: str, file: str, ours: str) -> None:
    document = translated(run_directory=directory, output_data_file=file)
    assert document["output"]["samples_file"] == ours


@pytest.mark.parametrize("is_elsewhere", [False, True])
def test_a_file_is_the_one_in_the_working_directory(folder: Path, is_elsewhere: bool) -> None:
    home = folder / "scenarios" if is_elsewhere else folder
    home.mkdir(exist_ok=True)
    write_rows(folder, "table.csv", 2)
    mode = {"mode": "exhaustive", "exhaustive_search_file": "table.csv"}
    document = translate(scenario(hypermapper_mode=mode), home).document
    assert document["evaluator"]["file"] == (str(folder / "table.csv") if is_elsewhere else "table.csv")


def test_a_file_that_is_only_beside_the_scenario_is_found_too(folder: Path) -> None:
    (folder / "scenarios").mkdir()
    write_rows(folder / "scenarios", "old.csv", 2)
    changes = {"resume_optimization": True, "resume_optimization_data": "old.csv"}
    document = translate(scenario(**changes), folder / "scenarios").document
    assert document["earlier_evaluations"] == "old.csv"
    assert document["budget"]["evaluations"] == 60


@pytest.mark.parametrize(
    ("mode", "says"),
    [
        ({"mode": "exhaustive"}, "the key 'exhaustive_search_file' is missing"),
        ({"mode": "exhaustiv"}, "Did you mean 'exhaustive'"),
        ({"mode": "grpc"}, "there is no mode 'grpc' here"),
        ("client-server", "is a string"),
    ],
)
def test_a_mode_that_cannot_be_is_named(mode: Any, says: str) -> None:
    with pytest.raises(ScenarioError, match=says) as caught:
        translated(hypermapper_mode=mode)
    assert caught.value.path.startswith("$.hypermapper_mode")


def test_a_mode_that_cannot_be_is_answered_with_all_that_can() -> None:
    with pytest.raises(ScenarioError) as caught:
        translate(scenario(hypermapper_mode={"mode": "stateless"}))
    assert caught.value.allowed == "default, client-server, exhaustive"


@pytest.mark.parametrize(
    ("output", "values"),
    [
        ({"true_value": "1", "false_value": "0"}, ("1", "0")),
        ({"true_value": "1"}, ("1", "false")),
        ({}, ("true", "false")),
    ],
)
def test_values_of_feasibility_that_are_left_out_are_in_lower_case(output: dict[str, str], values: Any) -> None:
    translation = translate(scenario(feasible_output={"enable_feasible_predictor": True, **output}))
    feasible = translation.document["feasible_output"]
    assert (feasible["true_value"], feasible["false_value"]) == values
    assert bool(note_on(translation, "feasible_output")) == (len(output) < 2)


def test_without_the_predictor_there_is_no_column() -> None:
    translation = translate(scenario(feasible_output={"name": "Ok"}))
    assert at(translation.document, "feasible_output") is MISSING
    assert "without enable_feasible_predictor" in note_on(translation, "feasible_output.name")


def test_what_makes_a_file_hypermappers() -> None:
    assert is_hypermapper(GOOD)
    assert not is_hypermapper({**GOOD, "objectives": []})
    assert not is_hypermapper({"objectives": []})


@pytest.mark.parametrize(
    ("changes", "path", "says"),
    [
        ({"optimization_iteration": 5}, "$.optimization_iteration", "Did you mean 'optimization_iterations'"),
        ({"design_of_experiment": {"doe_typ": "x"}}, "$.design_of_experiment.doe_typ", "doe_type'"),
        ({"design_of_experiment": "grid_search"}, "$.design_of_experiment", "is a string"),
        ({"extends": "base.json"}, "$.extends", "extends no other"),
        ({"optimization_objectives": []}, "$.optimization_objectives", "not empty"),
        ({"input_parameters": {}}, "$.input_parameters", "is empty"),
        ({"time_budget": -2}, "$.time_budget", "too small"),
    ],
)
def test_a_mistake_is_named_with_hypermappers_key(changes: dict[str, Any], path: str, says: str) -> None:
    with pytest.raises(ScenarioError, match=says) as caught:
        translate(scenario(**changes))
    assert caught.value.path == path


def test_an_unknown_key_that_is_no_slip_does_nothing() -> None:
    translation = translate(scenario(my_own_remark="x"))
    assert translation.document == translated()
    assert translation.brief() == ("my_own_remark: nothing follows from this key here",)


def test_without_parameters_it_is_said_at_once() -> None:
    with pytest.raises(ScenarioError, match="the key 'input_parameters' is missing"):
        translate({"optimization_objectives": ["a"]})


def test_sections_of_our_own_win() -> None:
    document = translated(
        evaluations_per_optimization_iteration=2,
        evaluator={"type": "python", "function": "a:b"},
        surrogate="gaussian_process",
    )
    assert document["evaluator"] == {"type": "python", "function": "a:b", "batch": True}
    assert document["surrogate"] == {"type": "gaussian_process"}


@HAS_FILES
def test_a_file_loads(folder: Path) -> None:
    loaded = load_scenario(write(folder / "hm.json", scenario(log_file="a.log", profiling=True)))
    assert loaded.budget.evaluations == 60
    assert loaded.notes == ("log_file, profiling: nothing follows from these keys here",)
    assert load_scenario(loaded.canonical) == loaded


@HAS_FILES
def test_a_mapping_loads() -> None:
    assert load_scenario(GOOD).parameters[0].values == (-5.0, 10.0)


@HAS_FILES
def test_our_files_extend_hypermappers_and_overrides_go_on_top(folder: Path) -> None:
    write(folder / "hm.json", GOOD)
    top = write(folder / "top.json", {"extends": "hm.json", "surrogate": "gaussian_process"})
    loaded = load_scenario(top, overrides=["budget.evaluations=20", "seed=3"])
    assert loaded.surrogate.type == "gaussian_process"
    assert loaded.budget.evaluations == 20
    assert loaded.seed == 3
    assert loaded.maximizer.type == "local_search"


@pytest.mark.parametrize(
    ("key", "says"),
    [("optimization_iterations=3", "key for budget.evaluations"), ("number_of_cpus=3", "does nothing here")],
)
def test_an_override_with_hypermappers_key_says_what_it_is_here(key: str, says: str) -> None:
    ours = {"input_parameters": {"x": REAL}, "objectives": [{"name": "y"}]}
    with pytest.raises(ScenarioError, match=rf"--set {key}: (.|\n)*{says}"):
        load_scenario(ours, overrides=[key])


@HAS_FILES
def test_a_function_that_is_missing_is_named_with_hypermappers_key(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(folder / "hm.json", GOOD)
    assert main(["hm.json"]) == 2
    assert "hm.json: $.hypermapper_mode.mode: the scenario names no evaluator" in capsys.readouterr().err


@HAS_FILES
@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({"optimization_objectives": ["a b"]}, "$.optimization_objectives[0]: "),
        ({"optimization_objectives": ["error"]}, "$.optimization_objectives[0]: "),
        ({"input_parameters": {"x": {**REAL, "values": [10, -5]}}}, "$.input_parameters.x"),
    ],
)
def test_what_is_found_later_is_named_with_hypermappers_key(
    folder: Path, capsys: pytest.CaptureFixture[str], changes: Any, place: str
) -> None:
    write(folder / "hm.json", scenario(**changes))
    assert main(["check", "hm.json"]) == 2
    assert capsys.readouterr().err.startswith(f"error: hm.json: {place}")
