"""``pareto RUN --posterior``: the front of a run by the surrogate of its scenario."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from hypermap_lite.errors import RunFolderError, UsageError


def execute(args: argparse.Namespace) -> int:
    """Print the posterior front, and write ``posterior_front.csv`` where the folder can be written.

    Raises
    ------
    UsageError
        If RUN is no run folder, or there are too few evaluations for a model.
    """
    from hypermap_lite.assembly import build_history
    from hypermap_lite.history.files import write_atomically
    from hypermap_lite.history.finishing_order import read_as_learnt
    from hypermap_lite.history.pooling import pooled
    from hypermap_lite.reports import posterior_front
    from hypermap_lite.scenario import load_scenario

    if args.scenario is not None or args.objectives is not None:
        raise UsageError("--posterior needs the scenario.json of a run folder: leave out --scenario and --objectives")
    if args.reference_point:
        raise UsageError("--reference-point has no part in --posterior: leave one of them out")
    folder = Path(args.run)
    folder = folder.parent if folder.name == "history.csv" else folder
    file = folder / "scenario.json"
    if not file.is_file():
        raise UsageError(f"{args.run}: --posterior needs a run folder, and there is no scenario.json in it")
    scenario = load_scenario(file)
    history = build_history(scenario)
    history.extend(read_as_learnt(folder, history, scenario.feasible_output))
    front = posterior_front(scenario, history)
    text = front.as_csv(history.space)
    n, n_completed = len(front.predictions), sum(row.is_completed for row in pooled(history))
    summary = f"{n} configuration{'s' * (n != 1)} on the posterior front, of {n_completed} completed"
    if args.csv or not sys.stdout.isatty():
        print(text, end="")
        print(summary, file=sys.stderr)
    else:
        print(f"{front}\n{summary}")
    try:
        write_atomically(Path(args.output) if args.output is not None else folder / "posterior_front.csv", text)
    except RunFolderError as error:
        print(f"note: {str(error).splitlines()[0]}", file=sys.stderr)
    return 0
