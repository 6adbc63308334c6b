"""A black box that is any program: arguments in, JSON out."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from hypermap_lite.errors import EvaluationError, ScenarioError, nearest
from hypermap_lite.evaluation.evaluator import EvaluationRequest, outcome_of
from hypermap_lite.evaluation.logs import last_text_line, shorten_logs
from hypermap_lite.evaluation.outcome import Outcome
from hypermap_lite.evaluation.placeholders import BUILT_IN, fill, placeholders_in, unknown_placeholders
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.typing import as_argument

THREAD_CAPS: Final = "HYPERMAP_THREAD_CAPS"
"""Environment variable that names the thread limits a worker set for itself; programs are started without them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """Runs a program once per call and reads a JSON object with the objectives.

    The program's output goes to ``replicate_0.stdout.log`` and ``.stderr.log`` in the trial's folder, of which the
    first and last MiB are kept. The program leads a process group of its own; whatever of that group still runs when
    the program has ended is killed.

    At the time limit, the program and everything it started get SIGTERM, and SIGKILL if they still run
    `executors.GRACE_SECONDS` later: time for a robot to stop. Only what asked for a session of its own (``setsid``)
    goes on. Ctrl-C and a kill of the run are not passed on as a SIGTERM.

    Raises
    ------
    ScenarioError
        If the program is not found or a placeholder is not known.
    """

    command: Sequence[str]
    """Program and arguments, with placeholders in braces: every parameter's name and those of `BUILT_IN`."""

    objectives: Sequence[str]
    """Names of the objectives."""

    feasible_output: FeasibleOutput | None = None
    """What says whether a configuration is allowed; None for an entry ``feasible`` that may be left out."""

    shell: bool = False
    """Whether the arguments are joined by blanks and run by ``/bin/sh``; placeholders are quoted for it."""

    result: str = "stdout"
    """``stdout``: the last line that is not empty; ``file``: the file ``{result_file}``."""

    working_directory: str | Path = "."
    """Folder the program runs in; one named with a slash is looked for there."""

    parameters: Sequence[str] | None = None
    """Names of the parameters, to check the placeholders; None leaves them unchecked."""

    def __post_init__(self) -> None:
        if isinstance(self.command, str) or not self.command:
            raise ScenarioError(
                "$.command", f"the command is {self.command!r}", allowed="a list of at least one string"
            )
        if self.result not in ("stdout", "file"):
            raise ScenarioError("$.result", f"the result is {self.result!r}", allowed="'stdout' or 'file'")
        object.__setattr__(self, "working_directory", Path(self.working_directory).absolute())
        self._check_placeholders()
        if not self.shell and not any(placeholders_in(self.command[0])):
            check_program(self.command[0], Path(self.working_directory))

    def _check_placeholders(self) -> None:
        if self.parameters is None:
            return
        for position, name in unknown_placeholders(self.command, self.parameters):
            known = [*self.parameters, *BUILT_IN]
            guess = nearest(name, known)
            raise ScenarioError(
                f"$.command[{position}]",
                f"unknown placeholder {{{name}}}",
                allowed=", ".join(f"{{{k}}}" for k in known),
                hint=f"{guess} For the text itself, write {{{{{name}}}}}.".strip(),
            )

    def __call__(self, request: EvaluationRequest) -> Outcome:
        """Run the program once.

        Raises
        ------
        EvaluationError
            If it cannot be started, fails, or leaves no JSON object.
        """
        prepare_folder(request)
        values = placeholder_values(request)
        arguments = [fill(argument, values, quote=self.shell) for argument in self.command]
        try:
            self._run(" ".join(arguments) if self.shell else arguments, request)
            return outcome_of(self._read_result(request), self.objectives, self.feasible_output)
        finally:
            shorten_logs(request)

    def _run(self, arguments: str | list[str], request: EvaluationRequest) -> None:
        stderr = request.file("stderr.log")
        with request.file("stdout.log").open("wb") as out, stderr.open("wb") as err:
            try:
                process = subprocess.Popen(
                    arguments,
                    shell=self.shell,
                    cwd=self.working_directory,
                    env=environment(request),
                    stdin=subprocess.DEVNULL,
                    stdout=out,
                    stderr=err,
                    process_group=0,
                )
            except (OSError, ValueError) as error:
                raise EvaluationError(f"the program could not be started: {error}") from error
        status = wait_and_end_group(process)
        if status:
            said = _last_words(stderr)
            raise EvaluationError(describe_status(status) + (f": {said}" if said else ""))

    def _read_result(self, request: EvaluationRequest) -> Mapping[str, object]:
        if self.result == "file":
            place, path = "the result file", request.file("result.json")
            text = path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""
        else:
            place, path = "the last line of the output", request.file("stdout.log")
            text = self._last_line(path)
        try:
            result = json.loads(text)
        except ValueError:
            result = None
        if isinstance(result, dict):
            return result
        shown = repr(text[:80]) if text.strip() else "empty"
        said = _last_words(request.file("stderr.log"))
        raise EvaluationError(f"{place} is {shown}, not a JSON object" + (f" (stderr: {said})" if said else ""))

    def _last_line(self, path: Path) -> str:
        try:
            return last_text_line(path)
        except ValueError as error:
            raise EvaluationError(f'{error}: write the result to {{result_file}}, with "result": "file"') from error


