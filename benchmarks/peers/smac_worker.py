"""SMAC3: its facade with a random forest or with a Gaussian process, and ParEGO if there are several objectives.

The model is fitted after every evaluation, where SMAC3 by default makes eight suggestions of one fit, and each
configuration is evaluated once, for no other package repeats evaluations. A configuration that is not allowed is a
crash whose cost is the reference point.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from typing import Any

from ConfigSpace import Categorical, Configuration, ConfigurationSpace, Float, Integer
from loop import Evaluate, serve
from smac import BlackBoxFacade, HyperparameterOptimizationFacade, Scenario
from smac.multi_objective.parego import ParEGO
from smac.runhistory import StatusType, TrialValue

KINDS = {
    "categorical": Categorical,
    "ordinal": lambda name, values: Categorical(name, values, ordered=True),
    "integer": lambda name, values: Integer(name, tuple(values)),
    "real": lambda name, values: Float(name, tuple(values)),
}
FACADES = {"forest": HyperparameterOptimizationFacade, "GP": BlackBoxFacade}


def run(task: Mapping[str, Any], evaluate: Evaluate) -> None:
    """Ask, evaluate and tell until the evaluations are used up; the answers to the design are known."""
    space = space_of(task)
    known = {
        Configuration(space, values=row["configuration"]): (row["values"], row["is_feasible"]) for row in task["design"]
    }
    with tempfile.TemporaryDirectory() as folder:
        smac = facade(task, space, list(known), folder)
        for _ in range(task["evaluations"]):
            trial = smac.ask()
            answer = known.pop(trial.config, None) or evaluate(dict(trial.config))
            smac.tell(trial, told(task, *answer), save=False)


def facade(task: Mapping[str, Any], space: ConfigurationSpace, design: list[Configuration], folder: str) -> Any:
    """Return the optimizer, with the design of the task as its own."""
    kind = FACADES[task["algorithm"]]
    scenario = Scenario(
        space,
        objectives=task["objectives"],
        n_trials=task["evaluations"],
        deterministic=True,
        seed=task["seed"],
        output_directory=folder,
    )
    return kind(
        scenario,
        lambda config, seed=0: 0.0,
        initial_design=kind.get_initial_design(scenario, n_configs=0, additional_configs=design),
        config_selector=kind.get_config_selector(scenario, retrain_after=1),
        multi_objective_algorithm=ParEGO(scenario) if len(task["objectives"]) > 1 else None,
        logging_level=False,
        overwrite=True,
    )


def space_of(task: Mapping[str, Any]) -> ConfigurationSpace:
    """Return the search space of the task."""
    space = ConfigurationSpace(seed=task["seed"])
    for name, parameter in task["parameters"].items():
        space.add(KINDS[parameter["parameter_type"]](name, parameter["values"]))
    return space


def told(task: Mapping[str, Any], values: list[float], is_feasible: bool) -> TrialValue:
    """Return what SMAC3 is told of an evaluation."""
    if not is_feasible:
        return TrialValue(cost=task["reference_point"], status=StatusType.CRASHED)
    return TrialValue(cost=values if len(values) > 1 else values[0])


if __name__ == "__main__":
    serve(run)
