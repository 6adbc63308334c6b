"""Learning from what is reported beside the evaluations that count, as by infeasible ones.

It need not be the objective. It may be off by a constant, such as a penalty, which is unknown a priori, or by something
of its own at each point, or be nonsense. So there is a discrepancy between what is reported and what is asked for, as
between a simulator and what it simulates [1]_, here without a smooth part.

References
----------
.. [1] Kennedy, O'Hagan. Bayesian Calibration of Computer Models. Journal of the Royal Statistical Society B, 2001.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from hypermap_lite.surrogates.fitted import Fitted
from hypermap_lite.surrogates.marginal_likelihood import MarginalLikelihood, fit_hyperparameters
from hypermap_lite.surrogates.offsets import SAYS_NOTHING, Offsets
from hypermap_lite.typing import BoolArray, FloatArray

SHARED: Final = 1.0
"""Variance, in units of the standardized outputs, of the constant by which what is reported beside may be off."""

OWN: Final = (0.0, 0.01, 0.1)
"""Variances of what each such output may be off by besides."""

NONSENSE: Final = (0.3, 1.0, 3.0, 10.0, 30.0)
"""Variances of such outputs if they have nothing to do with the objective."""


def with_beside(
    fits: Sequence[Fitted], X: FloatArray, Y: FloatArray, noise_variance: FloatArray | None, *, is_exact: bool
) -> Sequence[Fitted]:
    """Return the fits of m objectives with what is reported beside, if it tells something of one of them.

    Parameters
    ----------
    fits
        Of the n evaluations that count.
    X
        Points beside, shape (k, d), k >= 1.
    Y
        What is reported there, shape (k, m); NaN where that says nothing.
    noise_variance
        As in `Surrogate.fit`, of these rows; None where it is learned.
    is_exact
        As in `fit_hyperparameters`.
    """
    found = []
    for k, fit in enumerate(fits):
        output, likelihood = fit.output.also(np.where(np.isnan(Y[:, k]), fit.output.offset, Y[:, k])), fit.likelihood
        known = likelihood.known_noise
        if known is not None and noise_variance is not None:
            known = np.append(known, output.noise(noise_variance[:, k]))
        whole = replace(likelihood, X=np.vstack([likelihood.X, X]), y=output.values, known_noise=known)
        whole_fit = replace(fit, output=output, likelihood=whole)
        found.append(_learned(fit, whole_fit, ~np.isnan(Y[:, k]), is_exact=is_exact))
    return [wide for wide, _ in found] if any(tells for _, tells in found) else fits


def _learned(alone: Fitted, whole: Fitted, may_tell: BoolArray, *, is_exact: bool) -> tuple[Fitted, bool]:
    """Return a fit with the likely offsets of k outputs beside, and whether these say anything.

    Those that `may_tell`, shape (k,), have an offset of their own each, of the likeliest variance. They say nothing if
    nonsense is as likely.
    """
    n, h = len(alone.output.values), alone.hyperparameters
    is_beside = np.append(np.zeros(n, dtype=bool), may_tell)
    so_far = np.zeros(n) if alone.likelihood.offsets is None else alone.likelihood.offsets.own

    def off_by(shared: float, own: float) -> MarginalLikelihood:
        every = np.append(so_far, np.where(may_tell, own, SAYS_NOTHING))
        return replace(whole.likelihood, offsets=Offsets(is_beside, shared, every))

    nothing = replace(whole, likelihood=off_by(0.0, SAYS_NOTHING))
    if not may_tell.any():
        return nothing, False
    options = [off_by(SHARED, own) for own in OWN]
    likely = min(options, key=lambda option: option(h.to_log())[0])
    fitted = fit_hyperparameters(likely, [h], is_exact=is_exact)
    loss = loss_of_nonsense(whole.output.values[n:][may_tell])
    loss += 0.5 * (~may_tell).sum() * math.log(2 * math.pi * SAYS_NOTHING)  # their part in the likelihood
    if likely(fitted.to_log())[0] < alone.likelihood(h.to_log())[0] + loss:
        return replace(whole, likelihood=likely, hyperparameters=fitted), True
    return nothing, False


def loss_of_nonsense(y: FloatArray) -> float:
    """Return minus the log density of outputs, shape (k,), around an unknown constant and with nothing in common else.

    By the most likely of the variances `NONSENSE`.
    """
    k = len(y)
    own = np.array(NONSENSE)
    joint = own + k * SHARED  # eigenvalue of the covariance along the constant; the others are own
    along, across = float(y.sum()) ** 2 / k, float(y @ y) - float(y.sum()) ** 2 / k
    losses = along / joint + across / own + np.log(joint) + (k - 1) * np.log(own) + k * math.log(2 * math.pi)
    return float(losses.min()) / 2
