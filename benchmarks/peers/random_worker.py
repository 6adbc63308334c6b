"""Uniformly random configurations: what a search without any model is worth, and the smallest worker there can be."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any

from loop import Evaluate, is_categorical, serve


def run(task: Mapping[str, Any], evaluate: Evaluate) -> None:
    """Evaluate as many configurations as the task allows."""
    rng = random.Random(task["seed"])
    for _ in range(task["evaluations"] - len(task["design"])):
        evaluate(
            {
                name: rng.choice(parameter["values"])
                if is_categorical(parameter)
                else rng.uniform(*parameter["values"])
                for name, parameter in task["parameters"].items()
            }
        )


if __name__ == "__main__":
    serve(run)
