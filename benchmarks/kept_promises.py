"""Measure how much of what the model promises its suggestions give.

    python benchmarks/kept_promises.py [--seeds 10] [--problems NAME,...]

A suggestion by expected hypervolume improvement promises a growth of the dominated hypervolume: its acquisition value.
What it gives is the growth by its noise-free values. A model that is right keeps as much as it promises on average; one
that takes a cliff for a slope, or a rough function for a smooth one, promises much behind the cliff and gives little.
Shown are the sums of both over the suggestions of each third of a run, and over the seeds.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from contenders import Ours
from one_run import BlackBox, task_of
from problems import PROBLEMS, Problem
from reporting import ResultTable, machine
from threadpoolctl import threadpool_limits

from hypermap_lite import hypervolume
from hypermap_lite.scalarization.base import Normalization

PARTS = 3
COLUMNS = ("problem", "seed", *(f"{what}_{k}" for k in range(PARTS) for what in ("promised", "given")))
CHOSEN = tuple(name for name, p in PROBLEMS.items() if p.reference_point is not None and p.is_feasible is None)
"""Problems of several objectives whose acquisition value is the growth alone."""

TEXT = """Growth of the hypervolume, as a share of the largest one: what the model promised, and which part of that its
suggestions gave, in each third of the run after the design; sums over the suggestions, means over the seeds."""


def steps_of(problem: Problem, seed: int) -> Iterator[tuple[float, float]]:
    """Yield what each suggestion by the model promises and gives, as shares of the largest hypervolume."""
    black_box = BlackBox(problem, seed)
    ours = Ours(task_of(problem, seed, black_box))
    reference_point = np.array(problem.reference_point)
    for _ in range(problem.evaluations - problem.design):
        known = ours.optimizer.history.Y()
        before = hypervolume(np.array(black_box.truths), reference_point)
        answer = black_box(ours.suggest().configuration)
        ours.tell(answer.values, answer.is_feasible)
        value = ours.optimizer.history[-1].suggestion.acquisition_value
        if value is not None:
            unit = np.prod(Normalization.of_front(known, reference_point).scale)
            given = hypervolume(np.array(black_box.truths), reference_point) - before
            yield float(np.exp(value) * unit / problem.best), given / problem.best


def measure(problem: str, seed: int) -> dict[str, Any]:
    """Return the row of a run."""
    row: dict[str, Any] = {"problem": problem, "seed": seed}
    for k, part in enumerate(np.array_split(np.array(list(steps_of(PROBLEMS[problem], seed))), PARTS)):
        row[f"promised_{k}"], row[f"given_{k}"] = (float(total) for total in part.sum(axis=0))
    print(problem, seed, flush=True)
    return row


def line_of(problem: str, rows: Sequence[Mapping[str, str]]) -> tuple[str, ...]:
    """Return the line of a problem."""
    cells = []
    for k in range(PARTS):
        promised, given = (sum(float(row[f"{what}_{k}"]) for row in rows) for what in ("promised", "given"))
        cells += [f"{promised / len(rows):.3g}", f"{100 * given / promised:.0f} %"]
    return problem, str(len(rows)), *cells


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--problems", default=",".join(CHOSEN))
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    results = ResultTable(arguments.output / "kept_promises.csv", COLUMNS, key=("problem", "seed"))
    with threadpool_limits(1):
        for seed in range(arguments.seeds):
            for problem in arguments.problems.split(","):
                results.fill({"problem": problem, "seed": seed}, measure)
    measured = {name: [row for row in results.rows if row["problem"] == name] for name in CHOSEN}
    results.write_page(
        arguments.output / "kept_promises.md",
        title="Kept promises",
        command="python benchmarks/kept_promises.py",
        text=machine() + "\n" + TEXT,
        header=("problem", "seeds", *(cell for part in ("first", "second", "last") for cell in (part, "given"))),
        rows=[line_of(name, rows) for name, rows in measured.items() if rows],
    )


if __name__ == "__main__":
    main()
