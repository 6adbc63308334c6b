"""Compare how few evaluations this package and others need, on problems with known answers.

    python benchmarks/sample_efficiency.py TABLE [--seeds 10] [--problems NAME,...] [--methods NAME,...]

TABLE is `single`, `several`, `constrained`, `limits`, `skills`, `many`, `mixed`, `tails`, `failing` or `ablation`;
`page` only writes the page and the pictures again.
All methods begin with the same design of 2 (d + 1) points of a scrambled Sobol sequence, with the same noise, and go on
one evaluation at a time, with one thread of linear algebra. Rows are written as they are measured and a case that has
its row is not run again, so an interrupted benchmark goes on; `--again` forgets the rows of a method whose code has
changed. Two processes may share the work if their seeds or problems differ (`--first-seed`).

Other packages are run with Pythons of their own, DIR/NAME/bin/python with --environments DIR; one that is missing is
skipped, with the commands that make it. A variant of this package is tried without an edit by

    --variant "many samples" acquisition.samples=128
"""

from __future__ import annotations

import argparse
import functools
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ablations import ABLATIONS, OF_FAILURES, OF_FEASIBILITY, OF_MODES, OF_NOISE, OF_OUTLIERS, OF_TAILS
from contenders import Contender, Task
from efficiency_page import write_page
from methods import DEFAULT, METHODS, PEERS, Method, ours, starter
from one_run import COLUMNS, KEY, run
from problems import (
    CONSTRAINED,
    EMULATED,
    FAILING,
    LIMITS,
    MANY,
    MIXED,
    MODES,
    PROBLEMS,
    ROUGH,
    SEVERAL,
    SINGLE,
    SKILLS,
    TAILS,
)
from reporting import ResultTable
from threadpoolctl import threadpool_limits

COMPARED = (DEFAULT, "paper preset", "Sobol", "random", *PEERS)


@dataclass(frozen=True, kw_only=True)
class Table:
    """What is run on what."""

    title: str
    problems: Sequence[str]
    methods: Sequence[str] = COMPARED


TABLES: Mapping[str, Table] = {
    "single": Table(title="One objective", problems=tuple(SINGLE), methods=(*COMPARED, *OF_NOISE)),
    "several": Table(title="Two and three objectives", problems=tuple(SEVERAL)),
    "constrained": Table(
        title="Two objectives with an unknown constraint",
        problems=tuple(CONSTRAINED),
        methods=(*COMPARED, *OF_FEASIBILITY),
    ),
    "limits": Table(
        title="One objective with an unknown constraint",
        problems=tuple(LIMITS),
        methods=(*COMPARED, *OF_FEASIBILITY),
    ),
    "skills": Table(
        title="Skills: a plateau of failure, and the emulated robot tasks",
        problems=tuple(SKILLS),
        methods=(*COMPARED, *OF_FAILURES),
    ),
    "modes": Table(
        title="Skills of which the front needs two kinds of outcomes",
        problems=tuple(MODES),
        methods=(*COMPARED, *OF_MODES),
    ),
    "rough": Table(
        title="More waves and steps than can be told apart",
        problems=tuple(ROUGH),
        methods=(*COMPARED, "noise-free model"),
    ),
    "many": Table(
        title="Ten to twenty parameters, 100 evaluations",
        problems=tuple(MANY),
        methods=(*COMPARED, *OF_FAILURES),
    ),
    "mixed": Table(title="Categories, integers and lists of values", problems=tuple(MIXED)),
    "tails": Table(
        title="Values over decades: functions, and penalties for failures",
        problems=tuple(TAILS),
        methods=(*COMPARED, *OF_TAILS, *OF_FAILURES),
    ),
    "failing": Table(
        title="One evaluation in twenty fails for no reason of its parameters",
        problems=tuple(FAILING),
        methods=(*COMPARED, *OF_OUTLIERS, *OF_FAILURES),
    ),
    "ablation": Table(
        title="The default method and its variants",
        problems=(
            *("branin", "hartmann6_noisy", "func2c", "branin_currin_noisy", "dtlz2", "chankong_haimes", "plateau"),
            *EMULATED,
        ),
        methods=(DEFAULT, *ABLATIONS, *OF_OUTLIERS, *OF_FAILURES),
    ),
}


