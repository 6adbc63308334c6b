"""Whether a black box has noise at all: roughness that is taken for noise is never looked into.

Values that go up and down within a fraction of the space are explained by short lengthscales without noise, or by long
ones with it, and each explanation is a maximum of the marginal likelihood of its own [1]_. With noise a search expects
nothing between its evaluations and repeats the best of them; without it, it finds out. So the two are compared as two
models, as likely as each other before any data. What else is judged before (tails, failures, outliers) is judged by the
model with noise.

References
----------
.. [1] Rasmussen, Williams. Gaussian Processes for Machine Learning, fig. 5.5. MIT Press, 2006.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from hypermap_lite.surrogates.fitted import Fitted
from hypermap_lite.surrogates.marginal_likelihood import fit_hyperparameters

FEWEST: Final = 16
"""With fewer outputs the noise is believed: too few are close to each other to tell it from roughness."""

NOTICEABLE: Final = 0.01
"""Variance of a noise, in units of the standardized outputs, that can hide something."""


def likelier_without_noise(fit: Fitted, *, is_exact: bool) -> Fitted | None:
    """Return what explains the outputs without noise, if that is likelier.

    The densities of outputs and hyperparameters at their maxima are compared, that of a noise relative to the most
    likely one. What it costs a model that it has a noise to learn, a factor of about seven by Laplace's approximation,
    is not counted: in doubt the noise is believed.

    Parameters
    ----------
    fit
        With noise, which is learned.
    is_exact
        As in `fit_hyperparameters`.
    """
    given, noise = fit.likelihood, fit.hyperparameters.noise_variance
    if len(fit.output.values) < FEWEST or noise <= max(NOTICEABLE, given.prior.noise_floor):
        return None
    free = replace(given, prior=replace(given.prior, has_noise=False))
    best = fit_hyperparameters(free, [fit.hyperparameters], is_exact=is_exact)
    noisy = given(fit.hyperparameters.to_log())[0] - given.prior.penalty_of_usual_noise
    if free(best.to_log())[0] >= noisy:
        return None
    return Fitted(output=fit.output, likelihood=free, hyperparameters=best)
