"""The black box as the runner sees it: one call, one outcome."""

from __future__ import annotations

import math
import os
import re
import time
import traceback
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any, Final, Protocol, TypeGuard

from hypermap_lite.errors import EvaluationError
from hypermap_lite.evaluation.outcome import Outcome, Replicate, State
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.typing import Configuration

FEASIBLE_KEY = "feasible"
"""Entry of a result that says, if false, that the configuration is not allowed; a scenario may name another."""

NOT_FEASIBLE = "the black box answered: not feasible"

MAX_REASON = 300
"""Characters of a failure's reason that go into a CSV."""

_TERMINAL_CODES: Final = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(?:\x07|\x1b\\)|[@-Z\\^_])")
"""Escape sequences for colours, cursor and window titles."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EvaluationRequest:
    """One call to make."""

    trial: int
    replicate: int
    seed: int
    """For the black box's own randomness; different for every trial and replicate, 0 to 2**31 - 1."""

    configuration: Configuration
    directory: Path
    """Folder for this trial's files, absolute; it may not exist yet."""

    def file(self, ending: str) -> Path:
        """Return where this call's file of a kind goes, as in ``replicate_0.stdout.log``."""
        return self.directory / f"replicate_{self.replicate}.{ending}"


class Evaluator(Protocol):
    """Anything that evaluates a request; it must survive pickling unless it is only called in this process."""

    def __call__(self, request: EvaluationRequest) -> Outcome:
        """Return the outcome; an exception counts as a failure, an `EvaluationError` as one with a known reason."""


def call(
    evaluator: Evaluator,
    request: EvaluationRequest,
    caught: tuple[type[BaseException], ...] = (Exception, SystemExit),
) -> Replicate:
    """Call the black box once; whatever it raises becomes a failed outcome, its traceback a file of the trial.

    Parameters
    ----------
    caught
        What counts as the black box's own failure. In this process a `KeyboardInterrupt` is somebody's wish to stop;
        in a worker, where nobody presses Ctrl-C, it is a failure like any other.
    """
    start = time.perf_counter()
    try:
        with forked_children_end_here():
            outcome = evaluator(request)
    except EvaluationError as error:
        outcome = failure(_message(error))
    except caught as error:
        outcome = failure(last_line(error))
        _keep_traceback(request)
    return answer(request, outcome, time.perf_counter() - start)


@contextmanager
def forked_children_end_here() -> Iterator[None]:
    """End a process that foreign code forked where it would leave the context, so that it never answers too."""
    pid = os.getpid()
    try:
        yield
    finally:
        if os.getpid() != pid:
            os._exit(0)


def answer(request: EvaluationRequest, outcome: Outcome, seconds: float) -> Replicate:
    """Return the record of a call."""
    return Replicate(
        trial=request.trial,
        replicate=request.replicate,
        seed=request.seed,
        configuration=request.configuration,
        outcome=outcome,
        seconds=seconds,
    )


def outcome_of(result: object, objectives: Sequence[str], feasible_output: FeasibleOutput | None = None) -> Outcome:
    """Turn what a black box returned into an outcome.

    Parameters
    ----------
    result
        A mapping with every objective (its other finite numbers become metrics; ``{"feasible": false}`` needs no
        objectives) or anything else with names, such as a pandas Series or a named tuple; or the objectives as a
        sequence or array in their order, the feasibility last; or a number if there is only one.
    objectives
        Their names.
    feasible_output
        The entry that must say whether the configuration is allowed; None for ``feasible``, which may be left out.

    Returns
    -------
    Outcome
        Completed, infeasible (with those objectives that are finite numbers), or failed with the reason if a value
        is missing, not a number, NaN or infinite, or the feasibility is neither true nor false.
    """
    flag = FEASIBLE_KEY if feasible_output is None else feasible_output.name
    entries = _by_name(result, objectives, () if feasible_output is None else (flag,))
    if isinstance(entries, str):
        return failure(entries)
    numbers = {name: as_number(value) for name, value in entries.items()}
    metrics = {
        str(name): number
        for name, number in numbers.items()
        if name not in (*objectives, flag) and number is not None and math.isfinite(number)
    }
    values = {
        name: number for name in objectives if (number := numbers.get(name)) is not None and math.isfinite(number)
    }
    verdict: bool | str = True
    if feasible_output is not None or (flag in entries and flag not in objectives):
        verdict = _verdict(entries, numbers, flag, feasible_output)
    if isinstance(verdict, str):
        return failure(verdict, metrics)
    if not verdict:
        return Outcome(state=State.INFEASIBLE, values=values, metrics=metrics, error=NOT_FEASIBLE)
    for name in objectives:
        if name not in entries:
            return failure(_missing(name, entries), metrics)
        if name not in values:
            return failure(f"'{name}' is {shorten(entries[name])}, not a finite number", metrics)
    return Outcome(state=State.COMPLETED, values=values, metrics=metrics)


