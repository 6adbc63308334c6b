"""Short runs of an optimizer on functions in closed form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from hypermap_lite.assembly import build_history, build_optimizer
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers import Optimizer
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.typing import Configuration

Function = Callable[[Configuration], Mapping[str, float]]


def scenario_of(**changes: Any) -> dict[str, Any]:
    """Return a scenario with two real parameters and two objectives."""
    scenario = {
        "input_parameters": {
            "a": {"parameter_type": "real", "values": [0, 1]},
            "b": {"parameter_type": "real", "values": [-5, 5]},
        },
        "objectives": [{"name": "near"}, {"name": "far", "goal": "maximize"}],
        "design_of_experiment": {"number_of_samples": 5},
        "budget": {"evaluations": 12},
        "seed": 3,
    }
    return scenario | changes


def two_objectives(configuration: Configuration) -> dict[str, float]:
    """Return two conflicting quadratics."""
    a, b = float(configuration["a"]), float(configuration["b"]) / 5
    return {"near": (a - 0.2) ** 2 + b * b, "far": -((a - 0.8) ** 2) - (b - 0.5) ** 2}


def evaluate(suggestion: Suggestion, function: Function = two_objectives) -> Evaluation:
    """Return the completed evaluation of a suggestion."""
    return Evaluation(suggestion=suggestion, state=State.COMPLETED, values=function(suggestion.configuration))


def fail(suggestion: Suggestion) -> Evaluation:
    """Return the failed evaluation of a suggestion."""
    return Evaluation(suggestion=suggestion, state=State.FAILED, error="broken")


def run(scenario: Mapping[str, Any], n: int, *, batch: int = 1, function: Function = two_objectives) -> Optimizer:
    """Return an optimizer that has been told n evaluations, in batches."""
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        suggestions = optimizer.ask(min(batch, n - len(optimizer.history)))
        if not suggestions:
            break
        optimizer.tell([evaluate(s, function) for s in suggestions])
    return optimizer


def resumed(scenario: Mapping[str, Any], evaluations: list[Evaluation]) -> Optimizer:
    """Return a fresh optimizer that goes on from stored evaluations."""
    loaded = load_scenario(scenario)
    history = build_history(loaded)
    history.extend(evaluations)
    return build_optimizer(loaded, history)


def configurations(optimizer: Optimizer) -> list[Configuration]:
    """Return all configurations of the history."""
    return [e.configuration for e in optimizer.history]
