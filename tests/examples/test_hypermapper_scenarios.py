"""The problems of `example_scenarios/hypermapper`: known answers of the formulas, and scenarios that fit them."""

from __future__ import annotations

import csv
import importlib
import importlib.util
import json
import math
import runpy
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from hypermap_lite import hypervolume, load_scenario, non_dominated, optimize

FOLDER = Path(__file__).parents[2] / "example_scenarios" / "hypermapper"
SCENARIOS = sorted(FOLDER.glob("*.json"))
FUNCTIONS = [file for file in SCENARIOS if file.with_suffix(".py").exists()]
ON_THEIR_OWN = {"chakong_haimes_client_server", "lookup"}
"""Scenarios whose results come from a client or a table instead of a function."""

translated = pytest.mark.skipif(
    importlib.util.find_spec("hypermap_lite.scenario.hypermapper") is None,
    reason="HyperMapper's scenario files are not read yet",
)


def name_of(file: Path) -> str:
    return file.stem


@pytest.fixture
def formulas(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    return module_of("formulas", monkeypatch)


@pytest.fixture
def lookup_table(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    return module_of("lookup_table", monkeypatch)


def module_of(name: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(FOLDER)
    return importlib.import_module(name)


def function_of(scenario: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[dict[str, Any]], Any]:
    monkeypatch.syspath_prepend(FOLDER)
    function: Callable[[dict[str, Any]], Any] = runpy.run_path(str(scenario.with_suffix(".py")))["evaluate"]
    return function


def first_configuration(document: dict[str, Any]) -> dict[str, Any]:
    batch = document.get("evaluations_per_optimization_iteration", 1)
    first = {name: parameter["values"][0] for name, parameter in document["input_parameters"].items()}
    return {name: [value] * batch for name, value in first.items()} if batch > 1 else first


@pytest.mark.parametrize(("x1", "x2"), [(-math.pi, 12.275), (math.pi, 2.275), (3 * math.pi, 2.475)])
def test_branin_has_three_minima(formulas: ModuleType, x1: float, x2: float) -> None:
    assert formulas.branin(x1, x2) == pytest.approx(0.397887, abs=1e-6)
    nearby = [formulas.branin(x1 + 0.01 * a, x2 + 0.01 * b) for a in (-1, 0, 1) for b in (-1, 0, 1)]
    assert min(nearby) >= 0.397887


def test_currin_is_smallest_in_a_corner(formulas: ModuleType) -> None:
    assert formulas.currin(0, 1) == pytest.approx(1.1804, abs=1e-4)
    grid = [formulas.currin(x1, x2) for x1 in np.linspace(0, 1, 101) for x2 in np.linspace(0.01, 1, 100)]
    assert min(grid) == formulas.currin(0, 1)


def test_chakong_haimes_has_its_known_feasible_share_and_hypervolume(formulas: ModuleType) -> None:
    axis = np.linspace(-19.9, 19.9, 200)  # the middles of cells, whose share is an area
    rows = np.array([formulas.chakong_haimes(x1, x2) for x1 in axis for x2 in axis])
    is_feasible = rows[:, 2] == 1
    assert is_feasible.mean() == pytest.approx(0.162, abs=1e-3)
    assert hypervolume(rows[is_feasible, :2], np.array([260.0, 20.0])) == pytest.approx(37_865, rel=5e-3)
    assert formulas.chakong_haimes(0, 0)[2] is False


def test_multiobjective_branin_has_its_known_hypervolume(formulas: ModuleType) -> None:
    X = [(x1, x2) for x1 in np.linspace(-5, 10, 201) for x2 in np.linspace(0, 15, 201)]
    Y = np.array([(formulas.branin(x1, x2), x1 + x2) for x1, x2 in X])
    assert hypervolume(Y, np.array([308.2, 25.0])) == pytest.approx(8444.4, rel=5e-3)


def test_ordinal_branin_has_twelve_optimal_points(formulas: ModuleType) -> None:
    Y = np.array([(formulas.branin(x1, x2), x1 + x2) for x1 in range(-5, 11) for x2 in range(16)])
    assert non_dominated(Y).sum() == 12
    assert hypervolume(Y, np.array([308.2, 25.0])) == pytest.approx(8280.29, abs=0.005)


def test_the_objectives_of_dtlz1_sum_to_a_half_on_the_front_and_to_more_elsewhere(formulas: ModuleType) -> None:
    for x1 in (0.0, 0.3, 1.0):
        assert formulas.dtlz1([x1, 0.5, 0.5, 0.5, 0.5, 0.5]) == pytest.approx((0.5 * x1, 0.5 * (1 - x1)))
    rng = np.random.default_rng(0)
    assert all(sum(formulas.dtlz1(x)) > 0.5 for x in rng.random((100, 6)))
    assert sum(formulas.dtlz1([0.2, 0, 1, 0, 1, 0])) == pytest.approx(0.5 * (1 + 100 * 5 * (0.25 + 1 + 1)))


def test_branin4_is_smallest_where_both_factors_are(monkeypatch: pytest.MonkeyPatch) -> None:
    best = function_of(FOLDER / "branin4.json", monkeypatch)({"x1": math.pi, "x2": 2.275, "x3": -3, "x4": 12})
    assert best == pytest.approx(0.1981, abs=5e-5)


def test_the_large_table_has_the_shape_of_a_design_space(lookup_table: ModuleType) -> None:
    rows = list(lookup_table.rows(lookup_table.TABLES["lookup_large"]))
    assert len(rows) == 76_800 == len({row[:4] for row in rows})
    is_valid = np.array([row[-1] for row in rows])
    assert is_valid.mean() == pytest.approx(0.045, abs=1e-3)


@pytest.mark.parametrize(("name", "size"), [("lookup", 19), ("lookup_large", 115)])
def test_a_table_has_a_front_of_many_points(lookup_table: ModuleType, name: str, size: int) -> None:
    valid = [row for row in lookup_table.rows(lookup_table.TABLES[name]) if row[-1]]
    assert non_dominated(np.array([(row[4], row[6]) for row in valid], dtype=float)).sum() == size


def test_the_committed_table_is_what_the_script_writes(lookup_table: ModuleType, tmp_path: Path) -> None:
    lookup_table.write(tmp_path, "lookup")
    assert (tmp_path / "lookup.csv").read_text() == (FOLDER / "lookup.csv").read_text()
    made, committed = (json.loads((folder / "lookup.json").read_text()) for folder in (tmp_path, FOLDER))
    assert Path(committed["hypermapper_mode"].pop("exhaustive_search_file")).name == "lookup.csv"
    made["hypermapper_mode"].pop("exhaustive_search_file")
    assert made == committed
    with (FOLDER / "lookup.csv").open(newline="") as file:
        assert set(next(csv.reader(file))) >= {*committed["input_parameters"], *committed["optimization_objectives"]}


@pytest.mark.parametrize("file", SCENARIOS, ids=name_of)
def test_a_scenario_is_named_after_its_file_and_stands_in_the_table(file: Path) -> None:
    assert json.loads(file.read_text())["application_name"] == f"hypermapper_{file.stem}"
    assert f"[`hypermapper/{file.name}`](hypermapper/{file.name})" in (FOLDER.parent / "README.md").read_text()


def test_every_scenario_has_its_function_or_needs_none() -> None:
    assert {file.stem for file in SCENARIOS} - {file.stem for file in FUNCTIONS} == ON_THEIR_OWN


@pytest.mark.parametrize("file", FUNCTIONS, ids=name_of)
def test_a_function_answers_its_scenario(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document = json.loads(file.read_text())
    result = function_of(file, monkeypatch)(first_configuration(document))
    names = list(document["optimization_objectives"])
    if "feasible_output" in document:
        names.append(document["feasible_output"]["name"])
    if isinstance(result, dict):
        assert list(result) == names
    elif isinstance(result, list):
        assert len(result) == document["evaluations_per_optimization_iteration"]
    else:
        assert np.isfinite(result)
        assert len(names) == 1


@translated
@pytest.mark.parametrize("file", SCENARIOS, ids=name_of)
def test_a_scenario_loads(file: Path) -> None:
    document = json.loads(file.read_text())
    scenario = load_scenario(file)
    assert [objective.name for objective in scenario.objectives] == document["optimization_objectives"]
    batch = document.get("evaluations_per_optimization_iteration", 1)
    design = document["design_of_experiment"]["number_of_samples"]
    assert scenario.budget.evaluations == design + batch * document["optimization_iterations"]


@translated
@pytest.mark.parametrize("file", FUNCTIONS, ids=name_of)
def test_a_scenario_runs_with_its_function(file: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    document = json.loads(file.read_text())
    document["design_of_experiment"]["number_of_samples"] = 4
    document["optimization_iterations"] = 2
    scenario = tmp_path / file.name
    scenario.write_text(json.dumps(document))
    monkeypatch.chdir(tmp_path)
    optimize(scenario, function_of(file, monkeypatch), output_directory=tmp_path / "out")
    with (tmp_path / "out" / "history.csv").open(newline="") as history:
        states = [row["state"] for row in csv.DictReader(history)]
    assert len(states) == 4 + 2 * document.get("evaluations_per_optimization_iteration", 1)
    assert set(states) <= {"completed", "infeasible"}
