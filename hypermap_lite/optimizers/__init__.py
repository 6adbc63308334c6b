"""Optimizers: what suggests the next configuration.

Their JSON names are those of `OPTIMIZERS`; `hypermap_lite.assembly` puts their parts together.
"""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.optimizers.base import Optimizer
from hypermap_lite.optimizers.cma_es import CmaEs
from hypermap_lite.optimizers.evolutionary import Evolution
from hypermap_lite.optimizers.local_search import HillClimbing
from hypermap_lite.optimizers.model_free import Search

SEARCHES: Final[Mapping[str, type[Search]]] = {
    "local_search": HillClimbing,
    "evolutionary": Evolution,
    "cma_es": CmaEs,
}
"""JSON name of each search that needs no model."""

OPTIMIZERS: Final[tuple[str, ...]] = ("bayesian", "random_search", "prior_sampling", *SEARCHES)
"""JSON name of each optimizer."""

__all__ = ["OPTIMIZERS", "SEARCHES", "CmaEs", "Evolution", "HillClimbing", "Optimizer", "Search"]
