"""Scalarizations: several objectives turned into one, and how their weights are drawn."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.scalarization.base import Normalization, Scalarization, WeightSampling
from hypermap_lite.scalarization.linear import Linear
from hypermap_lite.scalarization.modified_tchebyshev import ModifiedTchebyshev
from hypermap_lite.scalarization.tchebyshev import Tchebyshev
from hypermap_lite.scalarization.weights import BoundingBox, Dirichlet

SCALARIZATIONS: Final[Mapping[str, type[Scalarization]]] = {
    "linear": Linear,
    "tchebyshev": Tchebyshev,
    "modified_tchebyshev": ModifiedTchebyshev,
}
"""JSON name of each scalarization."""

WEIGHTS: Final[Mapping[str, type[WeightSampling]]] = {"dirichlet": Dirichlet, "bounding_box": BoundingBox}
"""JSON name of each way to draw weights."""

__all__ = [
    "SCALARIZATIONS",
    "WEIGHTS",
    "BoundingBox",
    "Dirichlet",
    "Linear",
    "ModifiedTchebyshev",
    "Normalization",
    "Scalarization",
    "Tchebyshev",
    "WeightSampling",
]
