"""See what is left to gain: how far an optimizer gets that knows the functions and takes the best next step.

    python benchmarks/known_functions.py [--output benchmarks/results]

Points of the true front, found by many evaluations, are taken one by one, each the one by which the hypervolume grows
most. A method that looks one step ahead hardly does better, whatever its model, for none knows more; an optimizer also
pays for its design, so as many steps are taken as it makes after that. Two objectives, without noise.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd
from problems import PROBLEMS, Problem
from reporting import machine, markdown_table

NAMES = ("branin_currin", "zdt2", "dtlz2", "constrained_branin_currin", "c2dtlz2", "chankong_haimes", "tnk", "plateau")
METHOD = "default"
START = 2**17
"""Random points at first."""

ROUNDS = 30
CHILDREN = 2**15
"""Perturbed copies of the front in each round."""

KEPT = 2000
"""Points of the front that have them, spread over it."""

WIDTHS = (0.1, 0.01, 0.001, 1e-4)
"""Standard deviations of perturbations, in units of the cube."""

FloatArray = npt.NDArray[np.float64]


def front_of(problem: Problem, rng: np.random.Generator) -> FloatArray:
    """Return many points of a problem's front that count, sorted by the first objective, shape (k, 2)."""
    U, Y = sifted(problem, rng.random((START, problem.dimension)))
    for _ in range(ROUNDS):
        some = U[np.unique(np.linspace(0, len(U) - 1, KEPT).astype(int))]
        parents = some[rng.integers(len(some), size=CHILDREN)]
        widths = rng.choice(WIDTHS, (CHILDREN, 1)) * (rng.random(parents.shape) < 0.5)
        children = np.clip(parents + widths * rng.standard_normal(parents.shape), 0, 1)
        U, Y = sifted(problem, np.vstack([U, children]))
    return Y


def sifted(problem: Problem, U: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the feasible and non-dominated ones of n points that are below the reference point, sorted."""
    points = problem.points(U)
    Y = problem.function(points)
    counts = (np.asarray(problem.reference_point) > Y).all(axis=1)
    if problem.is_feasible is not None:
        counts &= problem.is_feasible(points)
    U, Y = U[counts], Y[counts]
    order = np.lexsort((Y[:, 1], Y[:, 0]))
    U, Y = U[order], Y[order]
    lowest = np.minimum.accumulate(Y[:, 1])
    on_front = np.r_[True, Y[1:, 1] < lowest[:-1]]
    return U[on_front], Y[on_front]


def growth(front: FloatArray, reference_point: FloatArray, steps: int) -> Iterator[float]:
    """Yield the hypervolume after each greedy step along a front, sorted by the first objective."""
    taken = np.empty((0, 2))
    total = 0.0
    for _ in range(steps):
        place = np.searchsorted(taken[:, 0], front[:, 0])
        above = np.r_[reference_point[1], taken[:, 1]][place]
        right = np.r_[taken[:, 0], reference_point[0]][place]
        gains = np.maximum(above - front[:, 1], 0.0) * np.maximum(right - front[:, 0], 0.0)
        best = int(gains.argmax())
        total += float(gains[best])
        yield total
        taken = np.insert(taken, place[best], front[best], axis=0)


def rows(results: pd.DataFrame) -> Iterator[list[str]]:
    """Yield shares of the largest hypervolume, half way and in the end, with the functions known and by the default."""
    for name in NAMES:
        problem = PROBLEMS[name]
        front = front_of(problem, np.random.default_rng(0))
        n, design = problem.evaluations, problem.design
        known = np.array([*growth(front, np.asarray(problem.reference_point), n)]) / problem.best
        ours = results[(results.problem == name) & (results.method == METHOD)]
        half, final = (f"{ours[column].mean():.3f} ± {ours[column].sem():.3f}" for column in ("half", "final"))
        yield [
            name,
            f"{known[n // 2 - design - 1]:.3f}",
            half,
            f"{known[n - design - 1]:.3f}",
            final,
            f"{known[-1]:.3f}",
        ]


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results", help="folder of the page")
    folder = parser.parse_args().output
    results = pd.read_csv(folder / "sample_efficiency.csv")
    page = [
        "# What is left to gain",
        "",
        "    python benchmarks/known_functions.py",
        "",
        machine(),
        "Share of the largest hypervolume: of greedy steps by someone who knows the functions, as many as a run makes",
        "after its design, and of the default method (means over its seeds with standard errors), after half of the",
        "evaluations and after all; and of the greedy steps if none went into a design. Who looks one step ahead",
        "hardly gets farther.",
        "",
        *markdown_table(
            ["problem", "known, half", "default, half", "known", "default", "known, no design"], [*rows(results)]
        ),
    ]
    (folder / "known_functions.md").write_text("\n".join(page) + "\n")


if __name__ == "__main__":
    main()
