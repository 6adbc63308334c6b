"""Tests for upgrade.py."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.cli import main
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.upgrade import minimal, pretty, upgrade
from tests.scenario.hypermapper_scenarios import CATEGORICAL, HAS_FILES, INTEGER, ORDINAL, REAL, needs, scenario

OURS = {"input_parameters": {"x": REAL}, "objectives": [{"name": "y"}]}

VARIANTS: dict[str, dict[str, Any]] = {
    "plain": {},
    "gaussian_process": {"models": {"model": "gaussian_process"}, "noise": False, "epsilon_greedy_threshold": 0},
    "two_objectives": {"optimization_objectives": ["a", "b"], "scalarization_method": "linear"},
    "box": {"optimization_objectives": ["a", "b"], "weight_sampling": "bounding_box", "bounding_box_limits": [3, 1]},
    "mixed_with_priors": {
        "input_parameters": {
            "r": {**REAL, "prior": "decay", "parameter_default": 2},
            "n": {**INTEGER, "prior": "custom_gaussian"},
            "o": {**ORDINAL, "prior": [0.1, 0.2, 0.3, 0.4]},
            "c": CATEGORICAL,
        }
    },
    "knots": {"input_parameters": {"r": {**REAL, "prior": [1, 2, 1]}}},
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder: Path, document: Any, name: str = "hm.json") -> Path:
    (folder / name).write_text(json.dumps(document))
    return folder / name


@HAS_FILES
@pytest.mark.parametrize("name", VARIANTS)
def test_the_upgraded_file_is_the_same_scenario(folder: Path, name: str) -> None:
    file = write(folder, scenario(**VARIANTS[name]))
    (folder / "new.json").write_text(upgrade(file).text)
    assert load_scenario(folder / "new.json").canonical == load_scenario(file).canonical


@HAS_FILES
def test_the_upgraded_file_gives_the_same_suggestions(folder: Path) -> None:
    from hypermap_lite import Optimizer

    changes = {"optimization_iterations": 2, "design_of_experiment": {"number_of_samples": 3}}
    file = write(folder, scenario(**changes))
    (folder / "new.json").write_text(upgrade(file).text)
    suggested = []
    for path in (file, folder / "new.json"):
        optimizer = Optimizer(path)
        for _ in range(5):
            (suggestion,) = optimizer.ask(1)
            optimizer.tell(suggestion, {"cost": sum(map(float, suggestion.configuration.values()))})
        suggested.append([evaluation.suggestion.configuration for evaluation in optimizer.history])
    assert suggested[0] == suggested[1]


@HAS_FILES
def test_it_says_what_differs_from_our_defaults_only(folder: Path) -> None:
    document = json.loads(upgrade(write(folder, scenario(optimization_iterations=40))).text)
    assert "budget" not in document  # 10 + 40 is our default
    assert document["surrogate"]["type"] == "random_forest"
    assert document["optimizer"] == {"epsilon": 0.1}
    assert document["objectives"] == [{"name": "cost"}]


@HAS_FILES
def test_the_command_prints_the_scenario_and_a_line_per_key(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder, scenario(log_file="a.log", prior_method="pibo", output_pareto_file="f.csv"))
    assert main(["check", "--upgrade", "hm.json", "--set", "seed=4"]) == 0
    printed = capsys.readouterr()
    assert json.loads(printed.out)["seed"] == 4
    keys = [line.partition(":")[0] for line in printed.err.splitlines()]
    assert {"log_file", "prior_method", "output_pareto_file"} <= set(keys)
    assert len(keys) == len(set(keys))


def test_a_file_of_our_own_is_printed_as_it_is(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(folder, OURS)
    assert main(["check", "--upgrade", "hm.json"]) == 0
    printed = capsys.readouterr()
    assert printed.out.strip() == file.read_text()
    assert "our own form already" in printed.err


def test_a_broken_file_is_an_error_and_prints_nothing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder, scenario(time_budget="long"))
    assert main(["check", "--upgrade", "hm.json"]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert 'hm.json: $.time_budget: "long" is a string' in printed.err


def test_a_preset_keeps_what_it_would_change() -> None:
    document = {**OURS, "preset": "paper", "acquisition": {"scalarization": {"type": "tchebyshev"}}}
    assert minimal(document) == document


def test_defaults_are_left_out() -> None:
    document = {
        **OURS,
        "seed": 0,
        "surrogate": {"type": "gaussian_process", "noise": True},
        "budget": {"batch_size": 2},
    }
    assert minimal(document) == {**OURS, "budget": {"batch_size": 2}}


def test_what_fits_stands_on_one_line() -> None:
    assert (
        pretty({"a": [1, 2], "b": {"c": "d" * 100}})
        == '{\n  "a": [1, 2],\n  "b": {\n    "c": "' + "d" * 100 + '"\n  }\n}'
    )


@HAS_FILES
@needs("evaluator", kind="client_server")
def test_a_client_reads_no_note_on_stdout(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder, scenario(hypermapper_mode={"mode": "client-server"}, log_file="a.log"))
    load_scenario(folder / "hm.json")
    assert capsys.readouterr().out == ""
