"""Which parameters matter, by the surrogate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.history.history import History
from hypermap_lite.optimizers.base import Optimizer, single_threaded
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.reports.fitting import fitted
from hypermap_lite.reports.tables import align
from hypermap_lite.scenario.model import Scenario
from hypermap_lite.surrogates.sensitivity import total_sobol_indices
from hypermap_lite.typing import FloatArray


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
        return "parameter importance (total Sobol indices, scaled)\n" + align([("parameter", *self.objectives), *rows])


def parameter_importance(
    scenario: Scenario, history: History, optimizer: Optimizer | None = None
) -> ParameterImportance:
    """Measure how much each parameter matters to each objective.

    The measure is the same for all surrogates, and does not depend on how they see a categorical parameter. The run's
    own optimizer may have the surrogate fitted already.

    Raises
    ------
    UsageError
        If there are too few evaluations for a model.
    """
    space, n = history.space, len(history.completed)
    posterior = fitted(scenario, history, optimizer)
    rng = generator(scenario.seed, Stream.REPORT, n)
    with single_threaded():
        indices = total_sobol_indices(lambda X: posterior.predict(X).mean, space, rng)
    total = indices.sum(axis=1, keepdims=True)
    return ParameterImportance(
        parameters=space.names,
        objectives=tuple(o.name for o in history.objectives),
        shares=indices / np.where(total > 0, total, 1.0),
    )
