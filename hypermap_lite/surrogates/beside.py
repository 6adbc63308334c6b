"""Errors of what is reported beside the evaluations that count, as by infeasible ones."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters, MarginalLikelihood
from hypermap_lite.typing import FloatArray

SHARED_ERROR: Final = 1.0
"""Variance, in units of the standardized outputs, of the constant by which what is reported beside may be off."""

OWN_ERRORS: Final = (0.0, 0.01, 0.1)
"""Variances of what each such output may be off by besides."""

NONSENSE: Final = (0.3, 1.0, 3.0, 10.0, 30.0)
"""Variances of such outputs if they have nothing to do with the objective."""

SAYS_NOTHING: Final = 1e6
"""Variance of an error with which an output says nothing."""


def with_likely_errors(likelihood: MarginalLikelihood, h: Hyperparameters, n_beside: int) -> MarginalLikelihood:
    """Return a likelihood with the errors of its last rows that are likely by given hyperparameters.

    What is reported beside the evaluations that count need not be the objective. It may be off by a constant, such as a
    penalty, which is unknown a priori, and by something of its own at each point, of which the most likely one of
    `OWN_ERRORS` is taken. If draws that have nothing to do with the objective are as likely, the rows say nothing.
    """
    n, theta = len(likelihood.y), h.to_log()
    is_beside = (np.arange(n) >= n - n_beside).astype(float)
    shared = SHARED_ERROR * np.outer(is_beside, is_beside)
    options = [replace(likelihood, errors=shared + own * np.diag(is_beside)) for own in OWN_ERRORS]
    losses = [option(theta)[0] for option in options]
    known = likelihood.known_noise
    alone = replace(
        likelihood,
        X=likelihood.X[:-n_beside],
        y=likelihood.y[:-n_beside],
        known_noise=None if known is None else known[:-n_beside],
    )
    if min(losses) < alone(theta)[0] + loss_of_nonsense(likelihood.y[-n_beside:]):
        return options[int(np.argmin(losses))]
    return replace(likelihood, errors=shared + SAYS_NOTHING * np.diag(is_beside))


def loss_of_nonsense(y: FloatArray) -> float:
    """Return minus the log density of outputs, shape (k,), around an unknown constant and with nothing in common else.

    By the most likely of the variances `NONSENSE`.
    """
    k = len(y)
    own = np.array(NONSENSE)
    joint = own + k * SHARED_ERROR  # eigenvalue of the covariance along the constant; the others are own
    along, across = float(y.sum()) ** 2 / k, float(y @ y) - float(y.sum()) ** 2 / k
    losses = along / joint + across / own + np.log(joint) + (k - 1) * np.log(own) + k * math.log(2 * math.pi)
    return float(losses.min()) / 2
