"""Measure how few evaluations the optimizer needs on functions with known optima.

    python benchmarks/synthetic.py [--seeds 10] [--functions branin,hartmann6] [--output benchmarks/results]

Every case is a function, a noise level (standard deviation of the observations as a share of the function's range)
and a method; the regret is that of the best noise-free value among the evaluated points. Rows are written as they are
measured, and a case that has its row is not run again, so an interrupted benchmark goes on.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from problems.formulas import ackley, branin, hartmann6, levy, rosenbrock
from reporting import ResultTable, machine

from hypermap_lite import Optimizer


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A function to minimize, and how long it may take."""

    function: Callable[[npt.NDArray[np.float64]], float]
    bounds: tuple[tuple[float, float], ...]
    optimum: float
    value_range: float
    """Spread of the values over the box, in which noise is measured."""

    evaluations: int
    design: int


PROBLEMS: Mapping[str, Problem] = {
    "branin": Problem(
        function=branin,
        bounds=((-5, 10), (0, 15)),
        optimum=0.39788735772973816,
        value_range=307.7,
        evaluations=40,
        design=6,
    ),
    "hartmann6": Problem(
        function=hartmann6,
        bounds=((0, 1),) * 6,
        optimum=-3.32236801141551,
        value_range=3.32,
        evaluations=60,
        design=14,
    ),
    "ackley5": Problem(
        function=ackley, bounds=((-15, 20),) * 5, optimum=0.0, value_range=22.3, evaluations=60, design=12
    ),
    "levy4": Problem(function=levy, bounds=((-10, 10),) * 4, optimum=0.0, value_range=360.0, evaluations=60, design=10),
    "rosenbrock4": Problem(
        function=rosenbrock, bounds=((-5, 10),) * 4, optimum=0.0, value_range=2.7e6, evaluations=60, design=10
    ),
}

METHODS: Mapping[str, dict[str, Any]] = {
    "default": {},
    "paper preset": {"preset": "paper"},
    "Sobol": {"design_of_experiment": {"type": "sobol"}},
}
"""Changes to the default scenario; Sobol spends the whole budget on the design."""

NOISE_LEVELS = (0.0, 0.1)
COLUMNS = ("function", "noise", "method", "seed", "evaluations", "regret", "best_value", "suggest_cpu_seconds")


def scenario_of(problem: Problem, method: str, seed: int) -> dict[str, Any]:
    """Return the scenario of one case."""
    changes = METHODS[method]
    n_design = problem.evaluations if method == "Sobol" else problem.design
    return {
        "seed": seed,
        "input_parameters": {
            f"x{i}": {"parameter_type": "real", "values": list(bounds)} for i, bounds in enumerate(problem.bounds)
        },
        "objectives": [{"name": "y"}],
        "budget": {"evaluations": problem.evaluations},
        **changes,
        "design_of_experiment": {**changes.get("design_of_experiment", {}), "number_of_samples": n_design},
    }


def measure(name: str, noise: float, method: str, seed: int) -> dict[str, Any]:
    """Run one case and return its row."""
    problem = PROBLEMS[name]
    optimizer = Optimizer(scenario_of(problem, method, seed))
    rng = np.random.default_rng([seed, 1])
    best, cpu = math.inf, 0.0
    for _ in range(problem.evaluations):
        start = time.process_time()
        (suggestion,) = optimizer.ask()
        cpu += time.process_time() - start
        value = float(problem.function(np.array(list(suggestion.configuration.values()), dtype=float)))
        best = min(best, value)
        optimizer.tell(suggestion, value + noise * problem.value_range * float(rng.standard_normal()))
    return {
        "function": name,
        "noise": noise,
        "method": method,
        "seed": seed,
        "evaluations": problem.evaluations,
        "regret": best - problem.optimum,
        "best_value": best,
        "suggest_cpu_seconds": cpu / problem.evaluations,
    }


def summary(rows: list[dict[str, Any]]) -> Iterator[tuple[str, ...]]:
    """Yield a row per case: medians and mean log regret over the seeds."""
    cases = dict.fromkeys((r["function"], float(r["noise"]), r["method"]) for r in rows)
    for function, noise, method in cases:
        case = [r for r in rows if (r["function"], float(r["noise"]), r["method"]) == (function, noise, method)]
        regrets = [max(float(r["regret"]), 1e-12) for r in case]
        yield (
            function,
            f"{noise:.0%}",
            method,
            str(len(case)),
            f"{statistics.median(regrets):.2e}",
            f"{statistics.fmean(math.log10(r) for r in regrets):.2f}",
            f"{max(regrets):.2e}",
            f"{statistics.median(float(r['best_value']) for r in case):.4f}",
            f"{statistics.median(float(r['suggest_cpu_seconds']) for r in case):.3f}",
        )


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--functions", default=",".join(PROBLEMS))
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    table = ResultTable(arguments.output / "synthetic.csv", COLUMNS, key=("function", "noise", "method", "seed"))
    for name in arguments.functions.split(","):
        for noise in NOISE_LEVELS:
            for method in arguments.methods.split(","):
                for seed in range(arguments.seeds):
                    table.fill({"function": name, "noise": noise, "method": method, "seed": seed}, measure)
    table.write_page(
        arguments.output / "synthetic.md",
        title="Sample efficiency on functions with known optima",
        command="python benchmarks/synthetic.py",
        text=f"{machine()}\nRegret of the best noise-free value among the evaluated points. Branin 40 evaluations "
        "(6 of them the design),\nHartmann-6 60 (14), Ackley-5 60 (12), Levy-4 and Rosenbrock-4 60 (10); "
        "noise as a share of the function's range.",
        header=(
            *("function", "noise", "method", "seeds", "median regret", "mean log10 regret", "worst regret"),
            *("median best value", "CPU s per suggestion"),
        ),
        rows=list(summary(table.rows)),
    )


if __name__ == "__main__":
    main()
