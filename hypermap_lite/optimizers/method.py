"""The replaceable parts of Bayesian optimization."""

from __future__ import annotations

from dataclasses import dataclass

from hypermap_lite.acquisition.base import Acquisition, PriorWeighting
from hypermap_lite.acquisition.feasibility_weighted import FeasibilityWeighting
from hypermap_lite.design.base import InitialDesign
from hypermap_lite.maximizers.base import Maximizer
from hypermap_lite.scalarization.base import Scalarization, WeightSampling
from hypermap_lite.surrogates.base import Surrogate


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """The replaceable parts of Bayesian optimization."""

    surrogate: Surrogate
    acquisition: Acquisition
    scalarization: Scalarization
    weights: WeightSampling
    prior_weighting: PriorWeighting | None
    """None leaves the prior out of the acquisition."""

    feasibility_weighting: FeasibilityWeighting | None
    """None leaves infeasible evaluations out of the acquisition."""

    maximizer: Maximizer
    fallback: InitialDesign
    """Draws a point where there is nothing to model yet."""

    epsilon: float = 0.0
    """Probability that a suggestion is drawn uniformly instead: a way out of a misleading prior or model [1]_.

    References
    ----------
    .. [1] Nardi, Koeplinger, Olukotun. Practical Design Space Exploration. MASCOTS 2019 (HyperMapper).
    """

    escapes: int = 3
    """Draws between two suggestions of a model that promises nothing and has found nothing; 0 for none."""

    boundary_factor: float = 0.3
    """Least factor of what a point promises, for each bound that it is on, while such promises are broken, in (0, 1]; 1
    for none. See `optimizers.boundary`."""

    separation: float = 0.0
    """Smallest distance to a configuration under evaluation, in the largest coordinate difference; 0 for any."""
