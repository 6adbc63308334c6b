"""Priors over the optimum: what the user believes, as densities on the unit cube."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.priors.base import Density, JointDensity, JointPrior, MarginalPrior
from hypermap_lite.priors.beta import BetaPrior
from hypermap_lite.priors.kernel_density import KernelDensity, KernelDensityPrior
from hypermap_lite.priors.mixture import JointMixturePrior, MixturePrior
from hypermap_lite.priors.piecewise import PiecewisePrior
from hypermap_lite.priors.product import AsJoint, ProductPrior
from hypermap_lite.priors.truncated_gaussian import GaussianPrior
from hypermap_lite.priors.uniform import UniformPrior
from hypermap_lite.priors.weights import WeightsPrior

PRIORS: Final[Mapping[str, type[MarginalPrior]]] = {
    "uniform": UniformPrior,
    "gaussian": GaussianPrior,
    "mixture": MixturePrior,
    "beta": BetaPrior,
    "weights": WeightsPrior,
    "piecewise": PiecewisePrior,
}
"""JSON name of each prior over one parameter."""

JOINT_PRIORS: Final[Mapping[str, type[JointPrior]]] = {
    "mixture": JointMixturePrior,
    "kde": KernelDensityPrior,
}
"""JSON name of each prior over several parameters."""

__all__ = [
    "JOINT_PRIORS",
    "PRIORS",
    "AsJoint",
    "BetaPrior",
    "Density",
    "GaussianPrior",
    "JointDensity",
    "JointMixturePrior",
    "JointPrior",
    "KernelDensity",
    "KernelDensityPrior",
    "MarginalPrior",
    "MixturePrior",
    "PiecewisePrior",
    "ProductPrior",
    "UniformPrior",
    "WeightsPrior",
]
