"""The command line: one file per subcommand; the only place that prints and sets exit statuses.

`main` turns every error into one message on stderr and an exit status. What takes long to import is imported by the
subcommand that needs it, when it runs.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Final

from hypermap_lite import __version__
from hypermap_lite.cli import check, hypermapper_home, pareto, plot, run, study
from hypermap_lite.cli.streams import WatchedStream, robust_streams
from hypermap_lite.errors import HypermapLiteError, UsageError, nearest

COMMANDS: Final[dict[str, ModuleType]] = {
    "run": run,
    "check": check,
    "pareto": pareto,
    "plot": plot,
    "study": study,
    "hypermapper-home": hypermapper_home,
}
"""Subcommands by name; each module has `add_parser` and `execute`."""

PROGRAM: Final = "python -m hypermap_lite"

DESCRIPTION: Final = "Multi-objective Bayesian optimization with user priors, driven by one scenario file."

EPILOG: Final = """\
A first argument that is no command is a scenario to run.

examples:
  python -m hypermap_lite scenario.json
  python -m hypermap_lite run scenario.json --workers 2 --set budget.evaluations=30

exit status:
  0    done
  1    unexpected error
  2    the scenario, the command line or the run folder is not right
  3    no evaluation gave a usable result
  4    the evaluator keeps failing
  5    the client (evaluator client_server) answers wrongly, too late or not at all; what it answered is saved
  130  stopped by Ctrl-C; what was finished is saved
  143  stopped by SIGTERM; what was finished is saved
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    with robust_streams() as stdout:
        try:
            status = _run(list(sys.argv[1:] if argv is None else argv), stdout)
        finally:
            with contextlib.suppress(OSError):
                stdout.flush()
        if stdout.problem is None or isinstance(stdout.problem, BrokenPipeError):
            return status
        return status or _report(stdout.problem, f"stdout: {stdout.problem.strerror}", 1, is_debugging=False)


def _run(arguments: list[str], stdout: WatchedStream) -> int:
    common, arguments = _common_parser().parse_known_args(arguments)
    if not arguments:
        arguments = ["--help"]
    elif arguments[0] not in COMMANDS and not arguments[0].startswith("-h") and arguments[0] not in _OWN_OPTIONS:
        guess = _misspelt_command(arguments[0])
        if guess:
            print(f"error: '{arguments[0]}' is neither a command nor a scenario file\n  hint: {guess}", file=sys.stderr)
            return UsageError.exit_code
        arguments.insert(0, "run")
    args = _parser().parse_args(arguments, namespace=common)
    try:
        status: int = args.execute(args)
    except HypermapLiteError as error:
        return _report(error, str(error), error.exit_code, is_debugging=args.debug)
    except KeyboardInterrupt as error:
        return _report(error, "interrupted", 130, is_debugging=args.debug)
    except Exception as error:
        if error is stdout.problem:
            return 0 if isinstance(error, BrokenPipeError) else 1  # a reader like `head` may leave early
        message = f"unexpected {type(error).__name__}: {error}\n  hint: --debug shows where; please report it."
        return _report(error, message, 1, is_debugging=args.debug)
    return status


def _misspelt_command(argument: str) -> str:
    """Return a hint if an argument is probably meant to be a command: no file, no path, no option, and close to one."""
    if argument.startswith("-") or Path(argument).exists() or Path(argument).suffix or "/" in argument:
        return ""
    return nearest(argument, COMMANDS)


_OWN_OPTIONS: Final = ("--help", "--version")


def _common_parser() -> argparse.ArgumentParser:
    """Return the options that every command takes, anywhere on the line."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("-q", "--quiet", action="store_true", help="say nothing but warnings and errors on stderr")
    parser.add_argument("-v", "--verbose", action="store_true", help="say more on stderr")
    parser.add_argument("--debug", action="store_true", help="show tracebacks of errors")
    return parser


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        parents=[_common_parser()],
    )
    parser.add_argument("--version", action="version", version=f"hypermap-lite {__version__}")
    subparsers = parser.add_subparsers(metavar="COMMAND", required=True, title="commands")
    for command in COMMANDS.values():
        command.add_parser(subparsers)
    return parser


def _report(error: BaseException, message: str, status: int, *, is_debugging: bool) -> int:
    if is_debugging:
        traceback.print_exception(error, file=sys.stderr)
    print(f"error: {message}", file=sys.stderr)
    return status
