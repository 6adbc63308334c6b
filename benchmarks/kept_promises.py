"""Measure how much of what the model promises its suggestions give.

    python benchmarks/kept_promises.py [--seeds 10] [--problems NAME,...]

A suggestion by expected hypervolume improvement promises a growth of the dominated hypervolume: its acquisition value.
What it gives is the growth by its noise-free values. A model that is right keeps as much as it promises on average; one
that takes a cliff for a slope, or a rough function for a smooth one, promises much behind the cliff and gives little.
Shown are the sums of both over the suggestions of each third of a run, and over the seeds; and apart for suggestions on
the bounds of the space and inside, for the default method and for one that takes bounds like the rest.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from ablations import ABLATIONS
from contenders import Ours
from one_run import BlackBox, task_of
from problems import PROBLEMS, Problem
from reporting import ResultTable, machine, markdown_table
from threadpoolctl import threadpool_limits

from hypermap_lite import hypervolume
from hypermap_lite.acquisition.boundary_weighted import nearness
from hypermap_lite.optimizers.boundary import NEAR
from hypermap_lite.scalarization.base import Normalization

PARTS = 3
PLACES = ("inside", "on_bounds")
DEFAULT = "default"
UNDISCOUNTED = "bounds like the rest"
METHODS: Mapping[str, Sequence[str]] = {DEFAULT: (), UNDISCOUNTED: ABLATIONS[UNDISCOUNTED]}
COLUMNS = (
    *("problem", "method", "seed"),
    *(f"{what}_{k}" for k in range(PARTS) for what in ("promised", "given")),
    *(f"{what}_{place}" for place in PLACES for what in ("suggestions", "promised", "given")),
)
CHOSEN = tuple(name for name, p in PROBLEMS.items() if p.reference_point is not None and p.is_feasible is None)
"""Problems of several objectives whose acquisition value is the growth alone."""

TEXT = """Growth of the hypervolume, as a share of the largest one: what the model promised, and which part of that its
suggestions gave, in each third of the run after the design; sums over the suggestions, means over the seeds. Then how
many of the suggestions were inside and on bounds of the space, what each of them gave on average, as a share of the
largest hypervolume, and which part that is of what it promised."""


class Step(NamedTuple):
    """A suggestion by the model."""

    promised: float
    """Growth of the hypervolume, as a share of the largest one."""

    given: float
    is_on_bound: bool


def steps_of(problem: Problem, seed: int, overrides: Sequence[str] = ()) -> Iterator[Step]:
    """Yield what each suggestion by the model promises and gives."""
    black_box = BlackBox(problem, seed)
    ours = Ours(task_of(problem, seed, black_box), overrides=overrides)
    space = ours.optimizer.history.space
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
            near = nearness(ours.optimizer.history.X_all()[-1:], space.is_continuous).max()
            yield Step(float(np.exp(value) * unit / problem.best), given / problem.best, bool(near >= NEAR))


def measure(problem: str, method: str, seed: int) -> dict[str, Any]:
    """Return the row of a run."""
    row: dict[str, Any] = {"problem": problem, "method": method, "seed": seed}
    steps = np.array(list(steps_of(PROBLEMS[problem], seed, METHODS[method])), dtype=float)
    for k, part in enumerate(np.array_split(steps, PARTS)):
        row[f"promised_{k}"], row[f"given_{k}"], _ = (float(total) for total in part.sum(axis=0))
    for is_on_bound, place in enumerate(PLACES):
        there = steps[steps[:, 2] == is_on_bound]
        row[f"suggestions_{place}"] = len(there)
        row[f"promised_{place}"], row[f"given_{place}"], _ = (float(total) for total in there.sum(axis=0))
    print(problem, method, seed, flush=True)
    return row


def line_of(problem: str, rows: Sequence[Mapping[str, str]]) -> tuple[str, ...]:
    """Return the line of a problem."""
    cells = []
    for k in range(PARTS):
        promised, given = (sum(float(row[f"{what}_{k}"]) for row in rows) for what in ("promised", "given"))
        cells += [f"{promised / len(rows):.3g}", f"{100 * given / promised:.0f} %"]
    return problem, str(len(rows)), *cells


def line_of_places(problem: str, method: str, rows: Sequence[Mapping[str, str]]) -> tuple[str, ...]:
    """Return the line of a problem and method in the second table."""
    total = {name: sum(float(row[name]) for row in rows) for name in COLUMNS[3:]}
    n = sum(total[f"suggestions_{place}"] for place in PLACES)
    cells = [f"{100 * total['suggestions_on_bounds'] / n:.0f} %"]
    for place in PLACES:
        suggestions, promised, given = (total[f"{what}_{place}"] for what in ("suggestions", "promised", "given"))
        cells.append(f"{given / suggestions:.2g} ({100 * given / promised:.0f} %)" if suggestions else "")
    return problem, method, *cells


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--problems", default=",".join(CHOSEN))
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    results = ResultTable(arguments.output / "kept_promises.csv", COLUMNS, key=("problem", "method", "seed"))
    with threadpool_limits(1):
        for seed in range(arguments.seeds):
            for problem in arguments.problems.split(","):
                for method in METHODS:
                    results.fill({"problem": problem, "method": method, "seed": seed}, measure)
    cases = {
        (name, method): [row for row in results.rows if (row["problem"], row["method"]) == (name, method)]
        for name in CHOSEN
        for method in METHODS
    }
    text = [machine() + "\n" + TEXT, ""]
    text += markdown_table(
        ("problem", "method", "on bounds", "given inside", "given on bounds"),
        [line_of_places(*case, rows) for case, rows in cases.items() if rows],
    )
    results.write_page(
        arguments.output / "kept_promises.md",
        title="Kept promises",
        command="python benchmarks/kept_promises.py",
        text="\n".join(text),
        header=("problem", "seeds", *(cell for part in ("first", "second", "last") for cell in (part, "given"))),
        rows=[line_of(name, rows) for (name, method), rows in cases.items() if rows and method == DEFAULT],
    )


if __name__ == "__main__":
    main()
