"""HyperMapper with a random forest or a Gaussian process, going on from the design as from an earlier run.

HyperMapper has no seed: the generators that it draws from are seeded instead.
"""

from __future__ import annotations

import csv
import json
import os
import random
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from hypermapper import optimizer
from loop import Evaluate, serve

MODELS = {"forest": "random_forest", "GP": "gaussian_process"}
VALID = "Valid"
KINDS = {"real": float, "ordinal": float, "integer": int, "categorical": str}
"""What the values of a parameter are."""


def run(task: Mapping[str, Any], evaluate: Evaluate) -> None:
    """Write the scenario and the design, and run HyperMapper on them."""
    random.seed(task["seed"])
    np.random.seed(task["seed"])  # noqa: NPY002
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("scenario.json").write_text(json.dumps(scenario_of(task)), encoding="utf-8")
        write_design(task, Path("design.csv"))
        optimizer.optimize("scenario.json", lambda configuration: answered(task, evaluate, configuration))


def scenario_of(task: Mapping[str, Any]) -> dict[str, Any]:
    """Return the task in HyperMapper's format."""
    names = ("parameter_type", "values")
    scenario: dict[str, Any] = {
        "application_name": "benchmark",
        "optimization_objectives": task["objectives"],
        "optimization_iterations": task["evaluations"] - len(task["design"]),
        "number_of_cpus": 1,
        "models": {"model": MODELS[task["algorithm"]]},
        "input_parameters": {key: {name: p[name] for name in names} for key, p in task["parameters"].items()},
        "design_of_experiment": {"doe_type": "random sampling", "number_of_samples": len(task["design"])},
        "resume_optimization": True,
        "resume_optimization_data": "design.csv",
    }
    if task["is_constrained"]:
        scenario["feasible_output"] = {
            "enable_feasible_predictor": True,
            "name": VALID,
            "true_value": "True",
            "false_value": "False",
        }
    return scenario


def write_design(task: Mapping[str, Any], file: Path) -> None:
    """Write the design as HyperMapper writes its own evaluations."""
    flag = [VALID] if task["is_constrained"] else []
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow([*task["parameters"], *task["objectives"], *flag, "Timestamp"])
        for i, row in enumerate(task["design"]):
            valid = [row["is_feasible"]] if flag else []
            writer.writerow([*row["configuration"].values(), *row["values"], *valid, i])


def answered(task: Mapping[str, Any], evaluate: Evaluate, configuration: Mapping[str, Any]) -> Any:
    """Return what HyperMapper wants to know of a configuration."""
    plain = {name: KINDS[p["parameter_type"]](configuration[name]) for name, p in task["parameters"].items()}
    values, is_feasible = evaluate(plain)
    result = dict(zip(task["objectives"], values, strict=True))
    if task["is_constrained"]:
        result[VALID] = is_feasible
    return result if len(result) > 1 else values[0]


if __name__ == "__main__":
    serve(run)
