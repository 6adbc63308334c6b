"""The command ``hypermapper SCENARIO``: what programs written for HyperMapper start.

It differs from ``python -m hypermap_lite run SCENARIO`` in that it begins a new run each time, as HyperMapper does,
says nothing but warnings while it runs, and looks for relative paths where HyperMapper does.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hypermap_lite import cli

HELP: Final = """\
usage: hypermapper SCENARIO

Runs a scenario in place of HyperMapper. With the evaluator client_server (HyperMapper's mode client-server), whoever
started this command answers its requests over stdin and stdout; messages go to stderr.

Every call begins a new run, and the former run folder is renamed to DIR.bak-N. To go on with a run that was stopped:
  python -m hypermap_lite SCENARIO

exit status: as of python -m hypermap_lite; see its --help.
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if len(arguments) != 1 or arguments[0].startswith("-"):
        is_help = arguments in (["--help"], ["-h"])
        print(HELP, end="", file=sys.stdout if is_help else sys.stderr)
        return 0 if is_help else 2
    scenario = find_scenario(arguments[0])
    change_directory()
    return cli.main(["run", str(scenario), "--as-hypermapper", "--no-plot", "--quiet"])


def find_scenario(name: str) -> Path:
    """Return the place of a scenario file: from the working directory, else from ``HYPERMAPPER_HOME``."""
    places = [Path(folder, name) for folder in (Path.cwd(), os.environ.get("HYPERMAPPER_HOME")) if folder]
    return next((place for place in places if place.exists()), places[0]).absolute()


def change_directory() -> None:
    """Go to the folder that ``PWD`` names, as HyperMapper does where ``HYPERMAPPER_HOME`` is set."""
    folder = os.environ.get("PWD", "")
    if os.environ.get("HYPERMAPPER_HOME") and os.path.isdir(folder):
        os.chdir(folder)


if __name__ == "__main__":
    sys.exit(main())
