"""How uncertain a mean over few replicates is: sample variances, shrunk towards what all configurations have in common.

A variance from r replicates has r - 1 degrees of freedom, so with three of them it is off by a factor of two as a rule,
and three equal results do not mean that there is no noise. Other configurations tell what is usual.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from hypermap_lite.typing import FloatArray

PRIOR_FREEDOM: Final = 4.0
"""Weight of what is usual, in degrees of freedom: as much as five replicates of the configuration itself."""


def shrunk_variances(
    variances: FloatArray, freedom: FloatArray, prior_freedom: float = PRIOR_FREEDOM
) -> FloatArray | None:
    """Estimate the variance of single replicates at each configuration, by empirical Bayes.

    The variances of the configurations are taken as draws from a scaled inverse chi-square distribution with
    `prior_freedom` degrees of freedom, whose scale is the pooled variance s0^2 = sum(nu s^2) / sum(nu). Given a sample
    variance s^2 with nu degrees of freedom, its posterior is of the same kind, with the scale
    (nu0 s0^2 + nu s^2) / (nu0 + nu) [1]_, which is the estimate: a weighted mean of the sample's own variance and
    the pooled one. It is never below the share nu0 / (nu0 + nu) of the pooled variance.

    Parameters
    ----------
    variances
        Of the sample at each of n configurations (divisor r - 1), shape (n, m); whatever where `freedom` is zero.
    freedom
        Degrees of freedom of each, shape (n, m), >= 0.
    prior_freedom
        nu0, > 0.

    Returns
    -------
    FloatArray or None
        Shape (n, m); None if an objective has no degree of freedom anywhere, so that nothing is known of its noise.

    References
    ----------
    .. [1] Smyth. Linear Models and Empirical Bayes Methods for Assessing Differential Expression in Microarray
       Experiments. Statistical Applications in Genetics and Molecular Biology, 2004.

    Examples
    --------
    >>> shrunk_variances(np.array([[1.0], [3.0]]), np.array([[2.0], [2.0]]), prior_freedom=2.0)
    array([[1.5],
           [2.5]])
    """
    squares = freedom * np.where(freedom > 0, variances, 0.0)
    total = freedom.sum(axis=0)
    if not len(freedom) or not (total > 0).all():
        return None
    usual = squares.sum(axis=0) / total
    return np.asarray((prior_freedom * usual + squares) / (prior_freedom + freedom))
