"""Measure how well the optimizer does on HyperMapper's problems with several objectives, and how long it takes.

    python benchmarks/hypermapper_problems.py [--seeds 10] [--problems NAME,...] [--output benchmarks/results]

The problems are the files of `example_scenarios/hypermapper/`, with their budgets, and a look-up table of 76,800 rows,
which is made in a temporary folder. A case is a problem, a method and a seed; a case that has its row is not run again.
"""

from __future__ import annotations

import argparse
import csv
import importlib
import json
import runpy
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from reporting import ResultTable, machine

from hypermap_lite import Optimizer, hypervolume, non_dominated

EXAMPLES = Path(__file__).parent.parent / "example_scenarios" / "hypermapper"
VALID = "Valid"
MODEL = "model"

DEFAULT = "default"
METHODS = (DEFAULT, "gaussian_process", "random_forest")
"""Our default, and HyperMapper's file as it is, with either model."""

COLUMNS = (
    *("problem", "method", "seed", "evaluations", "hypervolume", "share", "optimal_points", "complete_at"),
    *("feasible_share", "suggest_seconds", "suggest_seconds_slowest", "suggest_cpu_seconds"),
)


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A problem with a known front."""

    scenario: dict[str, Any]
    """In HyperMapper's format."""

    function: Callable[[dict[str, Any]], Mapping[str, Any]]
    reference_point: tuple[float, float]
    hypervolume: float
    """Of the whole front."""

    front: frozenset[tuple[float, ...]] | None = None
    """All optimal objective values, where they are finitely many."""

    goal: str


def of_example(name: str, reference_point: tuple[float, float], best: float, goal: str) -> Problem:
    """Return the problem of an example."""
    sys.path.insert(0, str(EXAMPLES))
    return Problem(
        scenario=json.loads((EXAMPLES / f"{name}.json").read_text(encoding="utf-8")),
        function=runpy.run_path(str(EXAMPLES / f"{name}.py"))["evaluate"],
        reference_point=reference_point,
        hypervolume=best,
        goal=goal,
    )


def front_of(Y: npt.NDArray[np.float64]) -> frozenset[tuple[float, ...]]:
    return frozenset(map(tuple, Y[non_dominated(Y)].tolist()))


def multiobjective_branin() -> Problem:
    return of_example("multiobjective_branin", (308.2, 25.0), 8444.4, "median share >= 0.985")


def ordinal_multiobjective_branin() -> Problem:
    problem = of_example("ordinal_multiobjective_branin", (308.2, 25.0), 8280.29, "complete in 9 of 10")
    points = [(x1, x2) for x1 in range(-5, 11) for x2 in range(16)]
    Y = np.array([list(problem.function({"x1": x1, "x2": x2}).values()) for x1, x2 in points])
    return replace(problem, front=front_of(Y))


def chakong_haimes() -> Problem:
    return of_example("chakong_haimes", (260.0, 20.0), 37_865.0, "median share >= 0.97, feasible >= 0.8")


