"""Expected improvement over the noise-free best, which noise hides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.expected_improvement import check_samples
from hypermap_lite.acquisition.improvement import LinearImprovement, SampledImprovement
from hypermap_lite.quasi_random import quasi_normal


@dataclass(frozen=True, slots=True, kw_only=True)
class NoisyExpectedImprovement:
    """Log noisy expected improvement [1]_, with stable tails [2]_.

    The noise-free values at all observed and pending points are drawn jointly by quasi-Monte Carlo; each draw has its
    own incumbent and its own closed-form expected improvement. So a lucky observation is no incumbent, and pending
    points are accounted for with their uncertainty. Several objectives are scalarized: per objective and summed for
    the linear scalarization (the paper's choice), by joint samples otherwise.

    References
    ----------
    .. [1] Letham, Karrer, Ottoni, Bakshy. Constrained Bayesian Optimization with Noisy Experiments. Bayesian
       Analysis, 2019.
    .. [2] Ament et al. Unexpected Improvements to Expected Improvement for Bayesian Optimization. NeurIPS 2023.
    """

    samples: int = 64
    """Draws of the noise-free values; a forest has as many as trees instead."""

    screening: int = 8
    """Samples that choose, of all candidates, those that are scored in full; 0 scores all of them in full."""

    is_logarithmic: ClassVar[bool] = True
    is_scalarizing: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_samples(self.samples, self.screening)

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        fantasies = context.posterior.fantasies(context.X_pending, self.samples, context.rng)
        if context.scalarization.is_linear or context.Y.shape[1] == 1:
            return LinearImprovement(
                field=fantasies.field,
                incumbents=fantasies.values.min(axis=1),
                weights=context.weights,
                scale=context.normalization.scale,
                is_differentiable=context.posterior.is_differentiable,
            )
        scalars = context.scalarization(context.normalization(fantasies.values), context.weights)  # (S, b)
        return SampledImprovement(
            field=fantasies.field,
            incumbents=np.asarray(scalars.min(axis=1)),
            normal=quasi_normal(len(scalars), context.Y.shape[1], context.rng),
            scalarization=context.scalarization,
            weights=context.weights,
            normalization=context.normalization,
            screening=self.screening,
            is_differentiable=context.posterior.is_differentiable,
        )
