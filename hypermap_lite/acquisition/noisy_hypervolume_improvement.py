"""Expected growth of the dominated hypervolume over a front that noise hides."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.boxes import Boxes
from hypermap_lite.acquisition.expected_improvement import check_samples
from hypermap_lite.acquisition.hypervolume_improvement import HypervolumeImprovement
from hypermap_lite.acquisition.improvement import LinearImprovement
from hypermap_lite.acquisition.noisy_expected_improvement import NoisyExpectedImprovement
from hypermap_lite.objectives import MAX_CLOSED_FORM
from hypermap_lite.pareto.hypervolume import infer_reference_point
from hypermap_lite.scalarization.hypervolume import HypervolumeScalarization, random_direction
from hypermap_lite.surrogates.base import Conditional, Field
from hypermap_lite.typing import FloatArray

KNOWN = 1e-3
"""Standard deviation, as a share of the front's range, below which the value of an evaluated point counts as known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoisyExpectedHypervolumeImprovement:
    """Log noisy expected hypervolume improvement [1]_ [2]_, for two and three objectives.

    The noise-free values at all observed and pending points are drawn jointly by quasi-Monte Carlo; each draw has its
    own front, and the growth of its hypervolume is expected in closed form. So a lucky observation does not hide what
    lies behind it, all trade-offs are weighed at once, and no weights are drawn. Where the values at the observed
    points are known as good as exactly, and none is pending, one front is enough.

    With one objective it is noisy expected improvement; with more than three, that of the scalarization whose mean
    over random directions is the hypervolume [3]_.

    References
    ----------
    .. [1] Daulton, Balandat, Bakshy. Parallel Bayesian Optimization of Multiple Noisy Objectives with Expected
       Hypervolume Improvement. NeurIPS 2021.
    .. [2] Ament et al. Unexpected Improvements to Expected Improvement for Bayesian Optimization. NeurIPS 2023.
    """

    samples: int = 32
    """Draws of the noise-free values; a forest has as many as trees instead."""

    screening: int = 8
    """Samples that choose, of all candidates, those that are scored in full; 0 scores all of them in full."""

    is_logarithmic: ClassVar[bool] = True
    is_scalarizing: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_samples(self.samples, self.screening)

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        m = context.Y.shape[1]
        posterior, scale = context.posterior, context.normalization.scale
        prediction = posterior.predict(context.X)
        is_known = posterior.is_differentiable and not len(context.X_pending)
        is_known = is_known and bool((prediction.std < KNOWN * scale).all())
        if m == 1 and is_known:
            return self._of_known_scalar(context, prediction.mean)
        if m == 1:
            return self._of_scalar(context)
        reference_point = context.reference_point
        if reference_point is None:
            reference_point = infer_reference_point(prediction.mean)
        if m > MAX_CLOSED_FORM:
            scalarization = HypervolumeScalarization(corner=context.normalization(reference_point))
            weights = random_direction(m, context.rng)
            return self._of_scalar(replace(context, scalarization=scalarization, weights=weights))
        field: Field = posterior.field
        fronts = prediction.mean[None]
        if not is_known:
            fantasies = posterior.fantasies(context.X_pending, self.samples, context.rng)
            fronts, field = fantasies.values, fantasies.field
        if context.beside is not None:
            beside = np.broadcast_to(context.beside, (len(fronts), *context.beside.shape))
            fronts = np.concatenate([fronts, beside], axis=1)
        return HypervolumeImprovement(
            field=_Scaled(field, scale),
            screening=self.screening,
            boxes=Boxes.of(fronts / scale, reference_point / scale),
            is_differentiable=posterior.is_differentiable,
        )

    @staticmethod
    def _of_known_scalar(context: AcquisitionContext, mean: FloatArray) -> Scorer:
        """Return expected improvement over the best value, which is known."""
        return LinearImprovement(
            field=context.posterior.field,
            incumbents=mean.min(axis=0, keepdims=True),
            weights=context.weights,
            scale=context.normalization.scale,
            is_differentiable=context.posterior.is_differentiable,
        )

    def _of_scalar(self, context: AcquisitionContext) -> Scorer:
        return NoisyExpectedImprovement(samples=self.samples, screening=self.screening).scorer(context)


@dataclass(frozen=True, slots=True)
class _Scaled:
    """A field in units of the front's range, so that the product of all objectives is neither huge nor tiny."""

    inner: Field
    scale: FloatArray

    def __call__(self, X: FloatArray) -> Conditional:
        c = self.inner(X)
        pull = c.pullback

        def pullback(by_mean: FloatArray, by_std: FloatArray) -> FloatArray:
            assert pull is not None
            return pull(by_mean / self.scale, by_std / self.scale)

        return Conditional(
            mean=c.mean / self.scale, std=np.asarray(c.std / self.scale), pullback=None if pull is None else pullback
        )