def measure(
    problem: str,
    method: str,
    seed: int,
    *,
    starts: Mapping[str, Callable[[Task], Contender]],
    evaluations: int | None = None,
) -> dict[str, Any]:
    """Run one case and return its row."""
    known = PROBLEMS[problem]
    row = dict.fromkeys(COLUMNS, "") | {"problem": problem, "method": method, "seed": seed}
    row |= run(replace(known, evaluations=evaluations or known.evaluations), seed, starts[method])
    print(f"{problem}, {method}, seed {seed}: {row['error'] or format(row['final'], '.4g')}", flush=True)
    return row


def runnable(methods: Mapping[str, Method], environments: Path) -> dict[str, Callable[[Task], Contender]]:
    """Return what starts each method, without those whose environment is missing, which it says."""
    starts = {}
    for name, method in methods.items():
        start = starter(name, method, environments)
        if isinstance(start, str):
            print(start)
        else:
            starts[name] = start
    return starts


def announce(missing: Sequence[Mapping[str, Any]], rows: Sequence[Mapping[str, Any]]) -> None:
    """Say how long the missing cases will take, by the rows of the same method and problem or else method."""
    known, unknown = 0.0, []
    for case in missing:
        alike = [row for row in rows if row["method"] == case["method"] and row["run_cpu_seconds"] != ""]
        same = [row for row in alike if row["problem"] == case["problem"]]
        if alike:
            known += statistics.fmean(float(row["run_cpu_seconds"]) for row in same or alike)
        else:
            unknown.append(case["method"])
    print(f"{len(missing)} runs to do, about {known / 3600:.2f} h of CPU", end="")
    print(f" and {len(unknown)} runs of which nothing is known: {', '.join(dict.fromkeys(unknown))}." * bool(unknown))


def arguments_of(words: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line, or what stands for it."""
    here = Path(__file__).parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=[*TABLES, "page"])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--problems", help="instead of those of the table, comma-separated")
    parser.add_argument("--methods", help="instead of those of the table, comma-separated")
    parser.add_argument("--variant", nargs="+", action="append", default=[], metavar=("NAME", "KEY=VALUE"))
    parser.add_argument("--again", default="", help="methods whose rows are forgotten first, comma-separated")
    parser.add_argument("--evaluations", type=int, help="instead of the problems' own, to try the benchmark")
    parser.add_argument("--environments", type=Path, default=here / "peers" / "environments", metavar="DIR")
    parser.add_argument("--estimate", action="store_true", help="only say how long the missing runs take")
    parser.add_argument("--output", type=Path, default=here / "results")
    return parser.parse_args(words)


def main(words: Sequence[str] | None = None) -> None:
    """Measure the missing cases and write the result page."""
    arguments = arguments_of(words)
    results = ResultTable(arguments.output / "sample_efficiency.csv", COLUMNS, key=KEY)
    if arguments.again:
        results.forget("method", arguments.again.split(","))
    if arguments.table != "page":
        table = TABLES[arguments.table]
        variants = {name: ours(overrides=changes) for name, *changes in arguments.variant}
        names = arguments.methods.split(",") if arguments.methods else [*table.methods, *variants]
        starts = runnable({name: {**METHODS, **variants}[name] for name in names}, arguments.environments)
        cases = [
            {"problem": problem, "method": method, "seed": seed}
            for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds)
            for problem in (arguments.problems.split(",") if arguments.problems else table.problems)
            for method in starts
        ]
        announce([case for case in cases if not results.has(case)], results.rows)
        if arguments.estimate:
            return
        with threadpool_limits(1):
            fill = functools.partial(measure, starts=starts, evaluations=arguments.evaluations)
            for case in cases:
                results.fill(case, fill)
    write_page(TABLES, results.rows, arguments.output)


if __name__ == "__main__":
    main()
