"""Arguments that several subcommands share."""

from __future__ import annotations

from argparse import ArgumentParser


def add_scenario(parser: ArgumentParser) -> None:
    """Add the scenario file and the changes made to it on the command line."""
    parser.add_argument("scenario", help="scenario file (JSON)")
    parser.add_argument(
        "--set",
        dest="overrides",
        action="append",
        default=[],
        metavar="KEY.PATH=VALUE",
        help="change one value, as in budget.evaluations=30; may be repeated",
    )
