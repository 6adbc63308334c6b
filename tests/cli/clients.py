"""A scripted client: starts the optimizer, answers its requests, and notes every byte it hears."""

from __future__ import annotations

import contextlib
import csv
import json
import logging
import os
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

import hypermap_lite.plotting.runs  # the copies of this process need not import it, and what it needs, again
import hypermap_lite.run  # noqa: F401
from hypermap_lite.cli import main
from hypermap_lite.scenario.schemas import validator

validator()  # is kept, and takes its time

REPOSITORY = Path(__file__).parents[2]

SCENARIO: dict[str, Any] = {
    "application_name": "served",
    "input_parameters": {
        "x": {"parameter_type": "real", "values": [-2, 2], "parameter_default": 0},
        "n": {"parameter_type": "integer", "values": [0, 9], "parameter_default": 3},
        "o": {"parameter_type": "ordinal", "values": [0.5, 1, 2], "parameter_default": 1},
        "c": {"parameter_type": "categorical", "values": ["red", "green"], "parameter_default": "green"},
    },
    "objectives": [{"name": "f"}, {"name": "g"}],
    "design_of_experiment": {"number_of_samples": 4},
    "budget": {"evaluations": 7},
    "optimizer": "random_search",
    "evaluator": "client_server",
}

Row = Mapping[str, str]
Reply = Callable[[int, Sequence[Row]], str]
"""From the number of a request and its rows to the text of the reply; '' closes the client's output."""


def write_scenario(folder: Path, **sections: Any) -> Path:
    """Write the scenario with some sections replaced."""
    path = folder / "scenario.json"
    content = SCENARIO | {"output": {"directory": str(folder / "run")}} | sections
    path.write_text(json.dumps(content))
    return path


def value(row: Row) -> dict[str, str]:
    """Return the objectives of a row, as texts."""
    x, n = float(row["x"]), int(row["n"])
    return {"f": repr(x**2 + n), "g": repr((x - 1) ** 2 - n * float(row["o"]) + len(row["c"]))}


def table(rows: Sequence[Row], columns: Sequence[str]) -> str:
    """Return rows as the text of a reply."""
    lines = [",".join(columns), *(",".join(row[name] for name in columns) for row in rows)]
    return "".join(f"{line}\n" for line in lines)


def good(number: int, rows: Sequence[Row]) -> str:
    """Answer as HyperMapper's own clients do."""
    return table([{**row, **value(row)} for row in rows], [*rows[0], "f", "g"])


MODULE = (sys.executable, "-m", "hypermap_lite")
"""The command that starts the optimizer in an interpreter of its own."""


class Conversation:
    """What was said in one run: requests as rows, all that was heard, and how it ended."""

    def __init__(self) -> None:
        self.heard = b""
        self.requests: list[list[Row]] = []
        self.stderr = ""
        self.status: int | None = None


def environment(**more: str) -> dict[str, str]:
    """Return an environment in which this checkout is imported."""
    return os.environ | {"PYTHONPATH": str(REPOSITORY)} | more


class Forked:
    """The command line in a copy of this process: a child like any other, without the time a new interpreter takes."""

    def __init__(self, arguments: Sequence[str], folder: Path, stderr: int) -> None:
        inbox, to_child = os.pipe()
        from_child, outbox = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that threads, of which there are some in numerical libraries, stay behind
            self.pid = os.fork()
        if self.pid == 0:
            _become([inbox, outbox, stderr], [to_child, from_child], arguments, folder)
        os.close(inbox)
        os.close(outbox)
        self.stdin, self.stdout = os.fdopen(to_child, "wb"), os.fdopen(from_child, "rb")
        self.returncode: int | None = None

    def __enter__(self) -> Forked:
        return self

    def __exit__(self, *error: object) -> None:
        with contextlib.suppress(OSError):
            self.stdin.close()
        self.stdout.close()
        self.returncode = os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])

    def kill(self) -> None:
        os.kill(self.pid, signal.SIGKILL)


def _become(streams: Sequence[int], others: Sequence[int], arguments: Sequence[str], folder: Path) -> NoReturn:
    status = 70
    try:
        for descriptor in others:
            os.close(descriptor)
        for target, descriptor in enumerate(streams):
            os.dup2(descriptor, target)
        sys.stdin, sys.stdout, sys.stderr = open(0), open(1, "w"), open(2, "w", buffering=1)  # noqa: SIM115
        logging.getLogger().handlers.clear()
        os.chdir(folder)
        status = main(arguments)
        sys.stdout.flush()
    finally:
        os._exit(status)


def converse(
    scenario: Path,
    reply: Reply = good,
    *,
    command: Sequence[str] | None = None,
    options: Sequence[str] = ("--no-plot",),
    until: int | None = None,
    **popen: Any,
) -> Conversation:
    """Start the optimizer on a scenario and answer it to the end, or kill it at the request of a number.

    It is started as a copy of this process, or by a command.
    """
    said = Conversation()
    with (scenario.parent / "stderr.txt").open("w") as stderr:
        process: Any
        if command is None:
            process = Forked([str(scenario), *options], scenario.parent, stderr.fileno())
        else:
            popen = {"env": environment(), "cwd": scenario.parent} | popen
            arguments = [*command, str(scenario), *options]
            process = subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=stderr, **popen)
        with process:
            _talk(process, said, reply, until)
    said.status = process.returncode
    said.stderr = (scenario.parent / "stderr.txt").read_text()
    return said


def _talk(process: Any, said: Conversation, reply: Reply, until: int | None) -> None:
    while line := _hear(process, said):
        if not line.startswith("Request "):
            continue
        names = _hear(process, said).split(",")
        rows = [dict(zip(names, _hear(process, said).split(","), strict=True)) for _ in range(int(line.split()[1]))]
        number = len(said.requests)
        said.requests.append(rows)
        if number == until:
            process.kill()
            return
        text = reply(number, rows)
        if text:
            process.stdin.write(text.encode())
            process.stdin.flush()
        else:
            process.stdin.close()


def _hear(process: Any, said: Conversation) -> str:
    line = process.stdout.readline()
    said.heard += line
    return line.decode().rstrip("\n")


def history(folder: Path, name: str = "history.csv") -> list[dict[str, str]]:
    """Return the rows of a run's file without the columns that hold times."""
    if not (folder / name).exists():
        return []
    times = {"Timestamp", "suggest_seconds", "evaluate_seconds", "seconds"}
    with (folder / name).open(newline="") as file:
        return [{k: v for k, v in row.items() if k not in times} for row in csv.DictReader(file)]
