"""The optimistic bound of the objectives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from hypermap_lite.acquisition.base import AcquisitionContext, Scorer
from hypermap_lite.acquisition.scalarized_field import ScalarizedField
from hypermap_lite.errors import ScenarioError

LOGARITHMIC = "logarithmic"
"""In place of a width: one that grows with the logarithm of the number of batches."""


@dataclass(frozen=True, slots=True, kw_only=True)
class UpperConfidenceBound:
    """Scalarization of each objective's optimistic bound [1]_: mean - beta std, as all are minimized here.

    Pending points count as evaluated at their predicted means.

    References
    ----------
    .. [1] Srinivas et al. Gaussian Process Optimization in the Bandit Setting. ICML 2010.
    .. [2] Paria, Kandasamy, Poczos. A Flexible Framework for Multi-Objective Bayesian Optimization using Random
       Scalarizations. UAI 2019.
    """

    beta: float | str = 2.0
    """Width of the bound, in posterior standard deviations.

    Or ``logarithmic``: sqrt(ln(2 t + 1) / 8) at the t-th model-based batch [2]_, as HyperMapper has it.
    """

    is_logarithmic: ClassVar[bool] = False
    is_scalarizing: ClassVar[bool] = True

    def __post_init__(self) -> None:
        is_number = isinstance(self.beta, int | float)
        if not (self.beta >= 0 if is_number else self.beta == LOGARITHMIC):  # type: ignore[operator]
            problem = f"the width is {self.beta!r}"
            raise ScenarioError("$.beta", problem, allowed=f'a number >= 0 or "{LOGARITHMIC}"')

    def width(self, iteration: int) -> float:
        """Return the width of the bound at a model-based batch, counted from 1."""
        if isinstance(self.beta, str):
            return math.sqrt(math.log(2 * iteration + 1) / 8)
        return self.beta

    def scorer(self, context: AcquisitionContext) -> Scorer:
        """Become the scorer of one suggestion."""
        posterior = context.posterior.believe(context.X_pending)
        return ScalarizedField(
            field=posterior.field,
            beta=self.width(context.iteration),
            scalarization=context.scalarization,
            weights=context.weights,
            normalization=context.normalization,
            is_differentiable=posterior.is_differentiable,
        )
