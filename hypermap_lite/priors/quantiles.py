"""Inverse distribution functions: where on its axis a prior reaches a given probability."""

from __future__ import annotations

import numpy as np

from hypermap_lite.priors.base import Density, JointDensity
from hypermap_lite.priors.mixture import MarginalMixture, MixtureDensity
from hypermap_lite.priors.product import AsJoint, ProductPrior
from hypermap_lite.typing import FloatArray

HALVINGS = 50
"""Of the unit interval, until the place of a probability is known to the last digits."""

CELLS = 8192
"""Cells of the table that stands in for a distribution function nobody can write down."""


def quantiles(prior: ProductPrior, axis: int, p: FloatArray) -> FloatArray:
    """Return the places on one axis at which the prior's marginal reaches n probabilities in (0, 1), shape (n,).

    Exact for priors on single parameters and Gaussian mixtures; for kernel density estimates, whose kernels are far
    wider than a cell, from a table.
    """
    for axes, density in prior.factors:
        if axis in axes:
            return _quantiles(density.marginal([axes.index(axis)]), p)
    return p


def _quantiles(density: JointDensity, p: FloatArray) -> FloatArray:
    """Return the quantiles of a density on a single axis."""
    if isinstance(density, ProductPrior):
        return quantiles(density, 0, p)
    if isinstance(density, AsJoint):
        return _bisect(density.density, p)
    if isinstance(density, MixtureDensity):
        return _bisect(MarginalMixture(density), p)
    middles = (np.arange(CELLS) + 0.5) / CELLS
    masses = np.exp(density.log_density(middles[:, None]))
    cumulated = np.concatenate([[0.0], np.cumsum(masses)])
    return np.interp(p, cumulated / cumulated[-1], np.linspace(0.0, 1.0, CELLS + 1))


def _bisect(density: Density, p: FloatArray) -> FloatArray:
    """Return the places where the distribution function reaches p; where it is flat, the end of the flat part."""
    low, high = np.zeros(len(p)), np.ones(len(p))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        is_below = density.cdf(middle) <= p
        low, high = np.where(is_below, middle, low), np.where(is_below, high, middle)
    return (low + high) / 2
