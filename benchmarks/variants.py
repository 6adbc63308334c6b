"""Compare the variants of the robot tasks: as the paper means them, as its code computes them, on a stand-in.

    python benchmarks/variants.py [--rollouts 100] [--jobs 2]

Each task in each variant with the means of both priors and with a good skill; the same seeds everywhere.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from reporting import machine, markdown_table
from rollout_throughput import GOOD_PARAMETERS
from task_landscape import means

from robot_tasks.errors import SimulationError
from robot_tasks.evaluation import VARIANTS, evaluate
from robot_tasks.tasks import TASKS

SKILLS = ("operator means", "misleading means", "good skill")
NUMBERS = ("success", "touches", "tool_peak_force", "interventions")

Job = tuple[str, str, str, int]


def parameters_of(task: str, skill: str) -> Mapping[str, float]:
    """Return the parameters of a skill."""
    return GOOD_PARAMETERS[task] if skill == "good skill" else means(task, skill.partition(" ")[0])


def run(job: Job) -> list[float] | None:
    """Run one rollout and return objectives and other numbers, or None if the physics broke down."""
    task, variant, skill, seed = job
    try:
        numbers = evaluate(task, parameters_of(task, skill), seed, variant=variant)
    except SimulationError:
        return None
    return [numbers[name] for name in (*TASKS[task].objectives, *NUMBERS)]


def line(case: Sequence[str], results: Sequence[list[float] | None]) -> tuple[str, ...]:
    """Return the line of the page for a task, variant and skill."""
    table = np.array([result for result in results if result is not None])
    error = table.std(axis=0, ddof=1) / np.sqrt(len(table))
    return (
        *case,
        *(f"{table[:, k].mean():.5g} ± {error[k]:.2g}" for k in (0, 1)),
        f"{100 * table[:, 2].mean():.0f} %",
        f"{100 * np.mean(table[:, 3] > 0):.0f} %",
        f"{np.median(table[:, 4]):.0f} N",
        f"{100 * table[:, 5].mean():.0f} %",
        str(len(results) - len(table)),
    )


def main() -> None:
    """Run all rollouts and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rollouts", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    n = arguments.rollouts
    cases = [(task, variant, skill) for task in TASKS for skill in SKILLS for variant in VARIANTS]
    with ProcessPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(run, [(*case, seed) for case in cases for seed in range(n)], chunksize=10))
    rows = [line(case, results[n * i : n * (i + 1)]) for i, case in enumerate(cases)]
    header = ("task", "variant", "skill", "first objective", "second objective", "success", "touch", "peak", "stopped")
    lines = [
        "# Variants of the robot tasks",
        "",
        f"    python benchmarks/variants.py --rollouts {n}",
        "",
        machine(),
        "",
    ]
    lines += [
        f"Means and standard errors of {n} rollouts. Touch: share of rollouts in which arm or tool touched something",
        "it should not; peak: median of the largest contact force on the tool; stopped: by the operator; errors: of",
        "the simulation.",
        "",
        *markdown_table((*header, "errors"), rows),
    ]
    text = "\n".join(lines) + "\n"
    (arguments.output / "variants.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
