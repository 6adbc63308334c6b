"""Every failure a user can meet, as one tree.

::

    HypermapLiteError
    ├── ScenarioError (ValueError)          the scenario cannot be run as written          exit 2
    ├── UsageError (ValueError)             a call or command line that makes no sense     exit 2
    ├── RunFolderError (RuntimeError)       the run folder is locked, foreign or damaged   exit 2
    ├── NoValidEvaluationError (RuntimeError)  a run ended without one usable evaluation   exit 3
    ├── RepeatedFailureError (RuntimeError) the evaluator keeps failing                    exit 4
    ├── ClientError (RuntimeError)          the client answers wrongly, too late or not    exit 5
    └── EvaluationError (RuntimeError)      one evaluation failed; recorded, never fatal

The library raises, `hypermap_lite.cli` alone prints and exits.
"""

from __future__ import annotations

import contextlib
import difflib
import math
from collections.abc import Iterable


class HypermapLiteError(Exception):
    """Root of all errors this package raises on purpose."""

    exit_code: int = 1
    """Process exit status the command line gives this error."""


class ScenarioError(HypermapLiteError, ValueError):
    """The scenario is not valid: where, what is wrong, what was given, what is allowed, what to do.

    Parameters
    ----------
    path
        Place in the JSON, as in ``$.input_parameters.x1.values``.
    problem
        One sentence that says what is wrong and shows the value given.
    allowed
        What would be right, without a full stop; left out if empty.
    hint
        What to do next, one sentence; left out if empty.
    file
        File the path is in; left out if empty.
    """

    exit_code = 2

    def __init__(self, path: str, problem: str, *, allowed: str = "", hint: str = "", file: str = "") -> None:
        self.path = path
        self.problem = problem
        self.allowed = allowed
        self.hint = hint
        self.file = file
        super().__init__(path, problem)

    def __str__(self) -> str:
        """Return the message, one line per fact."""
        lines = [f"{self.file}: {self.path}: {self.problem}" if self.file else f"{self.path}: {self.problem}"]
        if self.allowed:
            lines.append(f"  allowed: {self.allowed}")
        if self.hint:
            lines.append(f"  hint: {self.hint}")
        return "\n".join(lines)

    def below(self, prefix: str) -> ScenarioError:
        """Return the same error with its path, relative so far (``$.std``), put below `prefix`."""
        path = prefix + self.path.removeprefix("$")
        return ScenarioError(path, self.problem, allowed=self.allowed, hint=self.hint, file=self.file)

    def within(self, file: str) -> ScenarioError:
        """Return the same error as one of a file; an error that knows its file keeps it."""
        return ScenarioError(self.path, self.problem, allowed=self.allowed, hint=self.hint, file=self.file or file)


class UsageError(HypermapLiteError, ValueError):
    """A call or a command line that makes no sense, such as `tell` for a trial never asked for."""

    exit_code = 2


class RunFolderError(HypermapLiteError, RuntimeError):
    """The run folder cannot be used: another process has it, its scenario differs, or a file is damaged."""

    exit_code = 2


class NoValidEvaluationError(HypermapLiteError, RuntimeError):
    """The run ended without a single usable evaluation."""

    exit_code = 3


class RepeatedFailureError(HypermapLiteError, RuntimeError):
    """The evaluator failed so often in a row that going on would waste the budget."""

    exit_code = 4


class ClientError(HypermapLiteError, RuntimeError):
    """The client at the other end of stdin and stdout broke the protocol, was too late, or is gone."""

    exit_code = 5


class EvaluationError(HypermapLiteError, RuntimeError):
    """One evaluation gave no usable result; the runner records it and goes on."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a hint that names the closest of the known names, or nothing if none is close.

    Close is a slip of the pen (``desgin``), a beginning (``max``), more than a name (``python_function``), initials
    (``ei``) or the last words (``type`` of ``parameter_type``) if no other name ends so.
    """
    names = {candidate.casefold(): candidate for candidate in known}
    wanted = name.casefold()
    matches = difflib.get_close_matches(wanted, names, n=1, cutoff=0.6)
    if not matches and len(wanted) > 1:
        matches = [n for n in names if n.startswith(wanted) or wanted == "".join(word[:1] for word in n.split("_"))]
        matches = matches or [n for n in names if wanted.startswith(f"{n}_")]
        ends = [n for n in names if n.endswith(f"_{wanted}")]
        matches = matches or (ends if len(ends) == 1 else [])
    return f"Did you mean '{names[matches[0]]}'?" if matches else ""


def finite_number(value: object, path: str, what: str) -> float:
    """Return `value` as a float if it is a finite number, else raise a `ScenarioError` at `path`."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        with contextlib.suppress(OverflowError):
            if math.isfinite(number := float(value)):
                return number
    raise ScenarioError(path, f"{what} is {value!r}", allowed="a finite number")


def positive_number(value: object, path: str, what: str) -> float:
    """Return `value` as a float if it is a finite positive number, else raise a `ScenarioError` at `path`."""
    number = finite_number(value, path, what)
    if number <= 0:
        raise ScenarioError(path, f"{what} is {value!r}", allowed="a number > 0")
    return number
