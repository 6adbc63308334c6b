"""Small studies: their files, and run folders as their runs would leave them."""

import csv
import json
import os
import time

from hypermap_lite.cli.pareto import front_as_csv
from hypermap_lite.evaluation.sessions import members
from hypermap_lite.plotting.runs import load_run
from hypermap_lite.study import load_study
from tests.cli.scenarios import write_scenario
from tests.plotting.run_folders import write_run

A = {"scenario": "scenario.json"}
TWO = {"a": A, "b": {**A, "set": {"acquisition.type": "thompson_sampling"}}}
"""Two variants of one scenario; the second changes what random search does not use, so their rows are equal."""

TIMING = {"Timestamp", "suggest_seconds", "evaluate_seconds", "seconds"}
"""Columns that differ between any two runs."""

WAITING = """

def wait_alive(configuration, trial):
    import os
    (HERE / f"alive_{os.getppid()}_{os.getpid()}").write_text("")
    return wait_for_a_file(configuration, trial)
"""
"""Notes who calls the black box (the job and its worker), and waits at trial 2 until there is a file `go`."""


def write_study(folder, *, variants=TWO, scenario=None, **keys):
    """Write a study of random search with four evaluations a run, its scenario and black box; return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    sections = {"budget": {"evaluations": 4, "batch_size": 2}, **(scenario or {})}
    write_scenario(folder, **sections)
    for module in folder.glob("black_box_*.py"):
        module.write_text(module.read_text() + WAITING)
    file = folder / "study.json"
    content = {"name": "demo", "variants": variants, "repetitions": 2, "output": str(folder / "out"), **keys}
    file.write_text(json.dumps(content))
    return file


def write_runs(study, *, n_design=0, calls=None, **values):
    """Write finished runs of a study, as `values` says by variant: objective values of each repetition, None for none.

    `calls` has the rows of evaluations.csv by variant, for all its repetitions, the header first.
    """
    for run in study.runs():
        Y = values[run.variant.name][run.seed - study.first_seed]
        if Y is None:
            continue
        objectives = run.canonical["objectives"]
        write_run(run.folder, Y, objectives=objectives, n_design=n_design)
        (run.folder / "scenario.json").write_text(json.dumps(run.canonical))
        (run.folder / "pareto.csv").write_text(front_as_csv(load_run(run.folder)))
        if calls:
            lines = [",".join(map(str, line)) for line in calls[run.variant.name]]
            (run.folder / "evaluations.csv").write_text("\n".join(lines) + "\n")


def loaded(folder, **keys):
    """Write a study and load it."""
    return load_study(write_study(folder, **keys))


def table(file):
    """Return the rows of a CSV file."""
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream))


def rows(run_folder):
    """Return what a run found and when in its course, without the times."""
    return [
        [{k: v for k, v in row.items() if k not in TIMING} for row in table(run_folder / name)]
        for name in ("history.csv", "evaluations.csv", "pareto.csv")
    ]


def sessions_of(folder):
    """Return the process ids of the jobs and workers that have called the black box `wait_alive`."""
    return {int(pid) for file in folder.glob("alive_*") for pid in file.name.split("_")[1:]}


def wait_until(condition, seconds=30.0):
    """Wait for a condition, and fail if it does not come."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)


def is_gone(session):
    """Tell whether nothing runs any more in the session of a job or a worker."""
    return not members(session) and session != os.getpid()
