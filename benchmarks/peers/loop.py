"""The side of another package's process: read a task, send configurations, receive what they are worth.

For the workers of this folder, which `contenders.py` starts with the Python of an environment that has the package. The
task and the answers are lines of JSON on standard input, the configurations on standard output; what a package prints
goes to standard error. Only the standard library is needed here.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

Answer = tuple[list[float], bool]
"""Objective values, noisy if the task is, and whether the configuration is allowed."""

Evaluate = Callable[[Mapping[str, Any]], Answer]


class Meter:
    """How long choosing a configuration takes, without the wait for its answer."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Begin to measure."""
        self._cpu, self._wall = cpu_seconds(), time.perf_counter()

    def read(self) -> dict[str, float]:
        """Return the seconds since the beginning."""
        return {"cpu": cpu_seconds() - self._cpu, "wall": time.perf_counter() - self._wall}


def cpu_seconds() -> float:
    """Return the processor time of this process and of the children it has waited for."""
    return time.process_time() + sum(os.times()[2:4])


def serve(run: Callable[[Mapping[str, Any], Evaluate], None]) -> None:
    """Read the task and run a package on it.

    Parameters
    ----------
    run
        Called with the task and with a function that evaluates a configuration. The task has the keys ``algorithm``,
        ``seed``, ``evaluations``, ``parameters``, ``objectives``, ``reference_point``, ``is_constrained``, and
        ``design``: what was evaluated before, which counts towards the evaluations.
    """
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    task = json.loads(sys.stdin.readline())
    meter = Meter()

    def evaluate(configuration: Mapping[str, Any]) -> Answer:
        line = {"configuration": dict(configuration), **meter.read()}
        print(json.dumps(line, default=lambda value: value.item()), file=answers, flush=True)
        answer = json.loads(sys.stdin.readline())
        meter.restart()
        return answer["values"], answer["is_feasible"]

    run(task, evaluate)
