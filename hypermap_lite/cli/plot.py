"""``plot KIND RUN...``: pictures of one or several runs."""

from __future__ import annotations

import argparse
import glob
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from hypermap_lite.cli.samples import add_options, as_sources, meaning_of
from hypermap_lite.errors import UsageError

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

KINDS: Final = {
    "pareto": "the evaluations and the front, a panel per pair of objectives",
    "hypervolume": "hypervolume against evaluations; repetitions as mean with standard-error band",
    "objectives": "each objective against evaluations, with the best so far and the failures",
    "attainment": "for two objectives, the median front of repetitions, with a band from 25 % to 75 % of them",
    "parameters": "the front in parallel coordinates, an axis per parameter and per objective",
    "prior": "the prior on two parameters; RUN may be a scenario file",
    "regret": "for one objective, the distance of the best so far from the optimum; mean and standard-error band",
    "hypervolume_gap": "share of the hypervolume of all runs together that is missing; mean and standard-error band",
}
"""What `hypermap_lite.plotting.KINDS` draws, in the words of the help."""

EPILOG: Final = """\
kinds:
{kinds}

examples:
  python -m hypermap_lite plot pareto outputs/branin
  python -m hypermap_lite plot hypervolume outputs/with_prior outputs/no_prior --labels "operator prior,no prior"
  python -m hypermap_lite plot prior my_scenario.json --parameters speed,stiffness
  python -m hypermap_lite plot hypervolume "operator prior=outputs/op_*" "no prior=outputs/no_*" --output figure.pdf
  python -m hypermap_lite plot attainment outputs/studies/peg_insertion
  python -m hypermap_lite plot prior example_scenarios/robot/peg_insertion/operator_prior.json --parameters Force,Radius
  python -m hypermap_lite plot pareto forest_output_samples.csv gp_output_samples.csv --objectives Value,Energy
  python -m hypermap_lite plot regret "forest=rf/*.csv" "process=gp/*.csv" --scenario branin.json --minimum 0.3979 --log

Each picture becomes a PNG and a PDF (or the one that --output names), in the folder of the run or study if there is
one and in the working directory if there are several. The files written are listed on stdout.
"""


