"""What a run that has ended says by its surrogate: the reports asked for, and the posterior front."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from hypermap_lite.assembly import build_history
from hypermap_lite.errors import HypermapLiteError
from hypermap_lite.evaluation.observer import SAID_BY_COMMAND
from hypermap_lite.history.finishing_order import as_learnt
from hypermap_lite.history.run_folder import RunFolder
from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.reports.parameter_importance import ParameterImportance, parameter_importance
from hypermap_lite.reports.posterior_front import PosteriorFront, is_worth_a_model, posterior_front
from hypermap_lite.scenario.model import Scenario

logger = logging.getLogger(__name__)

Report = TypeVar("Report")


@dataclass(frozen=True, slots=True, kw_only=True)
class Reports:
    """What could be made."""

    parameter_importance: ParameterImportance | None = None
    posterior_front: PosteriorFront | None = None


def make_reports(scenario: Scenario, folder: RunFolder, optimizer: Optimizer | None = None) -> Reports:
    """Make the reports that the scenario asks for, log them, and write ``posterior_front.csv``.

    One that fails is no failure of the run: a warning says why, unless nobody asked for it.
    """
    history = build_history(scenario)
    history.extend(as_learnt(history, folder.evaluations, folder.trials_of_calls()))
    output = scenario.output
    importance = front = None
    if output.parameter_importance:
        importance = _made(
            "parameter_importance", lambda: parameter_importance(scenario, history, optimizer), is_asked_for=True
        )
        if importance is not None:
            logger.info("%s", importance, extra=SAID_BY_COMMAND)
    if output.posterior_best or is_worth_a_model(scenario, history):
        what = "posterior_best" if output.posterior_best else "posterior front"
        front = _made(what, lambda: posterior_front(scenario, history, optimizer), is_asked_for=output.posterior_best)
    if front is not None:
        folder.write_posterior_front(front.as_csv(folder.space))
        if output.posterior_best:
            logger.info("%s", front, extra=SAID_BY_COMMAND)
    return Reports(parameter_importance=importance, posterior_front=front)


def _made(what: str, make: Callable[[], Report], *, is_asked_for: bool) -> Report | None:
    try:
        return make()
    except HypermapLiteError as error:
        logger.log(logging.WARNING if is_asked_for else logging.INFO, "no %s: %s", what, error)
    except Exception as error:  # whatever a model stumbles over, the evaluations are made and written
        logger.warning("no %s: %s: %s", what, type(error).__name__, error)
    return None
