"""Uniformly random configurations: what a search without any model is worth, and the smallest worker there can be."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any

from loop import Evaluate, serve


def run(task: Mapping[str, Any], evaluate: Evaluate) -> None:
    """Evaluate as many configurations as the task allows."""
    rng = random.Random(task["seed"])
    for _ in range(task["evaluations"] - len(task["design"])):
        evaluate({name: drawn(rng, parameter) for name, parameter in task["parameters"].items()})


def drawn(rng: random.Random, parameter: Mapping[str, Any]) -> Any:
    """Return a value of a parameter."""
    match parameter["parameter_type"]:
        case "real":
            return rng.uniform(*parameter["values"])
        case "integer":
            return rng.randint(*parameter["values"])
    return rng.choice(parameter["values"])


if __name__ == "__main__":
    serve(run)
