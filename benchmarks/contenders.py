"""Who is compared: this package with its variants, plain sampling, and other packages in processes of their own.

A contender suggests one configuration at a time and is told what it is worth. All of them begin with the same design,
evaluated before; from then on the model-based part counts.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from problems import Problem

from hypermap_lite import Evaluation, Optimizer, State
from hypermap_lite.evaluation.outcome import EARLIER, Suggestion

VALID = "Valid"
WORKERS = Path(__file__).parent / "peers"
TIMEOUT = 7200.0
"""Of a run in a process of its own [s]."""

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class Answered(NamedTuple):
    """An evaluation as a contender sees it."""

    configuration: Mapping[str, Any]
    values: list[float]
    is_feasible: bool


class Suggested(NamedTuple):
    """A configuration, and the seconds its choice took, what was told before it included."""

    configuration: Mapping[str, Any]
    cpu: float
    wall: float


@dataclass(frozen=True, kw_only=True)
class Task:
    """What a contender has to do."""

    problem: Problem
    seed: int
    design: Sequence[Answered] = ()
    """What was evaluated before; it counts towards the problem's evaluations."""

    spare: Sequence[Mapping[str, Any]] = field(default_factory=list)
    """The points of the Sobol sequence that come after the design."""


class Contender(Protocol):
    """Chooses configurations."""

    def suggest(self) -> Suggested:
        """Return the next configuration to evaluate."""

    def tell(self, values: list[float], is_feasible: bool) -> None:
        """Take in the answer to the last suggestion."""

    def close(self) -> None:
        """End what was started."""


class ContenderError(Exception):
    """A contender that ended without an answer; says its last words."""


def objectives_of(problem: Problem) -> list[dict[str, Any]]:
    """Return the objectives of a scenario."""
    if problem.reference_point is None:
        return [{"name": name} for name in problem.objectives]
    pairs = zip(problem.objectives, problem.reference_point, strict=True)
    return [{"name": name, "reference_point": r} for name, r in pairs]


class Ours:
    """The package of this repository, in this process; the design is an earlier experiment to it."""

    def __init__(self, task: Task, changes: Mapping[str, Any] | None = None, overrides: Sequence[str] = ()) -> None:
        self._problem = task.problem
        scenario = {
            "seed": task.seed,
            "input_parameters": task.problem.parameters,
            "objectives": objectives_of(task.problem),
            "feasible_output": None if task.problem.is_feasible is None else {"name": VALID},
            "budget": {"evaluations": task.problem.evaluations},
            "design_of_experiment": {"number_of_samples": task.problem.design},
            **(changes or {}),
        }
        earlier = [self._evaluation(trial, row) for trial, row in enumerate(task.design)]
        self.optimizer = Optimizer(scenario, evaluations=earlier, overrides=overrides)
        self._asked: Suggestion | None = None
        self._spent = 0.0, 0.0

    def _evaluation(self, trial: int, row: Answered) -> Evaluation:
        return Evaluation(
            suggestion=Suggestion(trial=trial, configuration=dict(row.configuration), phase=EARLIER),
            state=State.COMPLETED if row.is_feasible else State.INFEASIBLE,
            values=dict(zip(self._problem.objectives, row.values, strict=True)),
        )

    def suggest(self) -> Suggested:
        """Ask."""
        cpu, wall = time.process_time(), time.perf_counter()
        (self._asked,) = self.optimizer.ask()
        cpu, wall = time.process_time() - cpu + self._spent[0], time.perf_counter() - wall + self._spent[1]
        return Suggested(self._asked.configuration, cpu, wall)

    def tell(self, values: list[float], is_feasible: bool) -> None:
        """Tell, and keep how long that took for the next suggestion."""
        assert self._asked is not None
        result: dict[str, Any] = dict(zip(self._problem.objectives, values, strict=True))
        if self._problem.is_feasible is not None:
            result[VALID] = is_feasible
        cpu, wall = time.process_time(), time.perf_counter()
        self.optimizer.tell(self._asked, result)
        self._spent = time.process_time() - cpu, time.perf_counter() - wall

    def close(self) -> None:
        """Do nothing."""


class Spread:
    """The rest of the Sobol sequence that the design is the beginning of."""

    def __init__(self, task: Task) -> None:
        self._rest = iter(task.spare)

    def suggest(self) -> Suggested:
        """Return the next point."""
        return Suggested(next(self._rest), 0.0, 0.0)

    def tell(self, values: list[float], is_feasible: bool) -> None:
        """Learn nothing."""

    def close(self) -> None:
        """Do nothing."""


class Peer:
    """Another package, run by a worker of the folder `peers` with a Python that has it."""

    def __init__(self, task: Task, *, python: Path, worker: str, algorithm: str = "") -> None:
        self._errors = tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace")  # noqa: SIM115, lives on
        self._process = subprocess.Popen(
            [str(python), str(WORKERS / f"{worker}_worker.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
            env={**os.environ, **ONE_THREAD},
        )
        self._timer = threading.Timer(TIMEOUT, self._process.kill)
        self._timer.daemon = True
        self._timer.start()
        self._unsent: Mapping[str, Any] | None = self._description(task, algorithm)

    @staticmethod
    def _description(task: Task, algorithm: str) -> dict[str, Any]:
        """Return the task as the worker reads it."""
        problem = task.problem
        return {
            "algorithm": algorithm,
            "seed": task.seed,
            "evaluations": problem.evaluations,
            "parameters": problem.parameters,
            "objectives": problem.objectives,
            "reference_point": problem.reference_point,
            "is_constrained": problem.is_feasible is not None,
            "design": [row._asdict() for row in task.design],
        }

    def _send(self, line: Mapping[str, Any]) -> None:
        assert self._process.stdin is not None
        try:
            print(json.dumps(line), file=self._process.stdin, flush=True)
        except BrokenPipeError:
            raise ContenderError(self._last_words()) from None

    def _last_words(self) -> str:
        self._process.wait()
        self._errors.seek(0)
        lines = [line for line in self._errors.read().splitlines() if line.strip()]
        return lines[-1] if lines else f"exit status {self._process.returncode}"

    def suggest(self) -> Suggested:
        """Wait for the next configuration."""
        assert self._process.stdout is not None
        if self._unsent is not None:
            self._send(self._unsent)
            self._unsent = None
        line = self._process.stdout.readline()
        if not line:
            raise ContenderError(self._last_words())
        return Suggested(**json.loads(line))

    def tell(self, values: list[float], is_feasible: bool) -> None:
        """Send the answer."""
        self._send({"values": values, "is_feasible": is_feasible})

    def close(self) -> None:
        """End the process, which may wait for an answer that does not come."""
        self._timer.cancel()
        self._process.kill()
        self._process.communicate()
        self._errors.close()
