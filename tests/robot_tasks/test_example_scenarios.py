"""The example scenarios agree with the task they tune."""

import json
from pathlib import Path

import pytest

from robot_tasks.tasks import TASKS

FOLDER = Path(__file__).parents[2] / "example_scenarios" / "robot"
SCENARIOS = sorted(path for task in TASKS for path in FOLDER.glob(f"{task}/*.json"))


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
    function = f"{task.name}_real" if path.stem.startswith("real_") else task.name
    assert scenario["evaluator"]["function"] == f"robot_tasks:{function}"


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
    for key in ("seed", "objectives"):
        assert scenario[key] == base[key]
    assert scenario["budget"]["evaluations"] == base["budget"]["evaluations"]


def test_simulations_share_the_evaluator_and_the_batch(case):
    _, scenario, path = case
    base = load(path.with_name("no_prior.json"))
    if not path.stem.startswith("real_"):
        assert (scenario["budget"], scenario["evaluator"]) == (base["budget"], base["evaluator"])


@pytest.mark.parametrize(("task", "replicates"), [("peg_insertion", 3), ("obstacle_avoidance", 1)])
@pytest.mark.parametrize("prior", ["no_prior", "operator_prior"])
def test_a_stand_in_is_tuned_one_at_a_time_with_few_replicates(task, replicates, prior):
    scenario = load(FOLDER / task / f"real_{prior}.json")
    assert scenario["budget"]["batch_size"] == 1
    assert scenario["evaluator"]["replicates"] == replicates


@pytest.mark.parametrize("task", ["peg_insertion", "object_pushing", "obstacle_avoidance"])
def test_every_task_of_the_paper_has_the_five_variants_of_the_paper(task):
    variants = {"no_prior", "operator_prior", "misleading_prior", "random_search", "prior_sampling"}
    assert variants <= {path.stem for path in (FOLDER / task).glob("*.json")}


@pytest.mark.parametrize("task", TASKS)
def test_one_sigma_box_is_that_of_the_operators_prior(task):
    box, operator = (load(FOLDER / task / f"{name}.json") for name in ("prior_sampling_box", "operator_prior"))
    for name, entry in operator["input_parameters"].items():
        mean, std, within = entry["prior"]["mean"], entry["prior"]["std"], box["input_parameters"][name]["prior"]
        assert (within["low"], within["high"]) == pytest.approx((mean - std, mean + std))


def test_either_all_parameters_have_a_prior_or_none(case):
    _, scenario, path = case
    is_joint = "priors" in scenario  # a density over all of them
    has_prior = {is_joint or "prior" in entry for entry in scenario["input_parameters"].values()}
    assert has_prior == {not path.stem.endswith(("no_prior", "random_search"))}
