r"""Evaluations far worse than the others foretell, such as a skill that failed for no reason of its parameters.

One of them is enough to spoil a Gaussian process: it passes for a cliff, by which the lengthscales and the noise of the
whole space are judged. So outputs are set aside as long as that makes all of them much likelier [1]_. One that is set
aside is normal around what the others predict of it, with the variance that suits it best, which makes its density

.. math:: 1 / (\sqrt{2 \pi e} \, |y - \mu(x)|)

times the odds of an outlier; the hyperparameters are fitted anew to what is left. Several outliers hide each other, for
by hyperparameters that suit one of them the next is no surprise. So a search begins with those of a fit to fewer
evaluations, and what would be surprising next, and then next, is tried together, or half of it.

An outlier is alone. One that the others foretell, outliers included, has a reason, such as a cliff that two evaluations
have fallen off; it counts again [2]_. And only what is worse than expected is ever set aside: what is surprisingly good
is what a search is for.

References
----------
.. [1] Ament et al. Robust Gaussian Processes via Relevance Pursuit. NeurIPS 2024.
.. [2] Martinez-Cantin, Tee, McCourt. Practical Bayesian Optimization in the Presence of Outliers. AISTATS 2018.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from hypermap_lite.surrogates.fitted import Fitted
from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters, MarginalLikelihood, fit_hyperparameters
from hypermap_lite.surrogates.offsets import SAYS_NOTHING, Offsets
from hypermap_lite.surrogates.process import Process, Standardized
from hypermap_lite.typing import BoolArray, FloatArray

RARE: Final = 0.02
"""Share of evaluations that are outliers, as far as is known beforehand."""

SUSPECT: Final = 2.5
"""By how many standard deviations an output is worse than expected before it is looked at."""

MARGIN: Final = 10.0
"""Log of the factor by which outputs must be likelier where more of them are set aside.

