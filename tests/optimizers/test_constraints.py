"""Every optimizer keeps to the constraints."""

import json
from dataclasses import replace

import numpy as np
import pytest

from hypermap_lite import optimize
from hypermap_lite.assembly import build_optimizer, build_space
from hypermap_lite.errors import ScenarioError, UsageError
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.evaluation.runner import StopReason
from hypermap_lite.optimizers import OPTIMIZERS
from hypermap_lite.scenario.lint import lint
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.scenario.summary import summarize
from tests.constrained import SPACES, space_of
from tests.optimizers.runs import evaluate, resumed, run, scenario_of
from tests.slow import slow_unless

every_optimizer = pytest.mark.parametrize("kind", OPTIMIZERS)


def constrained(name: str, **changes: object) -> dict:
    parameters, constraints = SPACES[name]
    return scenario_of(input_parameters=parameters, constraints=constraints, **changes)


def objectives(configuration: dict) -> dict[str, float]:
    numbers = [float(value) if not isinstance(value, str) else 0.0 for value in configuration.values()]
    return {"near": sum(numbers), "far": numbers[0] - numbers[-1] ** 2}


@pytest.mark.parametrize(
    ("kind", "name"),
    slow_unless(
        lambda kind, name: kind == "bayesian" or name == "ring",
        [
            (kind, name)
            for kind in OPTIMIZERS
            for name in ("ring", "tiny", "mixed", "mixed equality", "sum")
            if kind != "cma_es" or not name.startswith("mixed")  # it knows numbers only
        ],
    ),
)
def test_every_suggestion_meets_the_constraints_and_a_resumed_run_goes_on(kind: str, name: str) -> None:
    scenario, space = constrained(name, optimizer=kind), space_of(name)
    whole = run(scenario, 9, batch=2, function=objectives)
    assert len(whole.history) == 9
    assert all(space.contains(e.configuration) for e in whole.history)
    again = resumed(scenario, list(whole.history)[:6])
    expected = [e.suggestion for e in whole.history][6:8]
    assert [replace(s, seconds=0) for s in again.ask(2)] == [replace(s, seconds=0) for s in expected]


@every_optimizer
@pytest.mark.parametrize("name", ["sum", "single"])
def test_a_finite_space_ends_when_all_allowed_configurations_are_evaluated(kind: str, name: str) -> None:
    n = int(space_of(name).n_configurations)
    optimizer = run(constrained(name, optimizer=kind, budget={"evaluations": 99}), 99, batch=4, function=objectives)
    assert len({tuple(e.configuration.values()) for e in optimizer.history}) == len(optimizer.history) == n
    assert optimizer.ask() == []


def test_a_run_over_all_allowed_configurations_says_so(tmp_path) -> None:
    result = optimize(constrained("single"), objectives, output_directory=tmp_path)
    assert result.stop_reason is StopReason.EXHAUSTED
    assert [e.configuration for e in result.evaluations] == [{"k": 5, "l": 5, "m": 5}]


def test_a_constrained_optimum_at_the_edge_is_found() -> None:
    scenario = constrained("half", objectives=[{"name": "y"}], budget={"evaluations": 20})
    optimizer = run(scenario, 20, function=lambda c: {"y": (c["a"] - 0.9) ** 2 + (c["b"] - 0.6) ** 2})
    best = min(optimizer.history, key=lambda e: e.values["y"])
    assert [best.configuration[name] for name in "ab"] == pytest.approx([0.65, 0.35], abs=0.03)


def test_priors_pull_within_what_is_allowed() -> None:
    prior = {"type": "gaussian", "mean": 0.8, "std": 0.05}
    parameters = {name: {"parameter_type": "real", "values": [0, 1], "prior": prior} for name in "ab"}
    design = {"type": "prior_sampling", "uniform_share": 0, "number_of_samples": 5}
    scenario = scenario_of(input_parameters=parameters, constraints=["a + b <= 1.4"], design_of_experiment=design)
    optimizer = run(scenario, 8, function=objectives)
    X = np.array([list(e.configuration.values()) for e in optimizer.history])
    assert (X.sum(axis=1) <= 1.4).all()
    assert X[:5].min() > 0.5


def test_a_history_with_a_forbidden_configuration_is_refused() -> None:
    scenario = constrained("half")
    bad = evaluate(Suggestion(trial=0, configuration={"a": 0.9, "b": 0.9}, phase="design"), objectives)
    with pytest.raises(UsageError, match="trial 0 is not of this search space"):
        resumed(scenario, [bad])


def test_a_default_that_violates_a_constraint_is_an_error() -> None:
    parameters = {name: {"parameter_type": "real", "values": [0, 1], "parameter_default": 0.7} for name in "ab"}
    scenario = scenario_of(input_parameters=parameters, constraints=["a > 0", "a + b <= 1"])
    with pytest.raises(ScenarioError, match=r"\$.constraints\[1\]: the default configuration \(a = 0.7, b = 0.7\)"):
        build_optimizer(load_scenario(scenario))


@pytest.mark.parametrize(
    ("constraints", "message"),
    [
        (
            ["a < 1", "a + b > 9"],
            r"\$.constraints\[1\]: no configuration among 200,000 random ones meets it: a \+ b > 9",
        ),
        (["a < 0.4", "a > 0.6"], r"\$.constraints: no configuration among 200,000 random ones meets all 2 constraints"),
        (["a < 1", "a + x < 2"], r"\$.constraints\[1\]: column 5 of 'a \+ x < 2': there is no parameter 'x'"),
    ],
)
def test_constraints_that_nothing_meets_or_nobody_understands_are_errors(constraints: list[str], message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        build_optimizer(load_scenario(scenario_of(constraints=constraints)))


def test_finite_constraints_that_nothing_meets_are_an_error() -> None:
    parameters, _ = SPACES["sum"]
    scenario = load_scenario(scenario_of(input_parameters=parameters, constraints=["k + l + m > 15"]))
    with pytest.raises(ScenarioError, match=r"\$.constraints\[0\]: no configuration meets it"):
        build_optimizer(scenario)


def test_check_shows_constraints_and_warns_of_tight_ones() -> None:
    loose, tight = (load_scenario(constrained(name)) for name in ("half", "tiny"))
    assert "constraints a + b <= 1" in summarize(loose)
    assert not [text for text in lint(loose, build_space(loose)) if "constraints" in text]
    (warning,) = [text for text in lint(tight, build_space(tight)) if "constraints" in text]
    assert warning.startswith("$.constraints: fewer than 0.1 % of uniform draws meet them")


def test_check_counts_the_allowed_configurations() -> None:
    scenario = load_scenario(constrained("single"))
    assert "$.budget.evaluations: there are only 1 configurations" in "\n".join(lint(scenario, build_space(scenario)))


def test_a_run_folder_of_before_there_were_constraints_is_gone_on_with(tmp_path) -> None:
    scenario = scenario_of(budget={"evaluations": 3}, design_of_experiment={"number_of_samples": 2})
    optimize(scenario, objectives, output_directory=tmp_path)
    recorded = json.loads((tmp_path / "scenario.json").read_text())
    assert recorded.pop("constraints") == []
    (tmp_path / "scenario.json").write_text(json.dumps(recorded))
    result = optimize(scenario | {"budget": {"evaluations": 4}}, objectives, output_directory=tmp_path)
    assert len(result.evaluations) == 4
