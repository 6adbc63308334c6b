"""Configurations that are evaluated together keep their distance."""

from typing import Any

import numpy as np
import pytest

from hypermap_lite.maximizers import MaximizationProblem
from hypermap_lite.maximizers.base import best_unseen
from hypermap_lite.optimizers import Optimizer
from hypermap_lite.priors import ProductPrior
from hypermap_lite.space import CategoricalParameter, IntegerParameter, RealParameter, SearchSpace
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import run

NARROW = {"type": "gaussian", "mean": 0.3, "std": 0.002}
CASES: dict[str, dict[str, Any]] = {
    "process": {},
    "forest": {"surrogate": {"type": "random_forest", "number_of_trees": 10}},
    "narrow prior": {
        "input_parameters": {name: {"parameter_type": "real", "values": [0, 1], "prior": NARROW} for name in "ab"}
    },
    "constraint": {"constraints": ["a + b <= 0.7"]},
}


def plateau(c: Configuration) -> dict[str, float]:
    """Return an objective whose best values all lie around one point."""
    return {"y": max((float(c["a"]) - 0.3) ** 2 + (float(c["b"]) - 0.3) ** 2, 1e-4)}


def after_a_run(separation: float | None, changes: dict[str, Any]) -> Optimizer:
    scenario = {
        "input_parameters": {name: {"parameter_type": "real", "values": [0, 1]} for name in "ab"},
        "objectives": [{"name": "y"}],
        "design_of_experiment": {"number_of_samples": 6},
        "budget": {"evaluations": 60},
        "optimizer": {"type": "bayesian", "separation": separation},
        **changes,
    }
    return run(scenario, 12, function=plateau)


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_a_batch_keeps_its_distance(changes: dict[str, Any]) -> None:
    optimizer = after_a_run(0.05, changes)
    X = optimizer.history.space.encode([s.configuration for s in optimizer.ask(5)])
    distances = np.abs(X[:, None] - X[None]).max(axis=2)[np.triu_indices(5, 1)]
    assert distances.min() >= 0.05


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_a_batch_holds_no_configuration_twice(changes: dict[str, Any]) -> None:
    optimizer = after_a_run(None, changes)
    space = optimizer.history.space
    keys = space.keys(space.encode([s.configuration for s in optimizer.ask(5)]))
    assert len({*keys}) == 5


def test_points_in_other_categories_are_apart_and_the_last_near_one_is_better_than_none() -> None:
    space = SearchSpace(
        (
            RealParameter(name="r", low=0, high=1),
            IntegerParameter(name="n", low=0, high=10**6),
            CategoricalParameter(name="c", values=("x", "y")),
        )
    )
    pending, near, other, far = space.encode(
        [
            {"r": 0.5, "n": 1000, "c": "x"},
            {"r": 0.5, "n": 1001, "c": "x"},
            {"r": 0.5, "n": 1000, "c": "y"},
            {"r": 0.5, "n": 3000, "c": "x"},
        ]
    )
    problem = MaximizationProblem(
        scorer=lambda X: np.zeros(len(X)),  # type: ignore[arg-type]  # not asked for here
        space=space,
        prior=ProductPrior(3),
        incumbents=pending[None],
        seen=space.keys(pending[None]),
        rng=np.random.default_rng(0),
        pending=pending[None],
        separation=1e-3,
    )
    assert problem.is_apart(np.array([near, other, far])).tolist() == [False, True, True]
    best = best_unseen(problem, np.array([near, other]), np.array([2.0, 1.0]))
    assert best is not None
    assert np.array_equal(best.x, other)
    best = best_unseen(problem, near[None], np.array([2.0]))
    assert best is not None
    assert np.array_equal(best.x, near)
