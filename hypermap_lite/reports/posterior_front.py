"""The front as the surrogate sees it: which evaluated configurations are best once noise is taken out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation
from hypermap_lite.history.csv_format import format_configuration, format_number, format_record
from hypermap_lite.history.history import History
from hypermap_lite.history.pooling import key_of, pooled
from hypermap_lite.objectives import Objective
from hypermap_lite.optimizers.base import Optimizer, single_threaded
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.reports.fitting import bayesian_of
from hypermap_lite.reports.tables import align, show
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Configuration, FloatArray

FEWEST: Final = 6
"""Evaluations from which a run writes its posterior front unasked; with fewer, a model is little but its prior."""

MOST: Final = 200
"""Evaluations up to which a run without a model fits one unasked, in 2 s; twice as many take four times as long."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BestPrediction:
    """An evaluated configuration, what was observed of it, and what the surrogate thinks of it."""

    trial: int
    configuration: Configuration
    observed: dict[str, float]
    """By objective, as the user directed it: the mean over all replicates."""

    mean: dict[str, float]
    """By objective, as the user directed it."""

    std: dict[str, float]
    """Standard deviation of the noise-free objective."""

    replicates: int
    """Number of them behind the observed values."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PosteriorFront:
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
                *map(show, p.configuration.values()),
            )
            for p in self.predictions
        ]
        return "best by the surrogate's mean, of the evaluated configurations\n" + align([header, *rows])

    def as_csv(self, space: SearchSpace) -> str:
        """Return the content of ``posterior_front.csv``.

        Its columns are the parameters, the observed objectives, ``trial``, ``replicates``, then ``<objective>_mean``
        and ``<objective>_std`` of the noise-free objectives by the surrogate, all as the user directed them.
        """
        names = tuple(self.predictions[0].mean)
        head = [*space.names, *names, "trial", "replicates"]
        predicted = [f"{name}_{what}" for name in names for what in ("mean", "std")]
        records = [[*head, *(f"posterior.{name}" if name in head else name for name in predicted)]]
        for p in self.predictions:
            numbers = [number for name in names for number in (p.mean[name], p.std[name])]
            records.append(
                [
                    *format_configuration(space, p.configuration),
                    *(format_number(p.observed[name]) for name in names),
                    *(str(p.trial), str(p.replicates)),
                    *map(format_number, numbers),
                ]
            )
        return "".join(map(format_record, records))


def posterior_front(scenario: Scenario, history: History, optimizer: Optimizer | None = None) -> PosteriorFront:
    """Return which evaluated configurations are best by the surrogate, which noise does not flatter.

    Only configurations that were evaluated, and are feasible, are considered: of others nobody knows. Nor are those
    whose evaluations are all set aside: outliers, failures that are told apart, and successes among failures, that
    would likely fail if they were repeated.

    Parameters
    ----------
    scenario, history
        Of the run.
    optimizer
        The run's own, which may have the surrogate fitted already.

    Raises
    ------
    UsageError
        If there are too few evaluations for a model.
    """
    bayesian = bayesian_of(scenario, history, optimizer)
    candidates = [e for e in pooled(history) if e.is_completed]
    if not candidates:
        raise UsageError("no evaluated configuration is left: the confirmation of each one failed")
    with single_threaded():
        set_aside = bayesian.set_aside()
        seen = {key_of(e.configuration) for e in history.completed if e.trial not in set_aside}
        candidates = [e for e in candidates if key_of(e.configuration) in seen] or candidates
        X = history.space.encode([e.configuration for e in candidates])
        prediction = bayesian.predictor().predict(X)
    mean, std = prediction.mean, prediction.std
    chosen = np.flatnonzero(non_dominated(mean) & history.space.unseen(X, ()))
    chosen = chosen[np.argsort(mean[chosen, 0], kind="stable")]
    if mean.shape[1] == 1:
        chosen = chosen[:1]
    objectives = history.objectives
    return PosteriorFront(predictions=tuple(_described(candidates[i], objectives, mean[i], std[i]) for i in chosen))


def _described(
    evaluation: Evaluation, objectives: tuple[Objective, ...], mean: FloatArray, std: FloatArray
) -> BestPrediction:
    names = [o.name for o in objectives]
    return BestPrediction(
        trial=evaluation.trial,
        configuration=evaluation.configuration,
        observed={name: evaluation.values[name] for name in names},
        mean={o.name: o.sign * float(value) + 0.0 for o, value in zip(objectives, mean, strict=True)},
        std=dict(zip(names, std.tolist(), strict=True)),
        replicates=evaluation.replicates,
    )


def is_worth_a_model(scenario: Scenario, history: History) -> bool:
    """Tell whether a run shall fit a model for its posterior front without being asked."""
    n = len(history.completed)
    return n >= FEWEST and (n <= MOST or scenario.optimizer.type == "bayesian")
