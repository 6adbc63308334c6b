"""Warnings about commands that can be started, or so it seems, and still cannot work."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from hypermap_lite.evaluation.placeholders import placeholders_in
from hypermap_lite.scenario.model import Scenario

PATH = "$.evaluator.command"
PARAMETERS_VARIABLE = "HYPERMAP_PARAMS_FILE"
"""Environment variable with the name of the file that holds the configuration."""

HEAD_BYTES = 1024
"""How much of a program is looked at [bytes]."""


def lint_command(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yield place and text of each warning about the command of a scenario's evaluator."""
    evaluator = scenario.evaluator.component
    if evaluator is None or evaluator.type != "command":
        return
    command = list(evaluator.options["command"])
    yield from _parameters_left_out(command, [p.name for p in scenario.parameters])
    if not evaluator.options.get("shell"):  # a shell reads what the system does not start
        yield from ((f"{PATH}[0]", text) for text in _first_line(command[0], scenario.command_folder()))


def _parameters_left_out(command: Sequence[str], parameters: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Warn of parameters whose value the program cannot know, but for the file named in its environment."""
    used = {name for argument in command for name in placeholders_in(argument)}
    text = " ".join(command)
    missing = [name for name in parameters if name not in used]
    if not missing or used & {"params_json", "params_file"} or PARAMETERS_VARIABLE in text:
        return
    names = ", ".join(f"'{name}'" for name in missing[:5]) + (", ..." if len(missing) > 5 else "")
    what = f"no placeholder passes on {names}; the program finds the values only in the file that the environment "
    what += f"variable {PARAMETERS_VARIABLE} names."
    written = next((found for name in missing if (found := _look_alike(name, text))), "")
    yield (
        PATH,
        what + (f" '{written}' is passed on as it stands: a placeholder is a bare name in braces." * bool(written)),
    )


def _look_alike(name: str, text: str) -> str:
    """Return what is probably meant as a placeholder of a name and is none, as in ``{x:.3f}`` and ``{x }``."""
    for part in text.split("{")[1:]:
        inner, brace, _ = part.partition("}")
        if brace and inner.strip().partition(":")[0].partition("!")[0].strip() == name:
            return f"{{{inner}}}"
    return ""


def _first_line(program: str, folder: Path) -> Iterator[str]:
    """Warn of a script that the system cannot start."""
    if any(placeholders_in(program)):
        return
    found = folder / program if "/" in program else shutil.which(program)
    if not found or not Path(found).is_file():
        return
    try:
        with Path(found).open("rb") as file:
            head = file.read(HEAD_BYTES)
    except OSError:  # a program may be started without being read
        return
    line = head.partition(b"\n")[0]
    if b"\0" in head:
        return
    if not line.startswith(b"#!"):
        yield f"'{program}' has no '#!' in its first line, so the system cannot start it; name its interpreter there."
    elif line.endswith(b"\r"):
        yield f"the first line of '{program}' ends like on Windows, so its interpreter is not found; save it with LF."
    elif (interpreter := line[2:].split()[:1]) and not Path(interpreter[0].decode(errors="replace")).exists():
        yield f"'{program}' starts with '{line.decode(errors='replace')}', and there is no such interpreter."
