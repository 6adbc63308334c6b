"""Kill runs with SIGKILL at random moments, go on with them, and compare with a run that was not killed.

    python -m benchmarks.kill_test

writes ``benchmarks/results/kill_test.md``. Every kill hits the process that was started and nothing else: its workers
have to notice by themselves. The moment is uniform between the first evaluation and the end of the run.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import random
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results" / "kill_test.md"

TIMING_COLUMNS = {"Timestamp", "suggest_seconds", "evaluate_seconds", "seconds"}
"""Differ between any two runs."""

FILES = ("history.csv", "evaluations.csv", "pareto.csv")

BLACK_BOX = """
import os, time
from pathlib import Path

LEDGER = Path(__file__).parent / "ledger"


def evaluate(configuration, seed, trial, replicate):
    note("begin", trial, replicate)
    time.sleep(0.02 + 0.02 * (seed % 3))
    x, y, k = configuration["x"], configuration["y"], configuration["k"]
    noise = (seed % 1000) * 1e-4
    f, g = (x - 0.3) ** 2 + (y - 0.6) ** 2 + 0.1 * k + noise, (x - 0.8) ** 2 + y - 0.05 * k
    note("end", trial, replicate)
    return {"f": f, "g": g, "noise": noise}


def note(event, trial, replicate):
    line = f"{event} {trial} {replicate} {time.monotonic()}\\n".encode()
    descriptor = os.open(LEDGER, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.write(descriptor, line)
    os.close(descriptor)
"""

SCENARIO: Mapping[str, Any] = {
    "application_name": "kill_test",
    "input_parameters": {
        "x": {"parameter_type": "real", "values": [0, 1], "prior": {"type": "gaussian", "mean": 0.4, "std": 0.2}},
        "y": {"parameter_type": "real", "values": [0, 1]},
        "k": {"parameter_type": "integer", "values": [0, 9]},
    },
    "objectives": [{"name": "f"}, {"name": "g"}],
    "budget": {"evaluations": 14, "batch_size": 3},
    "evaluator": {"type": "python", "function": "black_box:evaluate", "replicates": 2, "workers": 1},
}

CASES: Mapping[str, Mapping[str, Any]] = {
    "one objective": {"objectives": [{"name": "f"}], "budget": {"evaluations": 14, "batch_size": 1}},
    "two objectives": {},
    "two workers": {"evaluator": {**SCENARIO["evaluator"], "workers": 2, "replicates": 3}},
}
"""What differs between the kinds of runs that are killed."""

PAGE = """\
# Killed and gone on with

Runs of Bayesian optimization (14 configurations; batches of 1 for one objective, else of 3; 2 replicates, 3 with two
workers) killed with SIGKILL at random moments. The same command goes on; its `history.csv`, `evaluations.csv` and
`pareto.csv` are compared row by row, timing columns aside, with those of a run that was not killed.

{table}

*Unwritten*: calls that had returned in a worker before the kill while their row was still on its way to the file, which
takes one to two milliseconds; they are made again, with the same seed. Calls take 20 to 60 ms here.

Made with `{command}`.
"""

Call = tuple[int, int]
"""Trial and replicate."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kill:
    """What one kill did."""

    kept: int
    """Calls whose row was on the disk."""

    unwritten: int
    """Calls that had returned before the kill, but whose row was not yet written."""

    repeated: int
    """Calls with a row that were made again nevertheless: must be 0."""

    lost: int
    """Rows that are not in the final file as they were: must be 0."""

    differing: int
    """Rows of the final files that are not those of the run that was not killed: must be 0."""


def write_case(folder: Path, case: Mapping[str, Any]) -> Path:
    """Write the scenario and the black box of a case into a new folder, and return the scenario's path."""
    folder.mkdir(parents=True)
    (folder / "black_box.py").write_text(BLACK_BOX)
    scenario = folder / "scenario.json"
    scenario.write_text(json.dumps({**SCENARIO, **case}))
    return scenario


def start(scenario: Path) -> subprocess.Popen[bytes]:
    """Start the run of a scenario, as a user would."""
    command = [sys.executable, "-m", "hypermap_lite", "run", str(scenario), "-q", "--no-plot"]
    command += ["--output-dir", str(scenario.parent / "run")]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL)


def run_to_end(scenario: Path) -> float:
    """Run a scenario to its end; return the time from the first evaluation on [s]."""
    with start(scenario) as process:
        begun = wait_for_first_evaluation(scenario.parent, process)
        if process.wait() != 0:
            raise RuntimeError(f"{scenario}: the run ended with status {process.returncode}")
    return time.monotonic() - begun


