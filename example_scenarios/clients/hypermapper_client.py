"""Let an optimizer that speaks HyperMapper's client-server protocol minimize a function of this program.

    python hypermapper_client.py [COMMAND ...] SCENARIO.json

The command starts the optimizer, and defaults to `python -m hypermap_lite`; with the environment variable
HYPERMAPPER_HOME it defaults to `python3 $HYPERMAPPER_HOME/hypermapper/optimizer.py`. The scenario must say
`"hypermapper_mode": {"mode": "client-server"}` and have the parameters, objectives and feasibility column of the
function: `../hypermapper/chakong_haimes_client_server.json` does. Only the standard library is needed, so that the file
can be copied next to any black box.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import IO

END = "End of HyperMapper"
COLUMNS = ("x1", "x2", "f1", "f2", "Valid")
"""Of an answer: the parameters as they came, then the results."""


def evaluate(x1: float, x2: float) -> tuple[float, float, bool]:
    """Return the two objectives of Chankong and Haimes (1983), and whether both constraints hold."""
    f1 = 2 + (x1 - 2) ** 2 + (x2 - 1) ** 2
    f2 = 9 * x1 - (x2 - 1) ** 2
    return f1, f2, x1**2 + x2**2 <= 225 and x1 - 3 * x2 + 10 <= 0


class ProtocolError(Exception):
    """The optimizer stopped early, or wrote what is no request."""


@dataclass(frozen=True)
class Request:
    """Configurations to evaluate, as text: what is sent back must be what came."""

    names: Sequence[str]
    rows: Sequence[Sequence[str]]


def requests(lines: Iterator[str]) -> Iterator[Request]:
    """Yield the requests among an optimizer's lines until its last; other lines, as warnings, are passed over."""
    for line in lines:
        if END in line:
            return
        if line.startswith("Request "):
            n = int(line.split()[1])
            names = cells(next_line(lines, "the names of the parameters"))
            yield Request(names, [cells(next_line(lines, f"row {i + 1} of {n}")) for i in range(n)])
    raise ProtocolError(f"the optimizer stopped without '{END}'")


def next_line(lines: Iterator[str], what: str) -> str:
    """Return the next line of a request."""
    line = next(lines, None)
    if line is None:
        raise ProtocolError(f"the optimizer stopped before it had written {what}")
    return line


def cells(line: str) -> list[str]:
    """Return the parts of a line of comma-separated values."""
    return [cell.strip() for cell in line.split(",")]


def answer(request: Request) -> Iterable[str]:
    """Evaluate the configurations of a request and yield the lines that answer it."""
    yield ",".join(COLUMNS)
    for row in request.rows:
        values = dict(zip(request.names, row, strict=True))
        f1, f2, is_valid = evaluate(float(values["x1"]), float(values["x2"]))
        yield f"{values['x1']},{values['x2']},{f1!r},{f2!r},{is_valid}"


def serve(optimizer: subprocess.Popen[str]) -> int:
    """Answer all requests of a running optimizer and return how many configurations were evaluated."""
    to_optimizer, from_optimizer = pipes_of(optimizer)
    n = 0
    for request in requests(iter(from_optimizer.readline, "")):
        to_optimizer.writelines(line + "\n" for line in answer(request))
        to_optimizer.flush()
        n += len(request.rows)
    return n


def pipes_of(optimizer: subprocess.Popen[str]) -> tuple[IO[str], IO[str]]:
    """Return where the optimizer reads from and writes to."""
    assert optimizer.stdin is not None
    assert optimizer.stdout is not None
    return optimizer.stdin, optimizer.stdout


def default_command() -> list[str]:
    """Return the command that starts the optimizer if none is given."""
    home = os.environ.get("HYPERMAPPER_HOME")
    return ["python3", f"{home}/hypermapper/optimizer.py"] if home else [sys.executable, "-m", "hypermap_lite"]


def main(arguments: Sequence[str]) -> int:
    """Run the optimizer to its end and return the exit status."""
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    command = [*(arguments[:-1] or default_command()), arguments[-1]]
    try:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as optimizer:
            n = serve(optimizer)
    except (ProtocolError, OSError) as error:
        print(f"{' '.join(command)}: {error}", file=sys.stderr)
        return 1
    print(f"{n} configurations evaluated")
    return optimizer.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
