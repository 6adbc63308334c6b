"""``hypermapper-home DIR``: a folder that programs written for HyperMapper take for HyperMapper's."""

from __future__ import annotations

import sys
from argparse import Namespace, RawDescriptionHelpFormatter
from pathlib import Path
from typing import TYPE_CHECKING, Final

from hypermap_lite.errors import UsageError

if TYPE_CHECKING:
    from argparse import ArgumentParser, _SubParsersAction

EPILOG: Final = """\
examples:
  python -m hypermap_lite hypermapper-home ~/hypermapper_home
  export HYPERMAPPER_HOME=~/hypermapper_home

Clients that start `python3 $HYPERMAPPER_HOME/hypermapper/optimizer.py scenario.json`, or `.../scripts/hypermapper.py`,
then talk to this installation, whatever their python3 is. For those that start `hypermapper scenario.json`, put
$HYPERMAPPER_HOME/bin first on the PATH if that command is not this installation's anyway.
"""

MARK: Final = "# Starts hypermap_lite in place of HyperMapper; written by: python -m hypermap_lite hypermapper-home"

PROGRAM: Final = """\
{first_line}{mark}
import os
import sys

PYTHON = {python!r}
PROGRAM = {program!r}

if __name__ == "__main__":
    sys.stdout.flush()
    os.execv(PYTHON, [PYTHON, "-P", "-c", PROGRAM] + sys.argv[1:])
else:
    from hypermap_lite.optimizer import optimize  # noqa: F401
"""
"""Any Python 3 runs it; it hands over to this installation's interpreter."""

START: Final = (
    "import sys; root = {root!r}; root in sys.path or sys.path.insert(0, root); "
    "from hypermap_lite.cli.hypermapper import main; sys.exit(main())"
)

PLACES: Final = ("hypermapper/optimizer.py", "scripts/hypermapper.py", "bin/hypermapper")
"""What clients start, from the folder."""


def add_parser(subparsers: _SubParsersAction[ArgumentParser]) -> ArgumentParser:
    """Add the subcommand to the command line."""
    parser = subparsers.add_parser(
        "hypermapper-home",
        help="write a folder that clients of HyperMapper can be pointed at",
        description="Write a folder for HYPERMAPPER_HOME, with which clients of HyperMapper start hypermap_lite.",
        epilog=EPILOG,
        formatter_class=RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", metavar="DIR", help="folder to write; created if missing")
    parser.set_defaults(execute=execute)
    return parser


def execute(args: Namespace) -> int:
    """Write the folder named on the command line, and print what to set.

    Raises
    ------
    UsageError
        If a file of another program is in its place.
    """
    folder = Path(args.folder).expanduser().absolute()
    for path in write_home(folder):
        print(path)
    print(f"\nexport HYPERMAPPER_HOME={folder}")
    return 0


def write_home(folder: Path) -> list[Path]:
    """Write the start programs into a folder, over older ones of their kind; return their paths.

    Raises
    ------
    UsageError
        If a file of another program is in the place of one, or the folder cannot be written.
    """
    paths = [folder / place for place in PLACES]
    for path in paths:
        if path.exists() and MARK not in path.read_text(encoding="utf-8", errors="replace"):
            raise UsageError(f"{path}: belongs to another program\n  hint: Name an empty or a new folder.")
    root = str(Path(__file__).parents[2])
    program = START.format(root=root)
    try:
        for path in paths:
            path.parent.mkdir(parents=True, exist_ok=True)
            first_line = f"#!{sys.executable}\n" if path.parent.name == "bin" else ""
            text = PROGRAM.format(first_line=first_line, mark=MARK, python=sys.executable, program=program)
            path.write_text(text, encoding="utf-8")
            path.chmod(0o755)
    except OSError as error:
        raise UsageError(f"{folder}: cannot be written: {error}") from error
    return paths
