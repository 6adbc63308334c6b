"""A black box that is a Python function."""

from __future__ import annotations

import contextlib
import importlib
import inspect
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.evaluation.batch_results import outcomes_of
from hypermap_lite.evaluation.batches import BatchOutcome, BatchRequest
from hypermap_lite.evaluation.evaluator import EvaluationRequest, last_line, outcome_of
from hypermap_lite.evaluation.outcome import Outcome, State
from hypermap_lite.objectives import FeasibleOutput

PATH = "$.function"
EXTRAS = ("seed", "replicate", "trial")
"""Facts about a call that a function gets as keyword arguments if it has parameters of these names."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonFunction:
    """Calls ``function(configuration)``, with ``seed=``, ``replicate=``, ``trial=`` if it takes them.

    It returns a mapping with every objective (other numbers become columns of ``evaluations.csv``), a sequence with
    the objectives in their order, or, for one objective, a number. ``{"feasible": False}`` marks a configuration
    that is not allowed; a scenario may name another entry for that.

    With `batch`, it is called once for all configurations of a batch: with a list of values per parameter, and with
    lists for ``seed``, ``replicate`` and ``trial``. It returns a list with an item per configuration, each of the forms
    above, or a mapping of lists (also arrays, or a pandas data frame).

    The module is imported in the main process, to find mistakes before the first evaluation, and again in every
    worker: it must not connect to hardware, or anything else that exists once, while it is imported. What it prints
    meanwhile goes to stderr.

    Raises
    ------
    ScenarioError
        If the name does not lead to something callable.
    """

    function: str | Callable[..., object]
    """``module:name``, or the function itself."""

    objectives: Sequence[str]
    """Names of the objectives."""

    feasible_output: FeasibleOutput | None = None
    """What says whether a configuration is allowed; None for an entry ``feasible`` that may be left out."""

    batch: bool = False
    """Whether it takes all configurations of a batch in one call."""

    search_path: Sequence[str] = ()
    """Folders to import from, before all others."""

    _callable: Callable[..., object] = field(init=False, repr=False, compare=False)
    _extras: tuple[str, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        function = import_function(self.function, self.search_path) if isinstance(self.function, str) else self.function
        object.__setattr__(self, "_callable", function)
        object.__setattr__(self, "_extras", accepted_extras(function))

    def __reduce__(self) -> tuple[Callable[..., PythonFunction], tuple[Any, ...]]:
        """Pickle the name rather than what it leads to, so that a worker imports it itself."""
        options = self.feasible_output, self.batch
        return _rebuild, (self.function, tuple(self.objectives), *options, tuple(self.search_path))

    def __call__(self, request: EvaluationRequest) -> Outcome:
        """Call the function once."""
        if self.batch:
            return self._call_with_batch(request)
        facts = {"seed": request.seed, "replicate": request.replicate, "trial": request.trial}
        extras = {name: facts[name] for name in self._extras}
        result = self._callable(dict(request.configuration), **extras)
        return outcome_of(result, self.objectives, self.feasible_output)

    def _call_with_batch(self, request: EvaluationRequest) -> Outcome:
        """Call the function for all requests in one; a single request is a batch of one."""
        requests = request.requests if isinstance(request, BatchRequest) else (request,)
        columns = {name: [r.configuration[name] for r in requests] for name in request.configuration}
        extras = {name: [getattr(r, name) for r in requests] for name in self._extras}
        result = self._callable(columns, **extras)
        outcomes = outcomes_of(result, self.objectives, len(requests), self.feasible_output)
        if not isinstance(request, BatchRequest):
            return outcomes[0]
        return BatchOutcome(state=State.COMPLETED, outcomes=outcomes)


def _rebuild(
    function: str | Callable[..., object],
    objectives: Sequence[str],
    feasible_output: FeasibleOutput | None,
    batch: bool,
    search_path: Sequence[str],
) -> PythonFunction:
    return PythonFunction(
        function=function,
        objectives=objectives,
        feasible_output=feasible_output,
        batch=batch,
        search_path=search_path,
    )


def accepted_extras(function: Callable[..., object]) -> tuple[str, ...]:
    """Return which of `EXTRAS` a function accepts by keyword."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return ()
    if any(p.kind is p.VAR_KEYWORD for p in parameters):
        return EXTRAS
    named = {p.name for p in list(parameters)[1:] if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)}
    return tuple(name for name in EXTRAS if name in named)


def import_function(name: str, search_path: Sequence[str] = ()) -> Callable[..., object]:
    """Return the function that ``module:name`` stands for.

    Raises
    ------
    ScenarioError
        If the name has another form, the module does not import (with the import's own error), or it holds no such
        function.
    """
    module_name, colon, attribute = name.partition(":")
    if not (module_name and colon and attribute):
        raise ScenarioError(PATH, f"{name!r} does not name a function", allowed="'module:function', as in 'robot:move'")
    for folder in reversed(search_path):
        if folder not in sys.path:
            sys.path.insert(0, folder)
    try:
        with _stdout_to_stderr():
            found: Any = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:
        places = ", ".join(search_path) or "Python's module path"
        hint = f"It was looked for in {places}."
        if module_name.endswith(".py"):
            hint = f"A module is named without .py: '{module_name.removesuffix('.py')}:{attribute}'."
        raise ScenarioError(PATH, f"importing '{module_name}' failed: {last_line(error)}", hint=hint) from error
    for part in attribute.split("."):
        if not hasattr(found, part):
            raise ScenarioError(PATH, f"'{module_name}' has no '{attribute}'", hint=nearest(part, _functions_in(found)))
        found = getattr(found, part)
    if not callable(found):
        raise ScenarioError(PATH, f"'{name}' is {type(found).__name__}, not a function", allowed="something callable")
    function: Callable[..., object] = found
    return function


@contextlib.contextmanager
def _stdout_to_stderr() -> Iterator[None]:
    """Keep stdout free of what imports print, be it Python or a library in C: somebody may read JSON there."""
    try:
        saved = os.dup(1)
        os.dup2(2, 1)
    except OSError:  # one of the two is closed
        with contextlib.redirect_stdout(sys.stderr):
            yield
        return
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        os.dup2(saved, 1)
        os.close(saved)


def _functions_in(module: object) -> list[str]:
    return [name for name in dir(module) if not name.startswith("_") and callable(getattr(module, name, None))]
