"""Run one scenario with HyperMapper or with this package, and write what it took and found as JSON.

    PYTHON hypermapper_one_run.py PACKAGE SCENARIO PROGRAM SEED RESULT

For `hypermapper_comparison.py`, which starts it with a Python that has the package (`hypermapper` or `hypermap_lite`)
installed. PROGRAM is a Python file with the function `evaluate`. HyperMapper has no seed: the generators it draws from
are seeded instead.
"""

from __future__ import annotations

import importlib
import json
import os
import random
import runpy
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

OURS_LATE = ("jsonschema", "sklearn.ensemble", "scipy.optimize", "scipy.stats")
"""What this package imports when it needs it, and HyperMapper at its start."""


class Timed:
    """A function that keeps what it was called with and returned, and how long it took in all."""

    def __init__(self, function: Callable[[dict[str, Any]], Any]) -> None:
        self.function = function
        self.results: list[Any] = []
        self.seconds = 0.0

    def __call__(self, configuration: dict[str, Any]) -> Any:
        """Call the function."""
        start = time.perf_counter()
        result = self.function(configuration)
        self.seconds += time.perf_counter() - start
        self.results.append(result)
        return result


def start(package: str, scenario: str, function: Callable[[dict[str, Any]], Any], seed: int) -> Callable[[], Any]:
    """Import a package and return what runs the scenario."""
    if package == "hypermapper":
        # the generators that HyperMapper draws from
        random.seed(seed)
        np.random.seed(seed)  # noqa: NPY002
        optimizer = importlib.import_module("hypermapper.optimizer")
        return lambda: optimizer.optimize(scenario, function)
    ours = importlib.import_module("hypermap_lite.run")
    for late in OURS_LATE:
        importlib.import_module(late)
    return lambda: ours.optimize(scenario, function, overrides=[f"seed={seed}"], output_directory="run")


def cpu_seconds() -> float:
    """Return the processor time of this process and of the children it has waited for."""
    return sum(os.times()[:4])


def main(package: str, scenario: str, program: str, seed: str, result: str) -> None:
    """Run the scenario on one core."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    sys.path[0] = str(Path(program).parent)  # instead of this folder
    function = Timed(runpy.run_path(program)["evaluate"])
    run = start(package, scenario, function, int(seed))
    wall, cpu = time.perf_counter(), cpu_seconds()
    run()
    facts = {
        "seconds": time.perf_counter() - wall - function.seconds,
        "cpu_seconds": cpu_seconds() - cpu - function.seconds,
        "results": function.results,
    }
    Path(result).write_text(json.dumps(facts, default=lambda value: value.item()), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
