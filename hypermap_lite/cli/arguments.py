"""Arguments that several subcommands share."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hypermap_lite.scenario.model import Scenario


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
    parser.add_argument(
        "--prior-from",
        metavar="RUN",
        help="run folder or CSV file; its non-dominated configurations replace all priors, and the design is drawn "
        "from them",
    )


def load(args: Namespace, overrides: Sequence[str], *, says_notes: bool = True) -> Scenario:
    """Load the scenario that the command line names, and say what that changed of it.

    Raises
    ------
    ScenarioError
        If it cannot be run as written.
    """
    from hypermap_lite.scenario import load_scenario

    scenario = load_scenario(args.scenario, overrides=overrides, prior_from=args.prior_from)
    for note in scenario.notes if says_notes else ():
        print(f"note: {note}", file=sys.stderr)
    return scenario