def lookup_large() -> Problem:
    sys.path.insert(0, str(EXAMPLES))
    lookup_table = importlib.import_module("lookup_table")
    with tempfile.TemporaryDirectory() as folder:
        file = lookup_table.write(Path(folder), "lookup_large")
        scenario = json.loads(file.read_text(encoding="utf-8"))
        with file.with_suffix(".csv").open(newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
    names, objectives = list(scenario["input_parameters"]), scenario["optimization_objectives"]
    table = {
        tuple(row[name] for name in names): {
            **{objective: float(row[objective]) for objective in objectives},
            VALID: row[VALID] == "True",
        }
        for row in rows
    }
    Y = np.array([[result[objective] for objective in objectives] for result in table.values() if result[VALID]])
    reference_point = (float(Y[:, 0].max()), float(Y[:, 1].max()))
    return Problem(
        scenario=scenario,
        function=lambda configuration: table[tuple(str(configuration[name]) for name in names)],
        reference_point=reference_point,
        hypervolume=float(hypervolume(Y, np.array(reference_point))),
        front=front_of(Y),
        goal="at most 0.5 s per suggestion",
    )


PROBLEMS: Mapping[str, Callable[[], Problem]] = {
    function.__name__: cache(function)
    for function in (ordinal_multiobjective_branin, multiobjective_branin, chakong_haimes, lookup_large)
}


def scenario_of(problem: Problem, method: str, seed: int) -> dict[str, Any]:
    """Return the scenario of one case: HyperMapper's own, or ours with its parameters and budget."""
    theirs = problem.scenario
    if method != DEFAULT:
        return {**theirs, "models": {"model": method}, "seed": seed}
    n_design = theirs["design_of_experiment"]["number_of_samples"]
    return {
        "seed": seed,
        "input_parameters": theirs["input_parameters"],
        "objectives": [{"name": name} for name in theirs["optimization_objectives"]],
        "feasible_output": {"name": VALID} if "feasible_output" in theirs else None,
        "budget": {"evaluations": n_design + theirs["optimization_iterations"]},
        "design_of_experiment": {"number_of_samples": n_design},
    }


def measure(name: str, method: str, seed: int) -> dict[str, Any]:
    """Run one case and return its row."""
    problem = PROBLEMS[name]()
    scenario = scenario_of(problem, method, seed)
    objectives = problem.scenario["optimization_objectives"]
    n_evaluations = problem.scenario["design_of_experiment"]["number_of_samples"]
    n_evaluations += problem.scenario["optimization_iterations"]
    optimizer = Optimizer(scenario)
    Y, is_valid, phases, wall, cpu = [], [], [], [], []
    for _ in range(n_evaluations):
        starts = time.perf_counter(), time.process_time()
        (suggestion,) = optimizer.ask()
        wall.append(time.perf_counter() - starts[0])
        cpu.append(time.process_time() - starts[1])
        result = dict(problem.function(suggestion.configuration))
        is_valid.append(result.pop(VALID, True))
        phases.append(suggestion.phase)
        Y.append([result[objective] for objective in objectives])
        answer = {**result, VALID: is_valid[-1]} if "feasible_output" in problem.scenario else result
        optimizer.tell(suggestion, answer)
    by_model = np.array(phases) == MODEL
    return {
        "problem": name,
        "method": method,
        "seed": seed,
        "evaluations": len(Y),
        **quality(problem, np.array(Y), np.array(is_valid)),
        "feasible_share": float(np.array(is_valid)[by_model].mean()),
        "suggest_seconds": statistics.median(np.array(wall)[by_model]),
        "suggest_seconds_slowest": float(np.array(wall)[by_model].max()),
        "suggest_cpu_seconds": statistics.median(np.array(cpu)[by_model]),
    }


def quality(problem: Problem, Y: npt.NDArray[np.float64], is_valid: npt.NDArray[np.bool_]) -> dict[str, Any]:
    """Return what a run's evaluations are worth."""
    reached = float(hypervolume(Y[is_valid], np.array(problem.reference_point))) if is_valid.any() else 0.0
    found: dict[str, Any] = {"optimal_points": "", "complete_at": ""}
    if problem.front is not None:
        missing = set(problem.front)
        for i, (y, valid) in enumerate(zip(Y.tolist(), is_valid, strict=True)):
            if valid and tuple(y) in missing:
                missing.remove(tuple(y))
                found["complete_at"] = "" if missing else i + 1
        found["optimal_points"] = len(problem.front) - len(missing)
    return {"hypervolume": reached, "share": reached / problem.hypervolume, **found}


def summary(rows: list[dict[str, Any]]) -> Iterator[tuple[str, ...]]:
    """Yield a row per problem and method: medians over the seeds."""

    def median(column: str, form: str) -> str:
        values = [float(row[column]) for row in case if row[column] != ""]
        return format(statistics.median(values), form) if values else ""

    for problem, method in dict.fromkeys((row["problem"], row["method"]) for row in rows):
        case = [row for row in rows if (row["problem"], row["method"]) == (problem, method)]
        n_complete = sum(row["complete_at"] != "" for row in case)
        yield (
            *(problem, PROBLEMS[problem]().goal, method, str(len(case))),
            *(median("share", ".4f"), f"{min(float(row['share']) for row in case):.4f}", median("optimal_points", "g")),
            f"{n_complete} of {len(case)}" if median("optimal_points", "g") else "",
            *(median("feasible_share", ".2f"), median("suggest_seconds", ".3f"), median("suggest_cpu_seconds", ".3f")),
        )


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--problems", default=",".join(PROBLEMS))
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    table = ResultTable(arguments.output / "hypermapper_problems.csv", COLUMNS, key=("problem", "method", "seed"))
    for seed in range(arguments.seeds):
        for problem in arguments.problems.split(","):
            for method in arguments.methods.split(","):
                table.fill({"problem": problem, "method": method, "seed": seed}, measure)
    table.write_page(
        arguments.output / "hypermapper_problems.md",
        title="HyperMapper's problems with two objectives",
        command="python benchmarks/hypermapper_problems.py",
        text=f"{machine()}\nShare of the hypervolume of the whole front, over the seeds; optimal points where the "
        "space is finite; feasible share of the\nsuggestions by the model; seconds of one suggestion by the model, fit "
        "included. `default` is our default method;\n`gaussian_process` and `random_forest` are HyperMapper's files as "
        "they are, with either model.",
        header=(
            *("problem", "goal", "method", "seeds", "median share", "worst share", "optimal points", "complete"),
            *("feasible", "s per suggestion", "CPU s"),
        ),
        rows=list(summary(table.rows)),
    )


if __name__ == "__main__":
    main()
