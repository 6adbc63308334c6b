"""Expected improvement over the best observation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.improvement import LinearImprovement, SampledImprovement
from hypermap_lite.errors import ScenarioError
from hypermap_lite.quasi_random import quasi_normal


@dataclass(frozen=True, slots=True, kw_only=True)
class ExpectedImprovement:
    """Log expected improvement over the best value observed [1]_, noise and all.

    Pending points count as evaluated at their predicted means, as incumbents too. Several objectives are scalarized:
    per objective and summed for the linear scalarization, by joint samples otherwise.

    References
    ----------
    .. [1] Jones, Schonlau, Welch. Efficient Global Optimization of Expensive Black-Box Functions. 1998.
    """

    samples: int = 64
    """Joint samples, used with a scalarization that is not linear."""

    screening: int = 8
    """Samples that choose, of all candidates, those that are scored in full; 0 scores all of them in full."""

    is_logarithmic: ClassVar[bool] = True
    is_scalarizing: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_samples(self.samples, self.screening)

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        posterior = context.posterior.believe(context.X_pending)
        known = context.Y
        if len(context.X_pending):
            known = np.vstack([known, context.posterior.predict(context.X_pending).mean])
        if context.scalarization.is_linear or context.Y.shape[1] == 1:
            return LinearImprovement(
                field=posterior.field,
                incumbents=known.min(axis=0)[None],
                weights=context.weights,
                scale=context.normalization.scale,
                is_differentiable=posterior.is_differentiable,
            )
        scalars = context.scalarization(context.normalization(known), context.weights)
        return SampledImprovement(
            field=posterior.field,
            incumbents=scalars.min(keepdims=True),
            normal=quasi_normal(self.samples, context.Y.shape[1], context.rng),
            scalarization=context.scalarization,
            weights=context.weights,
            normalization=context.normalization,
            screening=self.screening,
            is_differentiable=posterior.is_differentiable,
        )


def check_samples(samples: int, screening: int) -> None:
    """Raise a `ScenarioError` if there are too few samples."""
    if screening < 0:
        raise ScenarioError("$.screening", f"there are {screening} samples", allowed="an integer >= 0")
    if samples < 2:
        raise ScenarioError("$.samples", f"there are {samples} samples", allowed="an integer >= 2")
