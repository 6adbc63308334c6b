"""One contender on one problem with one seed: from the shared design to the row of the result table."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from contenders import Answered, Contender, ContenderError, Task
from problems import Problem
from problems.base import FloatArray

from hypermap_lite.pareto.hypervolume import hypervolume_trace
from hypermap_lite.quasi_random import sobol_points

COLUMNS = (
    *("problem", "method", "seed", "evaluations", "design", "half", "final"),
    *("cpu_seconds", "wall_seconds", "slowest_cpu_seconds", "feasible_share", "run_cpu_seconds", "error", "trace"),
)
KEY = ("problem", "method", "seed")
SMALLEST_REGRET = 1e-12


class BlackBox:
    """Evaluates a problem; keeps the noise-free values, and gives evaluation number k the same noise in every run.

    Of a failure nothing better is known than what came out.
    """

    def __init__(self, problem: Problem, seed: int) -> None:
        self._problem = problem
        self._rng = np.random.default_rng([seed, 1])
        self._luck = np.random.default_rng([seed, 2])
        self.truths: list[FloatArray] = []
        self.feasible: list[bool] = []

    def __call__(self, configuration: Mapping[str, Any]) -> Answered:
        """Return the observation of a configuration."""
        truth, is_feasible = self._problem.evaluate(configuration)
        if self._luck.random() < self._problem.failures:
            truth = self._problem.worst
        self.truths.append(truth)
        self.feasible.append(is_feasible)
        noise = self._problem.noise_sd * self._rng.standard_normal(len(truth))
        return Answered(configuration, (truth + noise).tolist(), is_feasible)


def quality(problem: Problem, Y: FloatArray, is_feasible: list[bool]) -> FloatArray:
    """Return how good the evaluated points are after each evaluation, by their noise-free values.

    Parameters
    ----------
    problem
        What was evaluated.
    Y
        Noise-free objective values in the order of the evaluations, shape (n, m).
    is_feasible
        Whether each configuration was allowed.

    Returns
    -------
    FloatArray
        Shape (n,): log10 of the regret of the best value, at least -12, as of the worst one until a point is allowed;
        with several objectives, the share of the largest hypervolume.
    """
    if problem.reference_point is None:
        values = Y[:, 0] if problem.is_feasible is None else np.where(is_feasible, Y[:, 0], problem.worst[0])
        regret = np.minimum.accumulate(values) - problem.best
        return np.log10(np.maximum(regret, SMALLEST_REGRET))
    Y = np.where(np.array(is_feasible)[:, None], Y, np.nan)
    return hypervolume_trace(Y, np.array(problem.reference_point)) / problem.best


def task_of(problem: Problem, seed: int, black_box: BlackBox) -> Task:
    """Return the task with its design evaluated: the first points of a scrambled Sobol sequence."""
    U = sobol_points(problem.evaluations, problem.dimension, np.random.default_rng(seed))
    configurations = problem.configurations(problem.points(U))
    return Task(
        problem=problem,
        seed=seed,
        design=[black_box(configuration) for configuration in configurations[: problem.design]],
        spare=configurations[problem.design :],
    )


def run(problem: Problem, seed: int, start: Callable[[Task], Contender], *, has_design: bool = True) -> dict[str, Any]:
    """Run a contender and return what it reached and took.

    Parameters
    ----------
    problem
        What to minimize.
    seed
        Of design, noise and contender.
    start
        Returns the contender.
    has_design
        Whether it begins with the shared design; otherwise it makes its own.
    """
    black_box = BlackBox(problem, seed)
    task = task_of(problem, seed, black_box) if has_design else Task(problem=problem, seed=seed)
    cpu, wall = [], []
    try:
        contender = start(task)
        try:
            while len(black_box.truths) < problem.evaluations:
                suggested = contender.suggest()
                cpu.append(suggested.cpu)
                wall.append(suggested.wall)
                answer = black_box(suggested.configuration)
                contender.tell(answer.values, answer.is_feasible)
        finally:
            contender.close()
    except ContenderError as error:
        return {"evaluations": len(black_box.truths), "design": problem.design, "error": str(error)}
    trace = quality(problem, np.array(black_box.truths), black_box.feasible)
    model_based = slice(0 if has_design else problem.design, None)
    return {
        "evaluations": problem.evaluations,
        "design": problem.design,
        "half": float(trace[problem.evaluations // 2 - 1]),
        "final": float(trace[-1]),
        "cpu_seconds": statistics.median(cpu[model_based]),
        "wall_seconds": statistics.median(wall[model_based]),
        "slowest_cpu_seconds": max(cpu[model_based]),
        "feasible_share": float(np.mean(black_box.feasible[problem.design :])),
        "run_cpu_seconds": sum(cpu),
        "error": "",
        "trace": " ".join(f"{value:.5g}" for value in trace),
    }
