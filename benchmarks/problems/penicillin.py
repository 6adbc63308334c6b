"""A batch of penicillin: yield, carbon dioxide and hours of a fermentation."""

from __future__ import annotations

import numpy as np

from .base import FloatArray

MAX_HOURS = 2500
MAX_VOLUME = 180.0
"""Of the vessel, at which the fermentation ends."""

STALLED = 1e-11
"""Growth of the yield per hour below which the fermentation ends."""

GAS_CONSTANT = 1.9872
"""In cal/(mol K)."""


def penicillin(X: FloatArray) -> FloatArray:
    """Return the negative yield, the carbon dioxide and the hours of a fermentation, stepped hour by hour [1]_.

    Parameters
    ----------
    X
        Culture volume, biomass concentration, temperature [K], glucose concentration, feed rate of the substrate, its
        concentration, and pH: shape (n, 7).

    References
    ----------
    .. [1] Liang, Lai. Scalable Bayesian Optimization Accelerates Process Optimization of Penicillin Production.
       NeurIPS Workshop on AI for Science, 2021; after Bajpai and Reuss (1980) and Birol et al. (2002).
    """
    volume, biomass, temperature, glucose, feed, feed_glucose, ph = X.T.copy()
    acid = 10.0**-ph
    loss_share = 2.5e-4 * np.expm1(5 * (temperature - 373) / (273 - 373))
    by_acid = 0.092 / (1 + 1e-10 / acid + acid / 7e-5)
    by_heat = 7e3 * np.exp(-5100 / (GAS_CONSTANT * temperature))
    by_heat -= 1e33 * np.exp(-50_000 / (GAS_CONSTANT * temperature))
    product, gas = np.zeros(len(X)), np.zeros(len(X))
    hours, going = np.full(len(X), float(MAX_HOURS)), np.ones(len(X), dtype=bool)
    for hour in range(1, MAX_HOURS + 1):
        filling = feed - volume * loss_share
        growth = by_acid * by_heat * glucose / (0.15 * biomass + glucose)
        making = 0.005 * glucose / (0.0002 + glucose + glucose**2 / 0.1)
        more_biomass = growth * biomass - biomass / volume * filling
        eaten = biomass * (growth / 0.45 + making / 0.9 + 0.014)
        more_glucose = feed * feed_glucose / volume - eaten - glucose / volume * filling
        more_product = making * biomass - 0.04 * product - product / volume * filling
        more_gas = 0.143 * more_biomass + 4e-7 * biomass + 1e-4
        product += going * more_product
        volume += going * filling
        biomass += going * more_biomass
        glucose += going * more_glucose
        gas += going * more_gas
        ends = going & ((volume > MAX_VOLUME) | (glucose < 0) | (more_product < STALLED))
        hours[ends] = hour
        going &= ~ends
        if not going.any():
            break
    return np.column_stack([-product, gas, hours])