def _verdict(
    entries: Mapping[str, object], numbers: Mapping[str, float | None], flag: str, output: FeasibleOutput | None
) -> bool | str:
    """Return whether a result says that the configuration is feasible, or what is wrong with what it says."""
    if flag not in entries:
        return _missing(flag, entries)
    if output is None:
        verdict = bool(numbers[flag]) if numbers[flag] in (0.0, 1.0) else None
        texts = ""
    else:
        verdict = output.verdict(entries[flag], numbers[flag])
        texts = f", nor {output.true_value!r} or {output.false_value!r}"
    return f"'{flag}' is {shorten(entries[flag])}, neither true nor false{texts}" if verdict is None else verdict


def _missing(name: str, entries: Mapping[str, object]) -> str:
    returned = ", ".join(map(str, entries)) or "nothing"
    return f"the result has no '{name}' (it has: {returned})"


def _by_name(result: object, objectives: Sequence[str], more: Sequence[str]) -> Mapping[str, object] | str:
    """Return the entries of a result by name, or what is wrong with it."""
    names = [*objectives, *more]
    named = as_mapping(result)
    if named is not None:
        return named
    if len(names) == 1 and as_number(result) is not None:
        return {names[0]: result}
    expected = f"expected a mapping with {', '.join(map(repr, names))}"
    if not has_an_order(result):
        return f"the result is {shorten(result)}; {expected}"
    items = list(result)
    if len(items) != len(names):
        wanted = " and ".join([f"{len(objectives)} objectives", *map(repr, more)])
        return f"the result has {len(items)} numbers for {wanted}; {expected}"
    return dict(zip(names, items, strict=True))


def as_mapping(result: Any) -> Mapping[str, object] | None:
    """Return a result that has names (mapping, pandas Series, named tuple) as a mapping; None for any other."""
    if isinstance(result, Mapping):
        return result
    if hasattr(result, "keys") and hasattr(result, "__getitem__"):
        return {key: result[key] for key in result.keys()}  # noqa: SIM118 - iterating a Series gives its values
    if isinstance(result, tuple) and hasattr(result, "_asdict"):
        return dict(result._asdict())
    return None


def has_an_order(result: object) -> TypeGuard[Iterable[object]]:
    """Tell whether a result is a sequence or an array of numbers, not text, and not a set."""
    if isinstance(result, Sequence):
        return not isinstance(result, str | bytes | bytearray | memoryview)
    return hasattr(result, "__array__") and getattr(result, "ndim", 0) > 0


def shorten(value: object) -> str:
    """Return a value as Python writes it, cut to a length that leaves room for the rest of a message."""
    return repr(value)[:80]


def as_number(value: object) -> float | None:
    """Return a number, truth value or one-element array as a float; None for anything else."""
    item = getattr(value, "item", None)
    if callable(item) and getattr(value, "size", 1) == 1:
        value = item()
    try:
        return float(value) if isinstance(value, Real) else None
    except OverflowError:
        return math.inf


def failure(reason: str, metrics: Mapping[str, float] | None = None) -> Outcome:
    """Return a failed outcome; its reason is put on one line of printable text and cut to a sensible length."""
    line = printable(reason) or "no reason given"
    return Outcome(
        state=State.FAILED,
        metrics=metrics or {},
        error=line if len(line) <= MAX_REASON else line[: MAX_REASON - 4] + " ...",
    )


def printable(text: str) -> str:
    """Return text on one line, without colours, and with control characters spelt out (a bell as its code 07)."""
    line = " ".join(_TERMINAL_CODES.sub("", text).split())
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)


def last_line(error: BaseException) -> str:
    """Return an exception as Python prints it below a traceback, as in ``ValueError: not a number``."""
    name, message = type(error).__name__, printable(_message(error))
    return f"{name}: {message}" if message else name


def _message(error: BaseException) -> str:
    try:
        return str(error)
    except BaseException:  # it is the black box's code that runs here
        return "(an exception whose message cannot be shown)"


def _keep_traceback(request: EvaluationRequest) -> None:
    """Write the current traceback beside the trial's logs; a folder that cannot be written is not the call's fault."""
    try:
        request.directory.mkdir(parents=True, exist_ok=True)
        request.file("traceback.log").write_text(traceback.format_exc(), encoding="utf-8", errors="backslashreplace")
    except Exception:
        return
