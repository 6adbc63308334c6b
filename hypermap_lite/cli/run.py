"""``run``: evaluate a scenario to its end, or go on with it where it stopped."""

from __future__ import annotations

import json
import shlex
import sys
from argparse import SUPPRESS, Namespace, RawDescriptionHelpFormatter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from hypermap_lite.cli.arguments import add_scenario, load
from hypermap_lite.errors import ClientError, HypermapLiteError

if TYPE_CHECKING:
    from argparse import ArgumentParser, _SubParsersAction

    from hypermap_lite.evaluation.channel import Channel
    from hypermap_lite.result import Result
    from hypermap_lite.scenario.model import Scenario

EPILOG: Final = """\
The run folder keeps everything: the same command goes on after any stop, and ends as if it had not stopped.
-q, -v and --debug work here as for every command.

examples:
  python -m hypermap_lite run scenario.json --seed 3 --workers 2
  python -m hypermap_lite run scenario.json --set budget.evaluations=30 --output-dir outputs/try1
"""


def add_parser(subparsers: _SubParsersAction[ArgumentParser]) -> None:
    """Add the subcommand to the command line."""
    parser = subparsers.add_parser(
        "run",
        help="run a scenario, or go on with it where it stopped",
        description="Run a scenario, or go on with it where it stopped.",
        epilog=EPILOG,
        formatter_class=RawDescriptionHelpFormatter,
    )
    add_scenario(parser)
    parser.add_argument("--seed", type=int, metavar="N", help="seed, instead of the scenario's")
    parser.add_argument("--workers", type=int, metavar="N", help="evaluations at the same time; results stay the same")
    parser.add_argument("--output-dir", metavar="DIR", help="run folder (default: the scenario's)")
    begin = parser.add_mutually_exclusive_group()
    begin.add_argument(
        "--fresh", action="store_true", help="start anew; an existing run folder is renamed to DIR.bak-N, never deleted"
    )
    begin.add_argument("--as-hypermapper", action="store_true", help=SUPPRESS)
    begin.add_argument(
        "--retry-failed",
        action="store_true",
        help="evaluate the failures at the end of the last session again; its files are kept as *.bak-N",
    )
    parser.add_argument("--no-plot", action="store_true", help="draw no picture at the end")
    parser.set_defaults(execute=execute)


def execute(args: Namespace) -> int:
    """Run the scenario named on the command line, and print what it found.

    Raises
    ------
    HypermapLiteError
        If it cannot be run, or ends without a usable result.
    """
    scenario = load(args, overrides_of(args))
    if not scenario.evaluator.is_client:
        return _run(scenario, args)
    from hypermap_lite.evaluation.channel import standard_channel

    with standard_channel(is_given_back=False) as channel:  # what is printed from now on goes to stderr
        return _run(scenario, args, channel)


def _run(scenario: Scenario, args: Namespace, channel: Channel | None = None) -> int:
    from hypermap_lite.cli.progress import progress
    from hypermap_lite.cli.signals import StoppedAtOnce, StopSignals
    from hypermap_lite.evaluation.runner import StopReason
    from hypermap_lite.run import run_scenario

    signals = StopSignals()
    try:
        with signals, progress(is_quiet=args.quiet, is_verbose=args.verbose) as observer:
            result = run_scenario(
                scenario,
                observer=observer,
                should_stop=lambda: signals.is_requested,
                on_built=lambda: _begin(scenario, args),
                retry_failed=args.retry_failed,
                channel=channel,
            )
    except StoppedAtOnce as stop:
        return _say_how_to_go_on(scenario, args, stop.exit_status)
    except ClientError:
        if not signals.is_requested:
            raise
        return _say_how_to_go_on(scenario, args, 130)  # the same Ctrl-C has stopped the client
    if result.stop_reason is StopReason.INTERRUPTED:
        return _say_how_to_go_on(scenario, args, 130)
    _show(result, scenario, args)
    return 0


def _show(result: Result, scenario: Scenario, args: Namespace) -> None:
    """Print what a run has found and where it is, and draw its picture."""
    from hypermap_lite.result import count_states

    print(f"{scenario.application_name}: {count_states(result)}; the run ended because {result.stop_reason.value}\n")
    with _only_a_note("summary"):
        _print_front(result)
    for report in (result.parameter_importance, result.posterior_best):
        if report is not None:
            print(f"\n{report}")
    files = [result.run_folder / "history.csv", result.run_folder / "pareto.csv"]
    if result.posterior_front is not None:
        files.append(result.run_folder / "posterior_front.csv")
    for path in (*files, *_exports(scenario)):
        print(short(path))
    if not args.no_plot:
        with _only_a_note("picture"):
            _draw(result)


def _exports(scenario: Scenario) -> list[Path]:
    """Return the CSV files besides those of the run folder."""
    return [Path.cwd() / file for file in (scenario.output.samples_file, scenario.output.pareto_file) if file]


def overrides_of(args: Namespace) -> list[str]:
    """Return the scenario changes that the command line asks for; its own options go before ``--set``."""
    named = {"seed": args.seed, "evaluator.workers": args.workers, "output.directory": args.output_dir}
    changes = [f"{key}={json.dumps(value)}" for key, value in named.items() if value is not None]
    return [*changes, *args.overrides]


def command_to_go_on(args: Namespace) -> str:
    """Return the command that goes on with this run."""
    words = ["python", "-m", "hypermap_lite", "run", args.scenario]
    options = {
        "--seed": args.seed,
        "--workers": args.workers,
        "--output-dir": args.output_dir,
        "--prior-from": args.prior_from,
    }
    for option, value in options.items():
        words += [] if value is None else [option, str(value)]
    for change in args.overrides:
        words += ["--set", change]
    return shlex.join(words)


def _begin(scenario: Scenario, args: Namespace) -> None:
    """Set the former run folder aside where a new run is asked for."""
    from hypermap_lite.starting import is_going_on, set_run_folder_aside

    if args.fresh or (args.as_hypermapper and not is_going_on(scenario)):
        kept = set_run_folder_aside(scenario)
        if kept is not None:
            print(f"note: the former run folder is now {kept}", file=sys.stderr)


def _say_how_to_go_on(scenario: Scenario, args: Namespace, exit_status: int) -> int:
    folder = Path(scenario.output.directory)
    print(
        f"stopped; all evaluations that were finished are saved in {folder}. To go on:\n  {command_to_go_on(args)}",
        file=sys.stderr,
    )
    return exit_status


@contextmanager
def _only_a_note(what: str) -> Iterator[None]:
    """Report any failure in a note: the run is finished, and what comes after it must not look like its failure."""
    try:
        yield
    except BrokenPipeError:
        raise
    except Exception as error:
        text = str(error) if isinstance(error, HypermapLiteError) else f"{type(error).__name__}: {error}"
        print(f"note: no {what}: {text}", file=sys.stderr)


def _print_front(result: Result) -> None:
    from hypermap_lite.cli.pareto import describe_front, front_as_table
    from hypermap_lite.plotting.settled import load_settled

    (run,) = load_settled([result.run_folder])
    print(front_as_table(run))
    print(f"\n{describe_front(run)}")


def _draw(result: Result) -> None:
    """Draw the front (one objective: its course) into the run folder, and list the files."""
    from hypermap_lite.plotting import plot_function

    kind = "objectives" if result.best is not None else "pareto"
    for picture in plot_function(kind)([result.run_folder], result.run_folder / kind):
        print(short(picture))


def short(path: Path) -> Path:
    """Return a path as seen from the working directory, if it is below it."""
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path
