"""Optimizers: what suggests the next configuration.

Their JSON names are those of `OPTIMIZERS`; `hypermap_lite.assembly` puts their parts together.
"""

from typing import Final

from hypermap_lite.optimizers.base import Optimizer

OPTIMIZERS: Final[tuple[str, ...]] = ("bayesian", "random_search", "prior_sampling")
"""JSON name of each optimizer."""

__all__ = ["OPTIMIZERS", "Optimizer"]
