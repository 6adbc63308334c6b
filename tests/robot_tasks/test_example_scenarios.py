"""The example scenarios agree with the task they tune."""

import json
from pathlib import Path

import pytest

from robot_tasks.tasks import TASKS

FOLDER = Path(__file__).parents[2] / "example_scenarios" / "robot"
SCENARIOS = sorted(FOLDER.glob("*/*.json"))


def load(path: Path) -> dict:
    scenario = json.loads(path.read_text(encoding="utf-8"))
    base = scenario.pop("extends", None)
    return merge(load(path.with_name(base)), scenario) if base else scenario


def merge(base: dict, over: dict) -> dict:
    nested = {key: merge(base[key], over[key]) for key in base.keys() & over.keys() if isinstance(over[key], dict)}
    return base | over | nested


@pytest.fixture(params=SCENARIOS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def case(request):
    return TASKS[request.param.parent.name], load(request.param), request.param


def test_a_scenario_is_named_after_its_task_and_file(case):
    task, scenario, path = case
    assert scenario["application_name"] == f"{task.name}_{path.stem}"
    assert scenario["evaluator"]["function"] == f"robot_tasks:{task.name}"


def test_parameters_and_bounds_are_those_of_the_task(case):
    task, scenario, _ = case
    bounds = {name: entry["values"] for name, entry in scenario["input_parameters"].items()}
    assert bounds == {parameter.name: [parameter.low, parameter.high] for parameter in task.parameters}


def test_descriptions_are_those_of_the_task(case):
    task, scenario, _ = case
    descriptions = {name: entry["description"] for name, entry in scenario["input_parameters"].items()}
    assert descriptions == {p.name: f"{p.description} [{p.unit}]" for p in task.parameters}


def test_objectives_are_those_of_the_task_and_maximized(case):
    task, scenario, _ = case
    assert [objective["name"] for objective in scenario["objectives"]] == list(task.objectives)
    assert {objective["goal"] for objective in scenario["objectives"]} == {"maximize"}


def test_all_scenarios_of_a_task_share_budget_and_reference_point(case):
    _, scenario, path = case
    base = load(path.with_name("no_prior.json"))
    for key in ("seed", "budget", "objectives", "evaluator"):
        assert scenario[key] == base[key]


def test_either_all_parameters_have_a_prior_or_none(case):
    _, scenario, path = case
    has_prior = {"prior" in entry for entry in scenario["input_parameters"].values()}
    assert has_prior == {path.stem not in ("no_prior", "random_search")}
