"""``study``: variants of an experiment, each run several times, and compared."""

from __future__ import annotations

import os
import shlex
import sys
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from typing import TYPE_CHECKING, Final

from hypermap_lite.cli.run import short
from hypermap_lite.errors import HypermapLiteError, ScenarioError, UsageError

if TYPE_CHECKING:
    from argparse import _SubParsersAction

    from hypermap_lite.study import Study
    from hypermap_lite.study.progress import Failure
    from hypermap_lite.study.summary import Summary

EPILOG: Final = """\
The folder of the study keeps everything: the same command goes on after any stop, makes the runs that are missing, and
writes summary.csv, averages.csv, comparison.csv, union_front.csv and the figures anew. The runs are run folders like
any other, in runs/VARIANT/SEED. Results do not depend on the number of workers.

examples:
  python -m hypermap_lite study study.json --quick
  python -m hypermap_lite study study.json --workers 4
  python -m hypermap_lite study study.json --summarize
"""

PICTURES: Final = ("hypervolume", "attainment")
"""Kinds of pictures that are drawn of a study with two objectives."""


def add_parser(subparsers: _SubParsersAction[ArgumentParser]) -> None:
    """Add the subcommand to the command line."""
    parser = subparsers.add_parser(
        "study",
        help="run variants of an experiment several times each, and compare them",
        description="Run variants of an experiment several times each, and compare them.",
        epilog=EPILOG,
        formatter_class=RawDescriptionHelpFormatter,
    )
    parser.add_argument("study", metavar="STUDY", help="study file (JSON)")
    parser.add_argument("--quick", action="store_true", help="the study's quick form, in a folder of its own")
    parser.add_argument(
        "--workers", type=int, metavar="N", help="runs at the same time (default: the number of processor cores)"
    )
    parser.add_argument("--repetitions", type=int, metavar="N", help="runs per variant, instead of the study's")
    parser.add_argument(
        "--only",
        action="append",
        default=[],
        metavar="VARIANT",
        help="this one and the baseline alone, in runs and tables; repeatable",
    )
    parser.add_argument("--output-dir", metavar="DIR", help="folder of the study (default: the study's)")
    parser.add_argument(
        "--set",
        dest="overrides",
        action="append",
        default=[],
        metavar="KEY.PATH=VALUE",
        help="change one value in the scenarios of all variants; may be repeated",
    )
    parser.add_argument("--summarize", action="store_true", help="run nothing; tables and figures of what is finished")
    parser.add_argument("--no-plot", action="store_true", help="draw no pictures at the end")
    parser.set_defaults(execute=execute)


def execute(args: Namespace) -> int:
    """Make the runs that are missing, and print how the variants compare.

    Raises
    ------
    HypermapLiteError
        If the study cannot be run, or there is nothing to compare though no run failed.
    """
    from hypermap_lite.cli.study_table import describe
    from hypermap_lite.study import load_study, summarize, write_tables

    study = load_study(
        args.study,
        is_quick=args.quick,
        repetitions=_at_least_one("--repetitions", args.repetitions),
        only=args.only,
        overrides=args.overrides,
        output=args.output_dir,
    )
    failures: list[Failure] = []
    if not args.summarize:
        status, failures = _run(study, args)
        if status:
            return status
    try:
        summary = summarize(study)
    except HypermapLiteError as error:
        if not failures:
            if isinstance(error, ScenarioError):
                raise error.within(args.study) from None
            raise
        print(f"note: no tables: {error}", file=sys.stderr)
        return _report_failures(failures)
    print(describe(summary))
    for table in write_tables(summary):
        print(short(table))
    if not args.no_plot:
        _draw(summary)
    return _report_failures(failures) if failures else 0


def _run(study: Study, args: Namespace) -> tuple[int, list[Failure]]:
    """Make the missing runs; return an exit status other than zero if it was stopped, and the runs that failed."""
    from hypermap_lite.cli.signals import StoppedAtOnce, StopSignals
    from hypermap_lite.cli.study_progress import study_progress
    from hypermap_lite.study import run_study

    workers = _at_least_one("--workers", args.workers) or available_cores()
    status = 0
    failures: list[Failure] = []
    try:
        with StopSignals() as signals, study_progress(is_quiet=args.quiet) as observer:
            failures = run_study(study, workers=workers, observer=observer, should_stop=lambda: signals.is_requested)
            status = 130 if signals.is_requested else 0
    except StoppedAtOnce as stop:
        status = stop.exit_status
    if status:
        print(
            f"stopped; all evaluations that were finished are saved in {study.folder}. To go on:\n"
            f"  {command_to_go_on(args)}",
            file=sys.stderr,
        )
    return status, failures


def available_cores() -> int:
    """Return the number of processor cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def command_to_go_on(args: Namespace) -> str:
    """Return the command that goes on with this study."""
    words = ["python", "-m", "hypermap_lite", "study", args.study]
    words += ["--quick"] if args.quick else []
    options = {"--workers": args.workers, "--repetitions": args.repetitions, "--output-dir": args.output_dir}
    for option, value in options.items():
        words += [] if value is None else [option, str(value)]
    for name in args.only:
        words += ["--only", name]
    for change in args.overrides:
        words += ["--set", change]
    words += ["--no-plot"] if args.no_plot else []
    return shlex.join(words)


def _at_least_one(option: str, number: int | None) -> int | None:
    if number is not None and number < 1:
        raise UsageError(f"{option} {number}: expected a number >= 1")
    return number


def _report_failures(failures: list[Failure]) -> int:
    """Say on stderr which runs failed, and why the first did; return the exit status."""
    names = ", ".join(str(failure.run) for failure in failures[:8])
    more = f" and {len(failures) - 8} more" if len(failures) > 8 else ""
    print(
        f"error: {len(failures)} run{'s' * (len(failures) != 1)} failed: {names}{more}\n"
        f"  {failures[0].run}: {_without_hints(failures[0].message)}\n"
        "  hint: The same command tries them again.",
        file=sys.stderr,
    )
    statuses = {failure.exit_status for failure in failures}
    return max(statuses & {2, 3, 4}, default=1)  # others are crashes


def _without_hints(message: str) -> str:
    """Leave out what to do about a run of its own."""
    return "\n".join(line for line in message.splitlines() if not line.startswith("  hint: "))


def _draw(summary: Summary) -> None:
    """Draw the figures of a study into its folder, and list the files."""
    from hypermap_lite.plotting import plot_function

    repetitions = [(r.run.folder, c.variant.label) for c in summary.comparisons for r in c.repetitions]
    folders, labels = [folder for folder, _ in repetitions], [label for _, label in repetitions]
    kinds = PICTURES if len(summary.study.objectives) == 2 else ("hypervolume",)
    if summary.reference_point is None:
        kinds = ("objectives",)
    for kind in kinds:
        try:
            files = plot_function(kind)(folders, summary.study.folder / kind, labels=labels, title=summary.study.name)
        except BrokenPipeError:
            raise
        except Exception as error:  # the tables are written, and what comes after them must not look like their failure
            text = str(error) if isinstance(error, HypermapLiteError) else f"{type(error).__name__}: {error}"
            print(f"note: no picture of kind {kind}: {text}", file=sys.stderr)
            continue
        for file in files:
            print(short(file))
