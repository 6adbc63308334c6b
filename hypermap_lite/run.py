"""Running a scenario from beginning to end, from Python as from the command line."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hypermap_lite import assembly
from hypermap_lite.errors import NoValidEvaluationError, ScenarioError
from hypermap_lite.evaluation.asynchronous import AsynchronousRunner
from hypermap_lite.evaluation.channel import Channel, standard_channel
from hypermap_lite.evaluation.client_server import ClientExecutor, ClientServer
from hypermap_lite.evaluation.earlier import earlier_evaluations
from hypermap_lite.evaluation.executor_choice import choose_executor
from hypermap_lite.evaluation.executors import Executor
from hypermap_lite.evaluation.observer import SAID_BY_COMMAND, RunObserver
from hypermap_lite.evaluation.runner import Runner, StopReason
from hypermap_lite.history.run_folder import RunFolder
from hypermap_lite.objectives import Objective, reference_point_of, stated_or, values_of
from hypermap_lite.pareto import hypervolume, infer_reference_point
from hypermap_lite.reports.at_end import make_reports
from hypermap_lite.result import Point, Result
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.lint import single_points
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.starting import set_run_folder_aside

if TYPE_CHECKING:
    from hypermap_lite.evaluation.evaluator import Evaluator
    from hypermap_lite.evaluation.outcome import Evaluation
    from hypermap_lite.optimizers.base import Optimizer
    from hypermap_lite.space.search_space import SearchSpace
    from hypermap_lite.typing import FloatArray

logger = logging.getLogger(__name__)


def optimize(
    scenario: str | Path | Mapping[str, Any],
    function: Callable[..., Any] | None = None,
    *,
    workers: int | None = None,
    output_directory: str | Path | None = None,
    overrides: Sequence[str] = (),
    prior_from: str | Path | None = None,
    retry_failed: bool = False,
    fresh: bool = False,
) -> Result:
    """Run a scenario, or go on with it where it stopped.

    Parameters
    ----------
    scenario
        A scenario file, or its content as a mapping.
    function
        Black box to use instead of the scenario's: called with the configuration, and with ``seed=``, ``replicate=``
        and ``trial=`` if it takes them; returns the objectives. With ``evaluator.batch`` it is called once per batch
        with a list of values per parameter. It is called in this process, unless there are several workers or a time
        limit: then it must be importable from a module.
    workers
        Calls at the same time, instead of the scenario's.
    output_directory
        Run folder, instead of the scenario's.
    overrides
        Other changes, as in ``budget.evaluations=30``.
    prior_from
        Run folder or CSV file whose non-dominated configurations replace all priors of the scenario.
    retry_failed
        Whether the failures at the end of an earlier session are evaluated again, with the same seeds, instead of
        counting towards the budget.
    fresh
        Whether to start anew; the former run folder is renamed to ``<name>.bak-N``, never deleted.

    Returns
    -------
    Result
        Of the whole run, earlier sessions included.

    Raises
    ------
    ScenarioError
        If the scenario cannot be run as written.
    UsageError
        If the function cannot be sent to the worker processes that are asked for.
    RunFolderError
        If the folder is in use, holds another scenario's results, or cannot be written.
    RepeatedFailureError, NoValidEvaluationError
        If the black box keeps failing, or never gave a usable result.
    ClientError
        If the client of a ``client_server`` scenario, at the other end of stdin and stdout, breaks the protocol.

    Examples
    --------
    >>> result = optimize("branin.json", lambda x: (x["x1"] - 1) ** 2)  # doctest: +SKIP
    >>> result.best  # doctest: +SKIP
    """
    changes = list(overrides)
    if workers is not None:
        changes.append(f"evaluator.workers={workers}")
    if output_directory is not None:
        changes.append(f"output.directory={json.dumps(str(output_directory))}")
    loaded = load_scenario(scenario, overrides=changes, prior_from=prior_from)
    on_built = partial(set_run_folder_aside, loaded) if fresh else None
    return run_scenario(loaded, function, retry_failed=retry_failed, on_built=on_built)


def run_scenario(
    scenario: Scenario,
    function: Callable[..., Any] | None = None,
    *,
    observer: RunObserver | None = None,
    should_stop: Callable[[], bool] = lambda: False,
    on_built: Callable[[], object] | None = None,
    retry_failed: bool = False,
    channel: Channel | None = None,
) -> Result:
    """Run a loaded scenario; see `optimize`.

    Parameters
    ----------
    observer
        Gets word of each step.
    should_stop
        Asked before every call of the black box; once true, the run ends in order.
    on_built
        Called when all parts of the scenario have been made, before the run folder is opened.
    channel
        Connection to the client of a ``client_server`` scenario, instead of stdin and stdout.
    """
    evaluator, optimizer = _build(scenario, function)
    spec, space = scenario.evaluator, optimizer.history.space
    earlier = _Earlier(scenario, space)
    folder = RunFolder(
        scenario.output.directory,
        space=space,
        objectives=scenario.objectives,
        canonical=scenario.canonical,
        function=None if function is None else name_of(function),
        feasible_output=scenario.feasible_output,
        prior_columns=scenario.prior_columns,
        samples_file=_path(scenario.output.samples_file),
        pareto_file=_path(scenario.output.pareto_file),
        first_rows=earlier.rows,
    )
    with ExitStack() as stack:
        if isinstance(evaluator, ClientServer) and channel is None:
            channel = stack.enter_context(standard_channel())
        executor = choose_executor(evaluator, spec, channel, is_given=function is not None)
        if on_built is not None:
            on_built()
        runner = (AsynchronousRunner if scenario.budget.asynchronous else Runner)(
            optimizer=optimizer,
            evaluator=evaluator,
            executor=executor,
            folder=folder,
            budget=scenario.budget,
            plan=assembly.build_plan(scenario),
            seed=scenario.seed,
            replicates=spec.replicates,
            racing=spec.racing,
            max_consecutive_failures=spec.max_consecutive_failures,
            should_stop=should_stop,
            observer=observer or RunObserver(),
        )
        try:
            result = _run_in_folder(runner, scenario, retry_failed=retry_failed)
        except NoValidEvaluationError:
            _say_goodbye(executor)
            raise
        if result.stop_reason is not StopReason.INTERRUPTED:
            _say_goodbye(executor)
    return result


def _run_in_folder(runner: Runner, scenario: Scenario, *, retry_failed: bool) -> Result:
    with runner.folder as folder, closing(runner.executor):  # workers end before the lock is released
        if retry_failed:
            runner.set_failures_aside()
        if len(folder.evaluations) < scenario.budget.evaluations:
            folder.write_posterior_front(None)  # it is of an earlier end, and more rows will come
        for note in scenario.notes:
            logger.info("%s", note, extra=SAID_BY_COMMAND)
        for path, text in single_points(scenario):
            logger.warning("%s: %s", path, text)
        for warning in assembly.evaluator_warnings(scenario, runner.evaluator):
            logger.warning("%s", warning)
        result = result_of(folder, runner.run())
        if result.hypervolume == 0 and result.stop_reason is not StopReason.INTERRUPTED:
            logger.warning("%s", _short_of_reference_point(result, folder.objectives))
        return _with_reports(result, scenario, runner)


def _with_reports(result: Result, scenario: Scenario, runner: Runner) -> Result:
    if result.stop_reason is StopReason.INTERRUPTED:
        return result
    reports = make_reports(scenario, runner.folder, runner.optimizer)
    return replace(
        result,
        parameter_importance=reports.parameter_importance,
        posterior_front=reports.posterior_front,
        posterior_best=reports.posterior_front if scenario.output.posterior_best else None,
    )


def _say_goodbye(executor: Executor) -> None:
    """Tell a client that the run has ended, all files being written and free."""
    if isinstance(executor, ClientExecutor):
        executor.say_goodbye()


class _Earlier:
    """The evaluations that a run takes over when it begins, read before its folder is touched.

    A run that goes on has them in its history: then it does not matter that the file is gone, or has changed.
    """

    def __init__(self, scenario: Scenario, space: SearchSpace) -> None:
        self._budget = scenario.budget.evaluations
        self._evaluations: list[Evaluation] = []
        self._error: ScenarioError | None = None
        try:
            self._evaluations = earlier_evaluations(scenario, space)
        except ScenarioError as error:
            if not (Path(scenario.output.directory) / "history.csv").exists():
                raise
            self._error = error

    def rows(self) -> list[Evaluation]:
        """Return them; raise what was wrong with their file if they are needed all the same."""
        if self._error is not None:
            raise self._error
        n = len(self._evaluations)
        if n >= self._budget:
            logger.warning("budget.evaluations is %d in all, and %d earlier ones use it up", self._budget, n)
        return self._evaluations


def _path(text: str | None) -> Path | None:
    return None if text is None else Path(text)


def _build(scenario: Scenario, function: Callable[..., Any] | None) -> tuple[Evaluator, Optimizer]:
    """Make the black box and the optimizer; mistakes are shown with the file they stand in."""
    try:
        return assembly.build_evaluator(scenario, function), assembly.build_optimizer(scenario)
    except ScenarioError as error:
        raise scenario.located(error) from error


def name_of(function: Callable[..., Any]) -> str:
    """Return module and name of a function, or of the class of another callable object."""
    named = function if hasattr(function, "__qualname__") else type(function)
    return f"{named.__module__}.{named.__qualname__}"


def result_of(folder: RunFolder, reason: StopReason) -> Result:
    """Sum up an open run folder."""
    objectives = folder.objectives
    front = folder.pareto_front()
    points: tuple[Point, ...] = tuple((e.configuration, e.values) for e in front)
    Y = np.array([values_of(objectives, e.values) for e in front])
    corner = _reference_point(objectives, Y) if len(objectives) > 1 and front else None
    volume = np.inf if corner is None else hypervolume(Y, corner)
    return Result(
        evaluations=tuple(folder.evaluations),
        pareto_front=points,
        best=points[0] if len(objectives) == 1 and points else None,
        hypervolume=volume if np.isfinite(volume) else None,
        reference_point=None
        if corner is None
        else {o.name: o.sign * float(c) for o, c in zip(objectives, corner, strict=True)},
        run_folder=folder.path,
        stop_reason=reason,
    )


def _short_of_reference_point(result: Result, objectives: Sequence[Objective]) -> str:
    """Say of what no evaluation was good enough to count for the hypervolume."""
    text = "the hypervolume is 0: no evaluation is better than the reference point in every objective"
    short = []
    for o in objectives:
        values = [values[o.name] for _, values in result.pareto_front]
        best = min(values, key=lambda value: o.sign * value)
        if o.reference_point is not None and o.sign * best >= o.sign * o.reference_point:
            short.append(f"{o.name}, whose best value is {best:g} and whose reference point is {o.reference_point:g}")
    return f"{text}; none alone in {'; '.join(short)}" if short else text


def _reference_point(objectives: Sequence[Objective], Y: FloatArray) -> FloatArray:
    """Return the scenario's reference point, inferred from the front for objectives without, to be minimized."""
    stated = reference_point_of(objectives)
    if stated is not None:
        return stated
    return stated_or(objectives, infer_reference_point(Y))
