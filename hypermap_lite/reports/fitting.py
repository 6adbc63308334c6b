"""The scenario's surrogate, fitted to the history of a run."""

from __future__ import annotations

from dataclasses import replace

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.errors import UsageError
from hypermap_lite.history.history import History
from hypermap_lite.optimizers.base import Optimizer, single_threaded
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.models import MIN_COMPLETED
from hypermap_lite.scenario.model import ComponentSpec, Scenario
from hypermap_lite.surrogates.base import Predictor


def fitted(scenario: Scenario, history: History, optimizer: Optimizer | None = None) -> Predictor:
    """Return what the scenario's surrogate predicts, fitted to a history; see `bayesian_of`."""
    with single_threaded():
        return bayesian_of(scenario, history, optimizer).predictor_of_all()


def bayesian_of(scenario: Scenario, history: History, optimizer: Optimizer | None = None) -> BayesianOptimizer:
    """Return what fits the scenario's surrogate to a history as Bayesian optimization would, whatever the optimizer.

    Parameters
    ----------
    scenario, history
        Of the run.
    optimizer
        The run's own; if it is a Bayesian one that has all of the history, it need not be made again.

    Raises
    ------
    UsageError
        If there are too few evaluations for a model.
    """
    n = len(history.completed)
    if n < MIN_COMPLETED:
        raise UsageError(f"{n} completed evaluation{'s' * (n != 1)}; a model needs at least {MIN_COMPLETED}")
    if not isinstance(optimizer, BayesianOptimizer) or len(optimizer.history) != len(history):
        bayesian = ComponentSpec(type="bayesian", path="$.optimizer")
        optimizer = build_optimizer(replace(scenario, optimizer=bayesian), history)
        assert isinstance(optimizer, BayesianOptimizer)
    if not optimizer.has_model():
        raise UsageError("the completed evaluations are of too few configurations that did not fail when confirmed")
    return optimizer
