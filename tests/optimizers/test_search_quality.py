"""Every optimizer finds clearly better points than random search, with as many evaluations."""

from functools import cache

import numpy as np
import pytest

from tests.optimizers.problems import BRANIN, MIXED, ORDERED, branin, mixed
from tests.optimizers.runs import run
from tests.slow import slow_after

PROBLEMS = {"branin": (BRANIN, branin, 0.397887), "mixed": (MIXED, mixed, 0.0), "ordered": (ORDERED, mixed, 0.0)}


@cache
def median_gap(problem: str, kind: str) -> float:
    """Return how far the best of 60 evaluations is from the optimum, the median of five seeds."""
    scenario, function, optimum = PROBLEMS[problem]
    runs = [run({**scenario, "optimizer": kind, "seed": seed}, 60, function=function) for seed in range(5)]
    return float(np.median([min(e.values["y"] for e in r.history) - optimum for r in runs]))


@pytest.mark.parametrize(
    ("problem", "kind"),
    slow_after(
        3,
        [(p, k) for p in PROBLEMS for k in ("local_search", "evolutionary", "cma_es") if (p, k) != ("mixed", "cma_es")],
    ),
)
def test_half_the_distance_to_the_optimum_is_left(problem: str, kind: str) -> None:
    assert median_gap(problem, kind) < 0.5 * median_gap(problem, "random_search")
