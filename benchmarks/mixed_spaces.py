"""Measure suggestions in spaces of many categories and levels: their time, and what a run finds.

    python benchmarks/mixed_spaces.py [--seeds 8] [--output benchmarks/results]

Time: CPU seconds of `ask` after 60 evaluations of two objectives, fit included. Quality: the best of 60 evaluations of
random additive functions with interactions, against as many random ones.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from reporting import ResultTable, machine

from hypermap_lite import Evaluation, Optimizer, State
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.typing import FloatArray

EVALUATIONS = 60
DESIGN = 12
LEVELS = 10
"""Cells of each axis that have a worth of their own."""

REAL = {"parameter_type": "real", "values": [0, 1]}


def categorical(n: int) -> dict[str, Any]:
    """Return a parameter of n categories."""
    return {"parameter_type": "categorical", "values": [f"v{i}" for i in range(n)]}


def named(letter: str, n: int, parameter: Mapping[str, Any]) -> dict[str, Any]:
    """Return n parameters of a kind."""
    return {f"{letter}{i}": dict(parameter) for i in range(n)}


SPACES: Mapping[str, dict[str, Any]] = {
    "20 categorical of 10": named("c", 20, categorical(10)),
    "20 categorical of 3": named("c", 20, categorical(3)),
    "10 categorical of 10, 5 real": named("c", 10, categorical(10)) | named("x", 5, REAL),
    "8 ordinal of 100": named("o", 8, {"parameter_type": "ordinal", "values": list(range(100))}),
    "4 integer of 1e6, 3 real": named("n", 4, {"parameter_type": "integer", "values": [0, 999_999]})
    | named("x", 3, REAL),
    "6 real": named("x", 6, REAL),
}
COLUMNS = ("space", "seed", "seconds", "best", "random")


def function_of(parameters: Mapping[str, Any], seed: int) -> Callable[[FloatArray], float]:
    """Return a random function to be minimized: a worth per category, bowls over numbers, and interactions."""
    rng, d = np.random.default_rng([seed, 5]), len(parameters)
    worth, centre, tied = rng.standard_normal((d, LEVELS)), rng.random(d), rng.standard_normal((d, 2, 2))
    is_categorical = np.array([p["parameter_type"] == "categorical" for p in parameters.values()])

    def function(x: FloatArray) -> float:
        cell = np.minimum((x * LEVELS).astype(int), LEVELS - 1)
        half = (x >= 0.5).astype(int)
        value = worth[np.arange(d), cell][is_categorical].sum() + 6 * ((x - centre)[~is_categorical] ** 2).sum()
        return float(value + 0.5 * tied[np.arange(d), half, np.roll(half, 1)].sum())

    return function


def scenario_of(space: str, seed: int, n_objectives: int) -> dict[str, Any]:
    """Return the scenario of one case."""
    return {
        "seed": seed,
        "input_parameters": SPACES[space],
        "objectives": [{"name": f"f{k}"} for k in range(n_objectives)],
        "design_of_experiment": {"number_of_samples": DESIGN},
        "budget": {"evaluations": EVALUATIONS + 1},
    }


def seconds_of(space: str, seed: int) -> float:
    """Time a suggestion after random evaluations of two objectives; what earlier fits leave is there."""
    scenario = scenario_of(space, seed, 2)
    search_space = Optimizer(scenario).history.space
    X = search_space.sample_uniform(EVALUATIONS, np.random.default_rng(seed))
    functions = [function_of(SPACES[space], seed + 100 * k) for k in range(2)]
    rows = [
        Evaluation(
            suggestion=Suggestion(trial=i, configuration=c, phase="design" if i < DESIGN else "model"),
            state=State.COMPLETED,
            values={f"f{k}": f(x) for k, f in enumerate(functions)},
        )
        for i, (x, c) in enumerate(zip(X, search_space.decode(X), strict=True))
    ]
    optimizer = Optimizer(scenario, evaluations=rows[:-1])
    (suggestion,) = optimizer.ask()
    optimizer.tell(suggestion, rows[-1].values)
    start = time.process_time()
    optimizer.ask()
    return time.process_time() - start


def best_of(space: str, seed: int) -> tuple[float, float]:
    """Return the best value of a run of one objective, and that of as many random points."""
    optimizer, function = Optimizer(scenario_of(space, seed, 1)), function_of(SPACES[space], seed)
    search_space, best = optimizer.history.space, math.inf
    for _ in range(EVALUATIONS):
        (suggestion,) = optimizer.ask()
        value = function(search_space.encode([suggestion.configuration])[0])
        optimizer.tell(suggestion, value)
        best = min(best, value)
    return best, min(map(function, search_space.sample_uniform(EVALUATIONS, np.random.default_rng([seed, 9]))))


def measure(space: str, seed: int) -> dict[str, Any]:
    """Measure one case and return its row."""
    best, at_random = best_of(space, seed)
    return {"space": space, "seed": seed, "seconds": seconds_of(space, seed), "best": best, "random": at_random}


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    table = ResultTable(arguments.output / "mixed_spaces.csv", COLUMNS, key=("space", "seed"))
    for seed in range(arguments.seeds):
        for space in SPACES:
            table.fill({"space": space, "seed": seed}, measure)
    rows = []
    for space in SPACES:
        case = [row for row in table.rows if row["space"] == space]
        seconds = [float(row["seconds"]) for row in case]
        means = (f"{statistics.fmean(float(row[name]) for row in case):.2f}" for name in ("random", "best"))
        rows.append((space, str(len(case)), f"{statistics.median(seconds):.3f}", f"{max(seconds):.3f}", *means))
    table.write_page(
        arguments.output / "mixed_spaces.md",
        title="Spaces of many categories and levels",
        command="python benchmarks/mixed_spaces.py",
        text=f"{machine()}\nCPU seconds of a suggestion at {EVALUATIONS} evaluations of two objectives, fit included; "
        f"mean best value of {EVALUATIONS} evaluations\nof a random function, to be minimized, by random points and by "
        "the default method.",
        header=("space", "seeds", "median s", "largest s", "best of random", "best of default"),
        rows=rows,
    )


if __name__ == "__main__":
    main()
