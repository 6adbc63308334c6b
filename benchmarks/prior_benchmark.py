"""Measure what good priors gain and wrong ones cost: by piBO's definitions, and those of the robot tasks.

    python benchmarks/prior_benchmark.py [--seeds N] [--problems NAME,...] [--methods NAME,...]

A prior is a Gaussian per parameter, truncated to the bounds; deviation and offset are shares of the range [1]_:

strong
    standard deviation 1 %, mean at the optimum plus N(0, 1 %), drawn anew for each seed
weak
    standard deviation 10 %, mean at the optimum plus N(0, 10 %)
wrong
    standard deviation 1 %, mean at a corner that is far from all good points, without an offset

With two objectives the optimum is the point of the front that dominates most by itself. The emulated robot tasks have
the priors of their scenarios in `example_scenarios/robot`, an operator's and a misleading one. There a run either finds
the parameters that succeed or it does not, so what a prior is worth shows in many seeds only: 60, elsewhere 20.

Every run makes its own design of 2 (d + 1) points, as a user's would. Rows are written as they are measured and a case
that has its row is not run again. `--variant` and `--again` are those of `sample_efficiency.py`.

References
----------
.. [1] Hvarfner, Stoll, Souza, Lindauer, Hutter, Nardi. piBO: Augmenting Acquisition Functions with User Beliefs for
   Bayesian Optimization. ICLR 2022. Section 4 and appendix.
"""

from __future__ import annotations

import argparse
import functools
import json
import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from contenders import Ours
from methods import DEFAULT
from one_run import COLUMNS as RUN_COLUMNS
from one_run import run
from problems import PROBLEMS, Problem
from problems.emulated import EMULATED
from reporting import ResultTable, machine
from threadpoolctl import threadpool_limits

COLUMNS = ("problem", "method", "prior", "seed", *RUN_COLUMNS[3:])
KEY = COLUMNS[:4]
NONE = "none"
METHODS: Mapping[str, Sequence[str]] = {DEFAULT: (), "paper preset": ("preset=paper",)}
"""Changes to the scenario."""


@dataclass(frozen=True, kw_only=True)
class Level:
    """How sure and how right a user is."""

    deviation: float
    """Standard deviation of the prior, as a share of each parameter's range."""

    offset: float = 0.0
    """Standard deviation of its mean around the place it is meant for, likewise."""

    is_wrong: bool = False


LEVELS: Mapping[str, Level] = {
    "strong": Level(deviation=0.01, offset=0.01),
    "weak": Level(deviation=0.1, offset=0.1),
    "wrong": Level(deviation=0.01, is_wrong=True),
}


@dataclass(frozen=True, kw_only=True)
class Places:
    """Points of a problem, in the unit cube."""

    good: tuple[float, ...]
    bad: tuple[float, ...]


PLACES: Mapping[str, Places] = {
    "branin_currin": Places(good=(0.049, 1.0), bad=(0.0, 0.0)),
    "hartmann6": Places(
        good=(0.20168952, 0.15001069, 0.47687398, 0.27533243, 0.31165162, 0.65730054),
        bad=(1.0, 1.0, 1.0, 1.0, 1.0, 0.0),
    ),
}


def parameters_with_prior(problem: Problem, places: Places, level: Level, seed: int) -> dict[str, Any]:
    """Return the parameters of a scenario with the prior of one seed."""
    place = np.array(places.bad if level.is_wrong else places.good)
    mean = place + level.offset * np.random.default_rng([seed, 2]).standard_normal(len(place))
    parameters = {}
    for (name, parameter), u in zip(problem.parameters.items(), mean, strict=True):
        low, high = parameter["values"]
        prior = {"type": "gaussian", "mean": low + float(u) * (high - low), "std": level.deviation * (high - low)}
        parameters[name] = {**parameter, "prior": prior}
    return parameters


PROBLEMS_TRIED = (*PLACES, *EMULATED)
SEEDS, SEEDS_OF_TASKS = 20, 60
SCENARIOS = Path(__file__).parents[1] / "example_scenarios" / "robot"
OF_TASKS = ("operator", "misleading")
"""Priors of the robot tasks, by the names of their files."""


def priors_of(problem: str) -> tuple[str, ...]:
    """Return what a problem is tried with, no prior first."""
    return (NONE, *(OF_TASKS if problem in EMULATED else LEVELS))


def parameters_of_task(problem: str, prior: str) -> dict[str, Any]:
    """Return the parameters of an emulated task with a prior of its scenarios."""
    file = SCENARIOS / problem.removesuffix("_emulated") / f"{prior}_prior.json"
    stated = json.loads(file.read_text(encoding="utf-8"))["input_parameters"]
    return {name: {**parameter, **stated.get(name, {})} for name, parameter in PROBLEMS[problem].parameters.items()}


def measure(
    problem: str, method: str, prior: str, seed: int, *, methods: Mapping[str, Sequence[str]]
) -> dict[str, Any]:
    """Run one case and return its row."""
    changes = {}
    if prior in LEVELS:
        parameters = parameters_with_prior(PROBLEMS[problem], PLACES[problem], LEVELS[prior], seed)
        changes = {"input_parameters": parameters}
    elif prior != NONE:
        changes = {"input_parameters": parameters_of_task(problem, prior)}
    start = functools.partial(Ours, changes=changes, overrides=methods[method])
    row = {"problem": problem, "method": method, "prior": prior, "seed": seed}
    row |= run(PROBLEMS[problem], seed, start, has_design=False)
    print(f"{problem}, {method}, {prior}, seed {seed}: {row['final']:.4g}", flush=True)
    return row