A rough function, as of a skill with cliffs, has many evaluations that seem to be outliers by less.
"""

MOST: Final = 0.2
"""Largest share of outliers. What happens more often is no exception."""

LOG_ODDS: Final = math.log(RARE / (1 - RARE))

FORETOLD: Final = 0.5
"""An outlier, which is a 1 where other outputs are 0, is alone if its neighbours predict less."""

FEWEST: Final = 8
"""With fewer outputs none is set aside."""

LOG_SQRT_2_PI_E: Final = 0.5 * math.log(2 * math.pi * math.e)


def fitted_without_outliers(
    likelihood: MarginalLikelihood,
    y: FloatArray,
    starts: Sequence[Hyperparameters],
    before: Sequence[int] = (),
    *,
    is_exact: bool,
) -> Fitted:
    """Return the fit of one objective with its outliers saying nothing.

    Parameters
    ----------
    likelihood
        Of n standardized outputs that nothing is known of beforehand.
    y
        These outputs in their own units, to be minimized, shape (n,).
    starts
        Of the fit, as of others below that start from the mode of the prior, too.
    before
        Which of the outputs were outliers among fewer outputs.
    is_exact
        As in `fit_hyperparameters`.
    """
    found = _Found.fitted(likelihood, y, before, starts, is_exact=is_exact)
    if len(y) < FEWEST:
        return found.fit
    while (more := _likelier(found)) is not None:
        found = more
    while (fewer := found.with_least_surprising()) is not None and fewer.log_density > found.log_density:
        found = fewer
    while len(foretold := found.foretold()):
        found = found.with_outliers(foretold, are_outliers=False)
    return found.fit


def _likelier(found: _Found) -> _Found | None:
    """Return the same with more outliers, if that is much likelier."""
    suspects = found.suspects()
    k = len(suspects)
    while k:
        tried = found.with_outliers(suspects[:k], are_outliers=True)
        if tried.log_density > found.log_density + MARGIN:
            return tried
        k //= 2
    return None


@dataclass(frozen=True, kw_only=True)
class _Found:
    """A fit, and which of its outputs say nothing."""

    fit: Fitted
    is_outlier: BoolArray
    y: FloatArray
    is_exact: bool

    @classmethod
    def fitted(
        cls,
        likelihood: MarginalLikelihood,
        y: FloatArray,
        outliers: Sequence[int],
        starts: Sequence[Hyperparameters],
        *,
        is_exact: bool,
    ) -> _Found:
        """Fit what is left without some of the outputs."""
        is_outlier = np.zeros(len(y), dtype=bool)
        is_outlier[list(outliers)] = True
        output, offsets = Standardized.of(y), None
        if is_outlier.any():
            output, offsets = Standardized.without(y, is_outlier), Offsets.of_outliers(is_outlier)
        likelihood = replace(likelihood, y=output.values, offsets=offsets)
        best = fit_hyperparameters(likelihood, starts, is_exact=is_exact)
        fit = Fitted(output=output, likelihood=likelihood, hyperparameters=best)
        return cls(fit=fit, is_outlier=is_outlier, y=y, is_exact=is_exact)

    def suspects(self) -> list[int]:
        """Return outputs that are surprisingly bad, each the most surprising one where those before it are left out."""
        is_outlier = self.is_outlier.copy()
        suspects: list[int] = []
        while is_outlier.sum() + 1 <= MOST * len(is_outlier):
            likelihood = replace(self.fit.likelihood, offsets=Offsets.of_outliers(is_outlier))
            distance, std = replace(self.fit, likelihood=likelihood).process().left_out()
            surprise = np.where(is_outlier, -np.inf, distance / std)
            worst = int(np.argmax(surprise))
            if not surprise[worst] >= SUSPECT:
                break
            suspects.append(worst)
            is_outlier[worst] = True
        return suspects

    def with_outliers(self, outputs: Sequence[int], *, are_outliers: bool) -> _Found:
        """Return the same with other outputs taken for outliers, or not."""
        is_outlier, likelihood = self.is_outlier.copy(), self.fit.likelihood
        is_outlier[list(outputs)] = are_outliers
        starts = [self.fit.hyperparameters, likelihood.prior.mode()]
        return _Found.fitted(likelihood, self.y, np.flatnonzero(is_outlier).tolist(), starts, is_exact=self.is_exact)

    def foretold(self) -> list[int]:
        """Return the outliers of which the others, outliers or not, foretell that they are."""
        given = self.fit.likelihood
        marks = Standardized(self.is_outlier.astype(float), 0.0, 1.0)
        process = Process.condition(given.X, marks, self.fit.hyperparameters, given.is_ordered, given.permutations)
        distance, _ = process.left_out()
        return np.flatnonzero(self.is_outlier & (distance <= 1 - FORETOLD)).tolist()

    def with_least_surprising(self) -> _Found | None:
        """Return the same with the least surprising outlier back, if it would be likelier as none; None otherwise."""
        outputs = np.flatnonzero(self.is_outlier)
        if not len(outputs):
            return None
        distance, std = self._surprises
        square = np.maximum((distance / std) ** 2, 1.0)
        gain = 0.5 * (square - 1 - np.log(square)) + LOG_ODDS  # in log density, of being set aside
        least = int(np.argmin(gain))
        return self.with_outliers(outputs[least : least + 1].tolist(), are_outliers=False) if gain[least] < 0 else None

    @cached_property
    def log_density(self) -> float:
        """Log density of all outputs in their own units, of the hyperparameters, and of which are outliers."""
        k, scale = int(self.is_outlier.sum()), self.fit.output.scale
        others = -self.fit.likelihood(self.fit.hyperparameters.to_log())[0] - (len(self.y) - k) * math.log(scale)
        if not k:
            return others
        nothing = -0.5 * math.log(2 * math.pi * SAYS_NOTHING)  # each one's part in the likelihood
        distance = np.maximum(np.abs(self._surprises[0]), np.finfo(float).tiny)
        return others + k * (LOG_ODDS - nothing - LOG_SQRT_2_PI_E) - float(np.log(distance).sum())

    @cached_property
    def _surprises(self) -> tuple[FloatArray, FloatArray]:
        """How far the outliers are above what the others predict, and its std, shape (k,), in the outputs' units."""
        process, output = self.fit.process(), self.fit.output
        mean, covariance = process.joint(process.X[self.is_outlier])
        variance = np.diag(covariance) + process.hyperparameters.noise_variance
        return self.y[self.is_outlier] - output.offset - output.scale * mean, output.scale * np.sqrt(variance)
