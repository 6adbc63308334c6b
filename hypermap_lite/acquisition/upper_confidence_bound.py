"""The optimistic bound of the objectives."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.scalarized_field import ScalarizedField
from hypermap_lite.errors import ScenarioError


@dataclass(frozen=True, slots=True, kw_only=True)
class UpperConfidenceBound:
    """Scalarization of each objective's optimistic bound [1]_: mean - beta std, as all are minimized here.

    Pending points count as evaluated at their predicted means.

    References
    ----------
    .. [1] Srinivas et al. Gaussian Process Optimization in the Bandit Setting. ICML 2010.
    """

    beta: float = 2.0
    """Width of the bound, in posterior standard deviations."""

    def __post_init__(self) -> None:
        if not self.beta >= 0:
            raise ScenarioError("$.beta", f"the width is {self.beta}", allowed="a number >= 0")

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        posterior = context.posterior.believe(context.X_pending)
        return ScalarizedField(
            field=posterior.field,
            beta=self.beta,
            scalarization=context.scalarization,
            weights=context.weights,
            normalization=context.normalization,
            is_differentiable=posterior.is_differentiable,
        )
