"""``check``: validate a scenario, print what it amounts to, and warn of what is probably not meant."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from typing import TYPE_CHECKING

from hypermap_lite.cli.arguments import add_scenario, load

if TYPE_CHECKING:
    from argparse import ArgumentParser, _SubParsersAction


def add_parser(subparsers: _SubParsersAction[ArgumentParser]) -> ArgumentParser:
    """Add the subcommand to the command line."""
    parser = subparsers.add_parser(
        "check",
        help="validate a scenario without evaluating anything",
        description="Validate a scenario, print the effective one with every default filled in, and warn of what is "
        "probably not meant. Nothing is evaluated.",
    )
    add_scenario(parser)
    parser.add_argument("--json", action="store_true", help="print the effective scenario as JSON")
    parser.set_defaults(execute=execute)
    return parser


def execute(args: Namespace) -> int:
    """Check the scenario named on the command line.

    Raises
    ------
    ScenarioError
        If it cannot be run as written.
    """
    from hypermap_lite.assembly import build_space, validate
    from hypermap_lite.errors import ScenarioError
    from hypermap_lite.scenario.lint import lint
    from hypermap_lite.scenario.summary import summarize

    scenario = load(args, args.overrides)
    try:
        warnings = validate(scenario)
    except ScenarioError as error:
        raise error.within(scenario.origin_of(error.path)) from error
    print(json.dumps(scenario.canonical, indent=2, ensure_ascii=False) if args.json else summarize(scenario))
    for warning in [*lint(scenario, build_space(scenario)), *warnings]:
        print(f"warning: {warning}", file=sys.stderr)
    return 0
