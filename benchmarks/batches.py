"""Measure what it costs to choose several configurations at a time.

    python benchmarks/batches.py [--seeds 10] [--problems branin_currin,dtlz2,zdt2] [--output benchmarks/results]

Two objectives, 60 evaluations after a design of 2 (d + 1), chosen one or three at a time; and by three asynchronous
workers, each evaluation lasting a time drawn anew (exponential: the slowest of three takes 1.8 times the mean). The
result is the share of the largest hypervolume; beside it stand the smallest distance of two configurations of a batch
and the time that workers wait. Rows are written as they are measured, so an interrupted benchmark goes on.
"""

from __future__ import annotations

import argparse
import heapq
import statistics
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from reporting import ResultTable, machine

from hypermap_lite import Optimizer
from hypermap_lite.evaluation.outcome import Suggestion
from hypermap_lite.pareto import hypervolume

Point = npt.NDArray[np.float64]

EVALUATIONS = 60
WORKERS = 3


def branin_currin(x: Point) -> Point:
    """Return both functions of Belakaria et al. (NeurIPS 2019); x in [0, 1]^2."""
    a, b = 15 * x[0] - 5, 15 * x[1]
    branin = (b - 5.1 * a * a / (4 * np.pi**2) + 5 * a / np.pi - 6) ** 2 + 10 * (1 - 1 / (8 * np.pi)) * np.cos(a) + 10
    factor = 1.0 if x[1] == 0 else 1 - np.exp(-1 / (2 * x[1]))
    top, bottom = (
        2300 * x[0] ** 3 + 1900 * x[0] ** 2 + 2092 * x[0] + 60,
        100 * x[0] ** 3 + 500 * x[0] ** 2 + 4 * x[0] + 20,
    )
    return np.array([branin, factor * top / bottom])


def dtlz2(x: Point) -> Point:
    """Return the two objectives of DTLZ2 (Deb et al. 2005)."""
    g = float(((x[1:] - 0.5) ** 2).sum())
    return (1 + g) * np.array([np.cos(x[0] * np.pi / 2), np.sin(x[0] * np.pi / 2)])


