"""What the surrogate says at the end of a run: which parameters matter, and which configuration is best."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.errors import UsageError
from hypermap_lite.history.history import History
from hypermap_lite.objectives import Objective
from hypermap_lite.optimizers.base import single_threaded
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.models import MIN_COMPLETED
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.scenario.model import ComponentSpec, Scenario
from hypermap_lite.surrogates.base import Posterior
from hypermap_lite.surrogates.sensitivity import total_sobol_indices
from hypermap_lite.typing import Configuration, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ParameterImportance:
    """Total Sobol indices of the surrogate's mean over the whole space, for each objective scaled to sum to one."""

    parameters: tuple[str, ...]
    objectives: tuple[str, ...]
    shares: FloatArray
    """Shape (objectives, parameters), >= 0; a row of zeros if the mean is constant."""

    def of(self, objective: str) -> dict[str, float]:
        """Return the share of each parameter for one objective."""
        return dict(zip(self.parameters, self.shares[self.objectives.index(objective)].tolist(), strict=True))

    def __str__(self) -> str:
        """Return a table with a row per parameter, the most important for all objectives together first."""
        order = np.argsort(-self.shares.sum(axis=0), kind="stable")
        rows = [(self.parameters[j], *(f"{share:.3f}" for share in self.shares[:, j])) for j in order]
        return "parameter importance (total Sobol indices, scaled)\n" + _table([("parameter", *self.objectives), *rows])


@dataclass(frozen=True, slots=True, kw_only=True)
class BestPrediction:
    """An evaluated configuration, and what the surrogate thinks of it."""

    trial: int
    configuration: Configuration
    mean: dict[str, float]
    """By objective, as the user directed it."""

    std: dict[str, float]
    """Standard deviation of the noise-free objective."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PosteriorBest:
    """The evaluated configurations whose predicted means are not dominated; for one objective the best one."""

    predictions: tuple[BestPrediction, ...]
    """In the order of the first objective, best first."""

    def __str__(self) -> str:
        """Return a table with a row per configuration."""
        first = self.predictions[0]
        header = ("trial", *first.mean, *first.configuration)
        rows = [
            (
                str(p.trial),
                *(f"{p.mean[n]:.4g} ± {p.std[n]:.2g}" for n in p.mean),
                *map(_show, p.configuration.values()),
            )
            for p in self.predictions
        ]
        return "best by the surrogate's mean, of the evaluated configurations\n" + _table([header, *rows])


def parameter_importance(scenario: Scenario, history: History) -> ParameterImportance:
    """Measure how much each parameter matters to each objective.

    The measure is the same for all surrogates, and does not depend on how they see a categorical parameter.

    Raises
    ------
    UsageError
        If there are too few evaluations for a model.
    """
    space, n = history.space, len(history.completed)
    posterior = fitted(scenario, history)
    rng = generator(scenario.seed, Stream.REPORT, n)
    with single_threaded():
        indices = total_sobol_indices(lambda X: posterior.predict(X).mean, space, rng)
    total = indices.sum(axis=1, keepdims=True)
    return ParameterImportance(
        parameters=space.names,
        objectives=tuple(o.name for o in history.objectives),
        shares=indices / np.where(total > 0, total, 1.0),
    )


def posterior_best(scenario: Scenario, history: History) -> PosteriorBest:
    """Return which evaluated configurations are best by the surrogate, which noise does not flatter.

    Only configurations that were evaluated, and are feasible, are considered: of others nobody knows.

    Raises
    ------
    UsageError
        If there are too few evaluations for a model.
    """
    with single_threaded():
        prediction = fitted(scenario, history).predict(history.X())
    mean, std = prediction.mean, prediction.std
    repeats = history.space.unseen(history.X(), ())
    chosen = np.flatnonzero(non_dominated(mean) & repeats)
    chosen = chosen[np.argsort(mean[chosen, 0], kind="stable")]
    if mean.shape[1] == 1:
        chosen = chosen[:1]
    completed = history.completed
    return PosteriorBest(
        predictions=tuple(
            BestPrediction(
                trial=completed[i].trial,
                configuration=completed[i].configuration,
                mean=_directed(history.objectives, mean[i]),
                std={o.name: float(s) for o, s in zip(history.objectives, std[i], strict=True)},
            )
            for i in chosen
        )
    )


def fitted(scenario: Scenario, history: History) -> Posterior:
    """Return the scenario's surrogate, fitted to a history as Bayesian optimization would, whatever the optimizer."""
    n = len(history.completed)
    if n < MIN_COMPLETED:
        raise UsageError(f"{n} completed evaluation{'s' * (n != 1)}; a model needs at least {MIN_COMPLETED}")
    bayesian = ComponentSpec(type="bayesian", path="$.optimizer")
    optimizer = build_optimizer(replace(scenario, optimizer=bayesian), history)
    assert isinstance(optimizer, BayesianOptimizer)
    with single_threaded():
        return optimizer.posterior()


def _directed(objectives: tuple[Objective, ...], y: FloatArray) -> dict[str, float]:
    return {o.name: o.sign * float(value) + 0.0 for o, value in zip(objectives, y, strict=True)}


def _show(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _table(rows: list[tuple[str, ...]]) -> str:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)