def wait_for_first_evaluation(folder: Path, process: subprocess.Popen[bytes]) -> float:
    """Wait until the black box is called, or the run ends without that; return the time."""
    while not (folder / "ledger").exists() and process.poll() is None:
        time.sleep(0.002)
    return time.monotonic()


def kill_after(scenario: Path, delay: float) -> float | None:
    """Run a scenario and kill it some time after its first evaluation; return when, or None if it had ended."""
    with start(scenario) as process:
        wait_for_first_evaluation(scenario.parent, process)
        time.sleep(delay)
        moment = time.monotonic()
        process.send_signal(signal.SIGKILL)
    time.sleep(0.1)  # let the workers notice
    return moment if process.returncode == -signal.SIGKILL else None


def ledger(folder: Path, event: str, until: float = math.inf) -> list[Call]:
    """Return the calls of which the black box noted an event up to some time, in order."""
    path = folder / "ledger"
    lines = path.read_text().splitlines() if path.exists() else []
    notes = [line.split() for line in lines]
    return [(int(t), int(r)) for name, t, r, moment in notes if name == event and float(moment) <= until]


def rows(path: Path) -> list[dict[str, str]]:
    """Return the whole rows of a CSV file without the columns that hold times."""
    if not path.exists():
        return []
    text = path.read_text()
    lines = text[: text.rfind("\n") + 1].splitlines()
    return [{k: v for k, v in row.items() if k not in TIMING_COLUMNS} for row in csv.DictReader(lines)]


def calls(folder: Path) -> dict[Call, dict[str, str]]:
    """Return the rows of a run's ``evaluations.csv`` by call."""
    return {(int(row["trial"]), int(row["replicate"])): row for row in rows(folder / "run" / "evaluations.csv")}


def kill_and_go_on(scenario: Path, delay: float, whole: Path) -> Kill | None:
    """Kill a fresh run, go on with it, and compare; None if it ended before the kill."""
    folder = scenario.parent
    moment = kill_after(scenario, delay)
    if moment is None:
        return None
    kept = calls(folder)
    returned = ledger(folder, "end", until=moment)
    (folder / "ledger").rename(folder / "ledger_before_the_kill")
    run_to_end(scenario)
    final, again = calls(folder), ledger(folder, "begin")
    return Kill(
        kept=len(kept),
        unwritten=len(set(returned) - set(kept)),
        repeated=sum(call in kept for call in again),
        lost=sum(final.get(call) != row for call, row in kept.items()),
        differing=sum(count_differences(folder / "run" / name, whole / "run" / name) for name in FILES),
    )


def count_differences(path: Path, expected: Path) -> int:
    """Return how many rows differ between two CSV files, missing ones included."""
    ours, theirs = rows(path), rows(expected)
    return sum(a != b for a, b in zip(ours, theirs, strict=False)) + abs(len(ours) - len(theirs))


def kill_case(case: Mapping[str, Any], n_kills: int, folder: Path, rng: random.Random) -> list[Kill]:
    """Kill runs of one kind at `n_kills` moments."""
    whole = folder / "whole"
    duration = run_to_end(write_case(whole, case))
    kills: list[Kill] = []
    attempt = 0
    while len(kills) < n_kills:
        scenario = write_case(folder / f"kill_{attempt}", case)
        attempt += 1
        kill = kill_and_go_on(scenario, rng.uniform(0.0, 0.95 * duration), whole)
        if kill is not None:
            kills.append(kill)
    return kills


def report(results: Mapping[str, Sequence[Kill]], command: str) -> str:
    """Return the page of results."""
    head = ["run", "kills", "rows kept (least, most)", "rows lost", "calls made twice", "differing rows", "unwritten"]
    table = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    for name, kills in results.items():
        kept = [kill.kept for kill in kills]
        sums = [sum(getattr(kill, what) for kill in kills) for what in ("lost", "repeated", "differing", "unwritten")]
        table.append(f"| {name} | {len(kills)} | {min(kept)}, {max(kept)} | {' | '.join(map(str, sums))} |")
    return PAGE.format(table="\n".join(table), command=command)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=20, help="kills of each kind of run")
    parser.add_argument("--seed", type=int, default=0, help="seed of the moments")
    args = parser.parse_args()
    rng = random.Random(args.seed)
    results: dict[str, list[Kill]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, case in CASES.items():
            results[name] = kill_case(case, args.kills, Path(folder) / name.replace(" ", "_"), rng)
    text = report(results, shlex.join(["python", "-m", "benchmarks.kill_test", *sys.argv[1:]]))
    RESULTS.parent.mkdir(exist_ok=True)
    RESULTS.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
