"""Requests, folders and a scripted optimizer for the tests of this package."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from hypermap_lite.evaluation.evaluator import EvaluationRequest
from hypermap_lite.evaluation.outcome import Outcome, Replicate, State, Suggestion
from hypermap_lite.evaluation.python_function import PythonFunction
from hypermap_lite.history.history import History
from hypermap_lite.history.run_folder import RunFolder
from hypermap_lite.objectives import Objective
from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.space import RealParameter, SearchSpace

SPACE = SearchSpace((RealParameter(name="x", low=-2.0, high=2.0),))
OBJECTIVES = (Objective(name="f"), Objective(name="g"))


def request(directory: Path, trial: int = 0, replicate: int = 0, **configuration: object) -> EvaluationRequest:
    return EvaluationRequest(
        trial=trial,
        replicate=replicate,
        seed=11,
        configuration=configuration or {"x": 0.5},
        directory=directory / f"{trial:04d}",
    )


def function(name: str) -> PythonFunction:
    return PythonFunction(function=f"tests.evaluation.black_boxes:{name}", objectives=("f", "g"))


def replicate(number: int = 0, state: State = State.COMPLETED, error: str = "", **values: float) -> Replicate:
    outcome = Outcome(state=state, values=values if state is State.COMPLETED else {}, error=error)
    return Replicate(trial=0, replicate=number, seed=1, configuration={"x": 0.5}, outcome=outcome, seconds=0.5)


def folder(path: Path, **canonical: object) -> RunFolder:
    return RunFolder(path, space=SPACE, objectives=OBJECTIVES, canonical=canonical)


class ScriptedOptimizer(Optimizer):
    """Suggests a point that depends on everything `ask` may depend on: trial, history and pending suggestions."""

    def __init__(self, history: History | None = None, *, n_available: int = 10**6) -> None:
        super().__init__(History(SPACE, OBJECTIVES) if history is None else history)
        self.n_available = n_available

    def _suggest(self, trial: int) -> Suggestion | None:
        if trial >= self.n_available:
            return None
        facts = [self.history.Y().tobytes(), len(self.history), [s.configuration["x"] for s in self.pending]]
        digest = hashlib.sha256(repr((trial, facts)).encode()).digest()
        rng = np.random.default_rng(list(digest))
        return Suggestion(trial=trial, configuration={"x": float(rng.uniform(-2, 2))}, phase="model")
