"""Optuna: its tree-structured Parzen estimator or its Gaussian process.

The design is enqueued, so that the samplers find it in the study as they would find trials of their own. A
configuration that is not allowed violates a constraint by 1, an allowed one is within it by 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import optuna
from loop import Evaluate, serve

SAMPLERS = {
    "TPE": lambda seed, n: optuna.samplers.TPESampler(multivariate=True, n_startup_trials=n, seed=seed),
    "GP": lambda seed, n: optuna.samplers.GPSampler(n_startup_trials=n, seed=seed),
}


def run(task: Mapping[str, Any], evaluate: Evaluate) -> None:
    """Tell the design, then ask, evaluate and tell until the evaluations are used up."""
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    design = task["design"]
    sampler = SAMPLERS[task["algorithm"]](task["seed"], len(design))
    study = optuna.create_study(sampler=sampler, directions=["minimize"] * len(task["objectives"]))
    for i in range(task["evaluations"]):
        if i < len(design):
            study.enqueue_trial(as_suggested(task["parameters"], design[i]["configuration"]))
        trial = study.ask()
        configuration = {name: suggested(trial, name, p) for name, p in task["parameters"].items()}
        if i < len(design):
            values, is_feasible = design[i]["values"], design[i]["is_feasible"]
        else:
            values, is_feasible = evaluate(configuration)
        if task["is_constrained"]:
            trial.set_constraint("allowed", -1.0 if is_feasible else 1.0)
        study.tell(trial, values)


def suggested(trial: optuna.Trial, name: str, parameter: Mapping[str, Any]) -> Any:
    """Return the value of a parameter in a trial."""
    values = parameter["values"]
    match parameter["parameter_type"]:
        case "categorical":
            return trial.suggest_categorical(name, values)
        case "ordinal":
            return values[trial.suggest_int(name, 0, len(values) - 1)]
        case "integer":
            return trial.suggest_int(name, *values)
    return trial.suggest_float(name, *values)


def as_suggested(parameters: Mapping[str, Any], configuration: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration as the samplers know it: for values of an ordered list, which Optuna lacks, positions."""
    return {
        name: p["values"].index(configuration[name]) if p["parameter_type"] == "ordinal" else configuration[name]
        for name, p in parameters.items()
    }


if __name__ == "__main__":
    serve(run)
