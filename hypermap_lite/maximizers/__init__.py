"""Maximizers: the search for the point with the best acquisition value."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.maximizers.base import MaximizationProblem, Maximizer, Maximum
from hypermap_lite.maximizers.cma_es import CmaEs
from hypermap_lite.maximizers.local_search import LocalSearch
from hypermap_lite.maximizers.multistart_gradient import MultistartGradient

MAXIMIZERS: Final[Mapping[str, type[Maximizer]]] = {
    "multistart_gradient": MultistartGradient,
    "local_search": LocalSearch,
    "cma_es": CmaEs,
}
"""JSON name of each maximizer."""

__all__ = ["MAXIMIZERS", "CmaEs", "LocalSearch", "MaximizationProblem", "Maximizer", "Maximum", "MultistartGradient"]
