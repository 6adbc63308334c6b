"""``pareto RUN``: the front of a history, recomputed."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from hypermap_lite.cli.plot import add_reference_point_option, parse_reference_point
from hypermap_lite.cli.samples import add_options, as_sources, meaning_of
from hypermap_lite.errors import RunFolderError, UsageError

if TYPE_CHECKING:
    from hypermap_lite.plotting.runs import Run

    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

EPILOG: Final = """\
examples:
  python -m hypermap_lite pareto outputs/branin
  python -m hypermap_lite pareto outputs/branin --csv > front.csv
  python -m hypermap_lite pareto outputs/branin --posterior
  python -m hypermap_lite pareto branin_output_samples.csv --objectives Value,Energy

The front is also written to pareto.csv in the run folder, if that can be written. As CSV it goes to stdout and the
hypervolume to stderr. With --posterior the surrogate of the run's scenario is fitted to the history: the evaluated
configurations whose means no other dominates are printed, and written to posterior_front.csv.
A CSV file without a run folder needs --scenario or --objectives; its front goes to a file beside it that is called
pareto where it is called samples.
"""


def add_parser(subparsers: Subparsers) -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser(
        "pareto",
        help="recompute the Pareto front of a run",
        description="Recompute the Pareto front of a run from its history.csv, print it, and measure its hypervolume.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("run", metavar="RUN", help="run folder or its history.csv, or a samples file")
    add_options(parser)
    parser.add_argument("--output", "-o", metavar="FILE", help="where the front is written, instead")
    add_reference_point_option(parser)
    parser.add_argument(
        "--posterior",
        action="store_true",
        help="the front by the means of the scenario's surrogate instead, which noise does not flatter",
    )
    parser.add_argument("--csv", action="store_true", help="print CSV (the default unless stdout is a terminal)")
    parser.set_defaults(execute=execute)


def execute(args: argparse.Namespace) -> int:
    """Print the front and its hypervolume, and write ``pareto.csv`` where the folder can be written."""
    if args.posterior:
        from hypermap_lite.cli import posterior

        return posterior.execute(args)
    from hypermap_lite.history.files import write_atomically
    from hypermap_lite.plotting.settled import load_settled

    sources, _ = as_sources([Path(args.run)], None, meaning_of(args))
    if len(sources) != 1:
        raise UsageError(f"{args.run}: holds {len(sources)} CSV files; name one of them")
    (run,) = load_settled(sources)
    summary = describe_front(run, parse_reference_point(args.reference_point))
    text = front_as_csv(run)
    if args.csv or not sys.stdout.isatty():
        print(text, end="")
        print(summary, file=sys.stderr)
    else:
        print(front_as_table(run))
        print(summary)
    try:
        write_atomically(Path(args.output) if args.output is not None else front_file(run), text)
    except RunFolderError as error:
        print(f"note: {str(error).splitlines()[0]}", file=sys.stderr)
    return 0


def front_file(run: Run) -> Path:
    """Return where the front of a run is written; never the file it was read from."""
    if run.samples is None:
        return run.folder / "pareto.csv"
    stem = run.samples.stem
    renamed = stem[: -len("samples")] + "pareto" if stem.endswith("samples") else f"{stem}_pareto"
    return run.samples.with_name(f"{renamed}.csv")


def front_as_csv(run: Run) -> str:
    """Return the rows of the history that are on the front, with its header, as CSV."""
    from hypermap_lite.history.csv_format import format_record

    rows = _front_rows(run)
    return "".join(format_record(fields) for fields in [run.columns, *([row[c] for c in run.columns] for row in rows)])


def front_as_table(run: Run) -> str:
    """Return the front for people: trial, objectives with standard errors, and parameters, best first.

    Rows are in the order of the first objective, best first; numbers have four significant digits.
    """
    names = [objective.name for objective in run.objectives]
    parameters = list(run.scenario.get("input_parameters") or run.columns[: run.columns.index(names[0])])
    first = run.objectives[0]
    rows = sorted(_front_rows(run), key=lambda row: first.sign * float(row[first.name]))
    counter = ["trial"] if "trial" in run.columns else []
    header = [*counter, *(f"{o.name} ({o.goal.value})" for o in run.objectives), *parameters]
    lines = [
        [
            *(row[c] for c in counter),
            *(_with_error(row, name) for name in names),
            *(_shorten(row[p]) for p in parameters),
        ]
        for row in rows
    ]
    return align([header, *lines])


def describe_front(run: Run, reference_point: Mapping[str, float] | None = None) -> str:
    """Return one line on the front: its size and, with several objectives, its hypervolume."""
    from hypermap_lite.objectives import to_minimization
    from hypermap_lite.pareto import hypervolume
    from hypermap_lite.plotting.reference import common_reference_point

    n_front, n_completed = int(run.is_front.sum()), int(run.is_completed.sum())
    size = f"{n_front} of {n_completed} completed configurations on the front"
    if len(run.objectives) == 1 and not reference_point:
        return size
    reference = common_reference_point([run], reference_point)
    volume = hypervolume(run.Y, to_minimization(run.objectives, reference.values))
    measured = f"hypervolume {volume:.6g}" if math.isfinite(volume) else "hypervolume not available: beyond all floats"
    return f"{size}; {measured} ({reference})"


def _front_rows(run: Run) -> list[Mapping[str, str]]:
    return [row for row, is_front in zip(run.rows, run.is_front, strict=True) if is_front]


def _with_error(row: Mapping[str, str], name: str) -> str:
    """Return a value with its standard error, if there is one."""
    from hypermap_lite.plotting.reference import number

    error = row.get(f"{name}_sem", "")
    return f"{_shorten(row[name])} ± {number(float(error), 2)}" if error else _shorten(row[name])


def _shorten(text: str) -> str:
    """Return a number with four significant digits, any other text as it is."""
    from hypermap_lite.plotting.reference import number

    try:
        return number(float(text))
    except ValueError:
        return text


def align(lines: Sequence[Sequence[str]]) -> str:
    """Return lines of cells as text with right-aligned columns."""
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join("  ".join(cell.rjust(w) for cell, w in zip(line, widths, strict=True)) for line in lines)