def zdt2(x: Point) -> Point:
    """Return the two objectives of ZDT2 (Zitzler et al. 2000)."""
    g = 1 + 9 * float(x[1:].mean())
    return np.array([x[0], g * (1 - (x[0] / g) ** 2)])


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A function to minimize, both objectives, and what is known of its front."""

    function: Callable[[Point], Point]
    dimension: int
    reference_point: tuple[float, float]
    largest: float
    """Hypervolume of the front."""


PROBLEMS: Mapping[str, Problem] = {
    "branin_currin": Problem(
        function=branin_currin, dimension=2, reference_point=(18.0, 6.0), largest=59.36011874867746
    ),
    "dtlz2": Problem(function=dtlz2, dimension=6, reference_point=(1.1, 1.1), largest=1.21 - np.pi / 4),
    "zdt2": Problem(function=zdt2, dimension=6, reference_point=(11.0, 11.0), largest=121 - 2 / 3),
}
METHODS = ("1 at a time", "3 at a time", "3 asynchronous")
COLUMNS = ("problem", "method", "seed", "share", "share_at_30", "closest", "waiting")


def scenario_of(problem: Problem, seed: int, *, asynchronous: bool, batch_size: int) -> dict[str, Any]:
    """Return the scenario of one case."""
    return {
        "seed": seed,
        "input_parameters": {f"x{i}": {"parameter_type": "real", "values": [0, 1]} for i in range(problem.dimension)},
        "objectives": [
            {"name": name, "reference_point": r} for name, r in zip(("f1", "f2"), problem.reference_point, strict=True)
        ],
        "design_of_experiment": {"number_of_samples": 2 * (problem.dimension + 1)},
        "budget": {"evaluations": EVALUATIONS, "asynchronous": asynchronous, "batch_size": batch_size},
    }


@dataclass
class Course:
    """A run under way: what has been found, how close simultaneous configurations were, how long workers waited."""

    problem: Problem
    optimizer: Optimizer
    durations: np.random.Generator
    found: list[Point]
    closest: float = np.inf
    busy: float = 0.0
    elapsed: float = 0.0

    def point(self, suggestion: Suggestion) -> Point:
        """Return a configuration as an array."""
        return np.array(list(suggestion.configuration.values()), dtype=float)

    def tell(self, suggestion: Suggestion) -> None:
        """Evaluate a suggestion."""
        values = self.problem.function(self.point(suggestion))
        self.found.append(values)
        self.optimizer.tell(suggestion, {"f1": float(values[0]), "f2": float(values[1])})

    def compare(self, suggestions: list[Suggestion]) -> None:
        """Take note of the smallest distance of simultaneous configurations, in the largest coordinate difference."""
        X = np.array([self.point(s) for s in suggestions if s.phase == "model"])
        for i in range(1, len(X)):
            self.closest = min(self.closest, float(np.abs(X[:i] - X[i]).max(axis=1).min()))

    def in_batches(self, size: int) -> None:
        """Run in batches, each as long as its slowest evaluation."""
        while len(self.found) < EVALUATIONS:
            suggestions = self.optimizer.ask(min(size, EVALUATIONS - len(self.found)))
            self.compare(suggestions)
            lengths = self.durations.exponential(size=size)
            self.busy += lengths.sum()
            self.elapsed += size * lengths.max()
            for suggestion in suggestions:
                self.tell(suggestion)

    def by_workers(self, n: int) -> None:
        """Run with workers that get the next configuration as soon as they are free."""
        running: list[tuple[float, int, Suggestion]] = []
        now, n_begun = 0.0, 0
        while len(self.found) < EVALUATIONS:
            while len(running) < n and n_begun < EVALUATIONS:
                (suggestion,) = self.optimizer.ask()
                self.compare([*(s for *_, s in running), suggestion])
                length = float(self.durations.exponential())
                heapq.heappush(running, (now + length, suggestion.trial, suggestion))
                n_begun += 1
                self.busy += length
            now, _, suggestion = heapq.heappop(running)
            self.tell(suggestion)
        self.elapsed = n * now


def measure(name: str, method: str, seed: int) -> dict[str, Any]:
    """Run one case and return its row."""
    problem = PROBLEMS[name]
    size = int(method.split()[0])
    is_asynchronous = method.endswith("asynchronous")
    scenario = scenario_of(problem, seed, asynchronous=is_asynchronous, batch_size=1 if is_asynchronous else size)
    course = Course(problem, Optimizer(scenario), np.random.default_rng([seed, 1]), [])
    if is_asynchronous:
        course.by_workers(size)
    else:
        course.in_batches(size)
    corner = np.array(problem.reference_point)
    shares = [hypervolume(np.array(course.found[:n]), corner) / problem.largest for n in (EVALUATIONS, 30)]
    return {
        "problem": name,
        "method": method,
        "seed": seed,
        "share": shares[0],
        "share_at_30": shares[1],
        "closest": course.closest,
        "waiting": 1 - course.busy / course.elapsed,
    }


def summary(rows: list[dict[str, Any]]) -> Iterator[tuple[str, ...]]:
    """Yield a row per case: means over the seeds, and the loss against one at a time on the same seeds."""
    cases = dict.fromkeys((r["problem"], r["method"]) for r in rows)
    for problem, method in cases:
        case = {int(r["seed"]): r for r in rows if (r["problem"], r["method"]) == (problem, method)}
        alone = {int(r["seed"]): r for r in rows if (r["problem"], r["method"]) == (problem, METHODS[0])}
        common = sorted({*case} & {*alone})
        ratio = statistics.fmean(float(case[s]["share"]) for s in common) / statistics.fmean(
            float(alone[s]["share"]) for s in common
        )
        yield (
            problem,
            method,
            str(len(case)),
            f"{statistics.fmean(float(r['share_at_30']) for r in case.values()):.3f}",
            f"{statistics.fmean(float(r['share']) for r in case.values()):.4f}",
            f"{100 * (1 - ratio):.2f} %",
            "" if method == METHODS[0] else f"{min(float(r['closest']) for r in case.values()):.2g}",
            f"{100 * statistics.fmean(float(r['waiting']) for r in case.values()):.0f} %",
        )


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--problems", default=",".join(PROBLEMS))
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    table = ResultTable(arguments.output / "batches.csv", COLUMNS, key=("problem", "method", "seed"))
    for seed in range(arguments.seeds):
        for name in arguments.problems.split(","):
            for method in METHODS:
                table.fill({"problem": name, "method": method, "seed": seed}, measure)
    table.rows.sort(key=lambda r: ([*PROBLEMS].index(r["problem"]), METHODS.index(r["method"])))
    table.write_page(
        arguments.output / "batches.md",
        title="Several configurations at a time",
        command="python benchmarks/batches.py",
        text=f"{machine()}\nShare of the largest hypervolume after 30 and 60 evaluations, and what is lost against one "
        "at a time on the same\nseeds; the smallest distance (largest coordinate difference, in ranges) of two "
        "configurations that were under evaluation\ntogether; and the share of their time that the workers wait, when "
        "evaluations last a time drawn from an exponential\ndistribution.",
        header=("problem", "method", "seeds", "30", "60", "loss", "closest", "waiting"),
        rows=list(summary(table.rows)),
    )


if __name__ == "__main__":
    main()
