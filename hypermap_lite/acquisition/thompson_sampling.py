"""The best point of one function drawn from the posterior."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.scalarized_field import ScalarizedField
from hypermap_lite.errors import ScenarioError


@dataclass(frozen=True, slots=True, kw_only=True)
class ThompsonSampling:
    """Scalarization of one joint draw of all objectives [1]_; batches spread by themselves.

    References
    ----------
    .. [1] Thompson. On the Likelihood That One Unknown Probability Exceeds Another. Biometrika, 1933.
    """

    features: int = 1024
    """Random features of a drawn function; a forest draws a tree instead."""

    is_logarithmic: ClassVar[bool] = False
    is_scalarizing: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if self.features < 1:
            raise ScenarioError("$.features", f"there are {self.features} features", allowed="an integer >= 1")

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        return ScalarizedField(
            field=context.posterior.sample_path(context.rng, self.features),
            beta=0.0,
            scalarization=context.scalarization,
            weights=context.weights,
            normalization=context.normalization,
            is_differentiable=context.posterior.is_differentiable,
        )
