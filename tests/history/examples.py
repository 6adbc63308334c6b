"""Spaces, objectives and rows for the tests of this package."""

from __future__ import annotations

import math
from pathlib import Path

from hypermap_lite.evaluation.outcome import Evaluation, Outcome, Replicate, State, Suggestion
from hypermap_lite.history.run_folder import RunFolder
from hypermap_lite.objectives import Goal, Objective
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace

SPACE = SearchSpace(
    (
        RealParameter(name="force", low=-20.0, high=1e6),
        IntegerParameter(name="turns", low=-3, high=2000),
        OrdinalParameter(name="gain", values=(0.5, 2, 1e-7)),
        CategoricalParameter(name="tool", values=("peg", 'a "b", c', "", " x\n", "1.0", "naïve – ü")),
    )
)
OBJECTIVES = (Objective(name="reward", goal=Goal.MAXIMIZE), Objective(name="cost"))
CANONICAL = {"application_name": "test", "seed": 1, "budget": {"evaluations": 9, "minutes": None}}


def configuration(**changes: object) -> dict[str, object]:
    return {"force": 0.1, "turns": 3, "gain": 2, "tool": "peg", **changes}


def evaluation(trial: int, reward: float | None = 1.5, cost: float = 2.0, **changes: object) -> Evaluation:
    suggestion = Suggestion(trial=trial, configuration=configuration(force=trial / 7), phase="design")
    if reward is None:
        return Evaluation(suggestion=suggestion, state=State.FAILED, error="it broke", timestamp=trial)
    return Evaluation(
        suggestion=suggestion,
        state=State.COMPLETED,
        values={"reward": reward, "cost": cost},
        standard_errors={"reward": math.nan, "cost": 0.1},
        timestamp=trial,
        **changes,
    )


def replicate(trial: int, number: int = 0, **metrics: float) -> Replicate:
    return Replicate(
        trial=trial,
        replicate=number,
        seed=7,
        configuration=configuration(),
        outcome=Outcome(state=State.COMPLETED, values={"reward": 1 / 3, "cost": 2.0}, metrics=metrics),
        seconds=0.25,
    )


def folder(path: Path, **changes: object) -> RunFolder:
    return RunFolder(path, space=SPACE, objectives=OBJECTIVES, canonical={**CANONICAL, **changes})