def add_parser(subparsers: Subparsers) -> None:
    """Add the subcommand."""
    parser = subparsers.add_parser(
        "plot",
        help="draw pictures of one or several runs",
        description="Draw a picture of one or several runs from their history.csv.",
        epilog=EPILOG.format(kinds="\n".join(f"  {name:<17}{text}" for name, text in KINDS.items())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("kind", metavar="KIND", choices=list(KINDS), help=f"one of {', '.join(KINDS)}")
    parser.add_argument(
        "runs",
        metavar="RUN",
        nargs="+",
        help="run folder or its history.csv, or the folder of a study; 'LABEL=PATTERN' makes all folders that match "
        "repetitions of one label; with --scenario or --objectives, also a CSV file or a folder of them",
    )
    parser.add_argument("--labels", metavar="A,B", help="names for the legend, one per RUN, separated by commas")
    parser.add_argument("--output", "-o", metavar="FILE", help="FILE.png, FILE.pdf, or FILE without ending for both")
    parser.add_argument("--title", help="text above the picture (default: the application's name; '' for none)")
    add_reference_point_option(parser)
    parser.add_argument(
        "--parameters",
        metavar="A,B",
        help="parameters to show, separated by commas: two for prior (default: the first that have one), any for "
        "parameters (default: all)",
    )
    add_options(parser)
    parser.add_argument(
        "--optimum",
        "--minimum",
        type=float,
        metavar="FLOAT",
        help="best possible value, for regret (default: the best of all runs)",
    )
    parser.add_argument("--log", action="store_true", help="logarithmic axis, for regret and hypervolume_gap")
    parser.add_argument(
        "--against", choices=["evaluations", "time"], help="horizontal axis of hypervolume_gap (default: evaluations)"
    )
    parser.add_argument(
        "--csv", action="store_true", help="write the numbers drawn beside the picture, as FILE_data.csv"
    )
    parser.set_defaults(execute=execute)


def add_reference_point_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that overrides the scenario's reference point."""
    parser.add_argument(
        "--reference-point",
        metavar="OBJECTIVE=VALUE",
        action="append",
        default=[],
        help="worst value that still counts for the hypervolume (default: the scenario's, else inferred); repeatable",
    )


def execute(args: argparse.Namespace) -> int:
    """Draw the picture and list its files on stdout."""
    from hypermap_lite.plotting import plot_function

    names = [name.strip() for name in args.parameters.split(",")] if args.parameters is not None else None
    folders, labels = expand_runs(args.runs, args.labels.split(",") if args.labels is not None else None)
    given = {"optimum": args.optimum, "log": args.log or None, "against": args.against}
    options = {name: value for name, value in given.items() if value is not None}
    sources, labels = as_sources(folders, labels, meaning_of(args))
    files = plot_function(args.kind, parameters=names, options=options)(
        sources,
        args.output or _beside_study(args.runs, args.kind),
        labels=labels,
        title=args.title,
        reference_point=parse_reference_point(args.reference_point),
        data=args.csv,
    )
    for file in files:
        print(file)
    return 0


def _beside_study(arguments: Sequence[str], kind: str) -> Path | None:
    """Return where a picture of one study goes: into its folder."""
    from hypermap_lite.study.folder import is_study

    return Path(arguments[0]) / kind if len(arguments) == 1 and is_study(Path(arguments[0])) else None


def expand_runs(arguments: Sequence[str], labels: Sequence[str] | None) -> tuple[list[Path], list[str] | None]:
    """Resolve run arguments, of which some may be ``label=pattern``, to folders and their labels.

    Parameters
    ----------
    arguments
        Folders, glob patterns, or either after a label and an equals sign. The folder of a study stands for its
        finished runs under the labels of their variants, after the name of the study if there are other arguments.
    labels
        From ``--labels``, one per argument.

    Returns
    -------
    folders
        One or more per argument, those of a pattern in alphabetical order.
    labels
        One per folder; None if nobody gave one.

    Raises
    ------
    UsageError
        If a pattern matches nothing, or the number of labels is not that of the arguments.
    """
    if labels is not None and len(labels) != len(arguments):
        raise UsageError(f"--labels names {len(labels)} runs, but {len(arguments)} are given: one label per RUN")
    folders: list[Path] = []
    names: list[str | None] = []
    for i, argument in enumerate(arguments):
        label, pattern = _split_label(argument)
        label = labels[i].strip() if labels is not None else label
        matches = _matches(pattern)
        for own, found in _runs_in(matches, has_others=len(arguments) > 1 or len(matches) > 1):
            folders.append(found)
            names.append(f"{label}: {own}" if own and label else own or label)
    if all(name is None for name in names):
        return folders, None
    return folders, [str(folder) if name is None else name for folder, name in zip(folders, names, strict=True)]


def parse_reference_point(arguments: Sequence[str]) -> dict[str, float]:
    """Turn ``objective=value`` options into values by objective.

    Raises
    ------
    UsageError
        If one of them has another form.
    """
    values: dict[str, float] = {}
    for argument in arguments:
        name, _, text = argument.rpartition("=")
        try:
            values[name] = float(text)
        except ValueError:
            name = ""
        if not name:
            raise UsageError(f"--reference-point {argument}: expected OBJECTIVE=VALUE, as in safety=-3000")
    return values


def _split_label(argument: str) -> tuple[str | None, str]:
    """Return the label, if any, and the pattern of a run argument; a folder may have '=' in its name."""
    if "=" in argument and not Path(argument).exists() and not glob.glob(argument):
        label, _, pattern = argument.partition("=")
        return label.strip(), pattern
    return None, argument


def _runs_in(folders: Sequence[Path], *, has_others: bool) -> Iterator[tuple[str | None, Path]]:
    """Yield the run folders among some folders, and those in the studies among them with their labels."""
    from hypermap_lite.study.folder import is_study, labelled_runs

    for folder in folders:
        if not is_study(folder):
            yield None, folder
            continue
        for label, run in labelled_runs(folder):
            yield f"{folder.name}: {label}" if has_others else label, run


def _matches(pattern: str) -> list[Path]:
    """Return the folders a pattern stands for; a path without wildcards stands for itself, found or not."""
    if Path(pattern).exists() or not glob.has_magic(pattern):
        return [Path(pattern)]
    matches = sorted(map(Path, glob.glob(pattern)))
    found = [path for path in matches if path.is_dir() or path.suffix == ".csv"]
    if not found:
        raise UsageError(f"no run folder matches '{pattern}'")
    return found