def worth(problem: Problem, quality: float) -> float:
    """Return what a row says was reached as a number of which more is better and zero is nothing.

    The share of the hypervolume, or the negative of the best value.
    """
    return quality if problem.reference_point is not None else -problem.best - 10**quality


def evaluations_to(problem: Problem, trace: Sequence[float], target: float) -> float:
    """Return after how many evaluations a run was worth a target; infinity if it never was."""
    reached = (i + 1 for i, quality in enumerate(trace) if worth(problem, quality) >= target)
    return next(reached, float("inf"))


def ratio(values: Sequence[float], others: Sequence[float]) -> str:
    """Return the ratio of two means, with its standard error, as if they were independent, if there is one."""
    found = statistics.fmean(values) / statistics.fmean(others)
    if min(len(values), len(others)) < 2:
        return f"{found:.3f}"
    shares = [statistics.variance(v) / len(v) / statistics.fmean(v) ** 2 for v in (values, others)]
    return f"{found:.3f} ± {abs(found) * math.sqrt(sum(shares)):.3f}"


def share_of_budget(n: float, problem: Problem) -> str:
    """Return a number of evaluations as a share of all."""
    return "never" if n == float("inf") else f"{100 * n / problem.evaluations:.0f} %"


def summary(rows: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, ...]]:
    """Yield a line per problem, method and prior, against the same method without a prior."""
    for name, method in dict.fromkeys((row["problem"], row["method"]) for row in rows):
        problem = PROBLEMS[name]
        cases = {
            prior: [row for row in rows if (row["problem"], row["method"], row["prior"]) == (name, method, prior)]
            for prior in priors_of(name)
        }
        if not cases[NONE]:
            continue
        without = [worth(problem, float(row["final"])) for row in cases[NONE]]
        target = statistics.fmean(without)
        for prior, case in cases.items():
            if not case:
                continue
            finals = [worth(problem, float(row["final"])) for row in case]
            traces = [[float(value) for value in row["trace"].split()] for row in case]
            counts = [[evaluations_to(problem, trace, share * target) for trace in traces] for share in (1, 0.99)]
            qualities = [float(row["final"]) for row in case]
            yield (
                *(name, method, prior, str(len(case)), f"{statistics.fmean(qualities):.3f}"),
                ratio(finals, without),
                f"{min(finals) / target:.3f}",
                *(share_of_budget(statistics.median(n), problem) for n in counts),
                f"{sum(n < float('inf') for n in counts[0])} of {len(case)}",
                f"{statistics.median(float(row['cpu_seconds']) for row in case):.3f}",
            )


TEXT = """Final: mean log10 regret, or mean share of the largest hypervolume. Relative: final value (the share, or the
negative best value) as a part of the mean of the same method without a prior, on average with its standard error, and
of the worst seed. Reached: after what share of the evaluations the mean final value of no prior was reached, and 99 %
of it, medians over the seeds. Goals: a strong prior reaches it within 40 %, and a wrong or misleading one ends with a
relative value of at least 0.95."""


def draw(rows: Sequence[Mapping[str, Any]], file: Path) -> None:
    """Draw all cases: a colour per prior, dashes for other methods than the default; nothing without Matplotlib."""
    try:
        import curves
    except ImportError:
        print("No picture: Matplotlib is not installed.")
        return
    colours = dict(zip((NONE, *LEVELS, *OF_TASKS), curves.style.COLOURS, strict=False))
    methods = dict.fromkeys(row["method"] for row in rows)
    dashes = {method: curves.SOLID if method == DEFAULT else curves.DASHED for method in methods}
    lines = {f"{method}, {prior}": (colours[prior], dashes[method]) for method in methods for prior in colours}
    named = [{**row, "method": f"{row['method']}, {row['prior']}"} for row in rows]
    curves.draw(named, PROBLEMS_TRIED, tuple(lines), title="Priors", file=file, lines=lines)


def main() -> None:
    """Measure the missing cases and write the result page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, help="instead of 20 and, for emulated tasks, 60")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--problems", default=",".join(PROBLEMS_TRIED))
    parser.add_argument("--methods", help="comma-separated")
    parser.add_argument("--priors", help="comma-separated")
    parser.add_argument("--variant", nargs="+", action="append", default=[], metavar=("NAME", "KEY=VALUE"))
    parser.add_argument("--again", default="", help="methods whose rows are forgotten first, comma-separated")
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    arguments = parser.parse_args()
    methods = {**METHODS, **{name: changes for name, *changes in arguments.variant}}
    table = ResultTable(arguments.output / "prior_benchmark.csv", COLUMNS, key=KEY)
    if arguments.again:
        table.forget("method", arguments.again.split(","))
    fill = functools.partial(measure, methods=methods)
    with threadpool_limits(1):
        for problem in arguments.problems.split(","):
            n = arguments.seeds or (SEEDS_OF_TASKS if problem in EMULATED else SEEDS)
            for seed in range(arguments.first_seed, arguments.first_seed + n):
                for method in arguments.methods.split(",") if arguments.methods else methods:
                    for prior in arguments.priors.split(",") if arguments.priors else priors_of(problem):
                        table.fill({"problem": problem, "method": method, "prior": prior, "seed": seed}, fill)
    table.write_page(
        arguments.output / "prior_benchmark.md",
        title="What priors gain and cost",
        command="python benchmarks/prior_benchmark.py --methods default",
        text=f"{machine()}\n{TEXT}\n\n![curves](prior_benchmark.png)",
        header=(
            *("problem", "method", "prior", "seeds", "final", "relative", "worst", "reached", "99 % reached"),
            *("seeds there", "CPU s"),
        ),
        rows=list(summary(table.rows)),
    )
    draw(table.rows, arguments.output / "prior_benchmark.png")


if __name__ == "__main__":
    main()
