"""Initial designs: what is evaluated before there is a model."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.design.base import InitialDesign
from hypermap_lite.design.grid import Grid
from hypermap_lite.design.latin_hypercube import KLatinHypercube, LatinHypercube, PriorLatinHypercube
from hypermap_lite.design.prior_sampling import PriorSampling
from hypermap_lite.design.random_sampling import RandomSampling
from hypermap_lite.design.sobol import Sobol

DESIGNS: Final[Mapping[str, type[InitialDesign]]] = {
    "random_sampling": RandomSampling,
    "prior_sampling": PriorSampling,
    "latin_hypercube": LatinHypercube,
    "k_latin_hypercube": KLatinHypercube,
    "prior_latin_hypercube": PriorLatinHypercube,
    "sobol": Sobol,
    "grid": Grid,
}
"""JSON name of each initial design."""

__all__ = [
    "DESIGNS",
    "Grid",
    "InitialDesign",
    "KLatinHypercube",
    "LatinHypercube",
    "PriorLatinHypercube",
    "PriorSampling",
    "RandomSampling",
    "Sobol",
]
