"""``check``: validate a scenario, print what it amounts to, and warn of what is probably not meant."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from pathlib import Path
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
    parser.add_argument(
        "--upgrade",
        action="store_true",
        help="print a HyperMapper scenario in our own form; stderr says which keys mean something else, or nothing",
    )
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

    scenario = load(args, args.overrides, says_notes=not args.upgrade)
    try:
        warnings = validate(scenario)
    except ScenarioError as error:
        raise scenario.located(error) from error
    if args.upgrade:
        return _upgrade(args)
    print(json.dumps(scenario.canonical, indent=2, ensure_ascii=False) if args.json else summarize(scenario))
    for warning in [*lint(scenario, build_space(scenario)), *warnings]:
        print(f"warning: {warning}", file=sys.stderr)
    return 0


def _upgrade(args: Namespace) -> int:
    """Print the scenario in our form."""
    from hypermap_lite.scenario.upgrade import upgrade

    result = upgrade(Path(args.scenario), overrides=args.overrides, prior_from=args.prior_from)
    print(result.text, end="" if result.text.endswith("\n") else "\n")
    for note in result.notes:
        print(note, file=sys.stderr)
    if not result.is_needed:
        print("note: the scenario is in our own form already; it is printed as it is", file=sys.stderr)
    return 0