def wait_and_end_group(process: subprocess.Popen[bytes]) -> int:
    """Wait for the leader of a process group, kill what is left of the group, and return the leader's status."""
    try:
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # not reaped, so the group's number is not reused
    finally:
        with contextlib.suppress(ProcessLookupError, PermissionError):  # macOS: only the unreaped leader is left
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    return process.returncode


def check_program(program: str, working_directory: Path) -> None:
    """Raise a `ScenarioError` if a program cannot be found or run."""
    path = working_directory / program
    if "/" not in program:
        if shutil.which(program):
            return
        hint = f"Write './{program}' for the file in {working_directory}." if path.is_file() else "Is it installed?"
        raise ScenarioError("$.command[0]", f"the program '{program}' is not on the PATH", hint=hint)
    if not path.is_file():
        raise ScenarioError(
            "$.command[0]", f"there is no program '{path}'", hint="Paths start at the scenario's folder."
        )
    if not os.access(path, os.X_OK):
        raise ScenarioError("$.command[0]", f"'{path}' is not executable", hint=f"chmod +x {shlex.quote(str(path))}")


def prepare_folder(request: EvaluationRequest) -> None:
    """Create the trial's folder with ``parameters.json`` and without an older result."""
    request.directory.mkdir(parents=True, exist_ok=True)
    request.file("result.json").unlink(missing_ok=True)
    temporary = request.file("parameters.tmp")
    temporary.write_text(json.dumps(dict(request.configuration)) + "\n", encoding="utf-8")
    temporary.replace(parameters_file(request))


def parameters_file(request: EvaluationRequest) -> Path:
    """Return where the configuration is written as JSON."""
    return request.directory / "parameters.json"


def placeholder_values(request: EvaluationRequest) -> dict[str, str]:
    """Return what each placeholder stands for; a parameter goes before a built-in of the same name."""
    return {
        "params_json": json.dumps(dict(request.configuration)),
        "params_file": str(parameters_file(request)),
        "result_file": str(request.file("result.json")),
        "seed": str(request.seed),
        "trial": str(request.trial),
        "replicate": str(request.replicate),
        "trial_dir": str(request.directory),
        "python": sys.executable,
        **{name: as_argument(value) for name, value in request.configuration.items()},
    }


def environment(request: EvaluationRequest) -> dict[str, str]:
    """Return the program's environment: the user's own and the facts about the call."""
    capped = os.environ.get(THREAD_CAPS, "").split()
    inherited = {name: value for name, value in os.environ.items() if name not in (THREAD_CAPS, *capped)}
    return inherited | {
        "HYPERMAP_PARAMS_FILE": str(parameters_file(request)),
        "HYPERMAP_RESULT_FILE": str(request.file("result.json")),
        "HYPERMAP_SEED": str(request.seed),
        "HYPERMAP_TRIAL": str(request.trial),
        "HYPERMAP_REPLICATE": str(request.replicate),
    }


def _last_words(log: Path) -> str:
    try:
        return last_text_line(log)
    except ValueError as error:
        return f"({error})"


def describe_status(status: int) -> str:
    """Say in words how a process ended: ``exit status 3`` or ``killed by signal 9 (SIGKILL)``."""
    if status >= 0:
        return f"exit status {status}"
    try:
        name = signal.Signals(-status).name
    except ValueError:
        return f"killed by signal {-status}"
    return f"killed by signal {-status} ({name})"
