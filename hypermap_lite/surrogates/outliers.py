r"""Evaluations far worse than the others foretell, such as a skill that failed for no reason of its parameters.

One of them is enough to spoil a Gaussian process: it passes for a cliff, by which the lengthscales and the noise of the
whole space are judged. So outputs are set aside as long as that makes all of them much likelier [1]_. One that is set
aside is normal around what the others predict of it, with the variance that suits it best, which makes its density

.. math:: 1 / (\sqrt{2 \pi e} \, |y - \mu(x)|)

times the odds of an outlier; the hyperparameters are fitted anew to what is left. Several outliers hide each other, for
by hyperparameters that suit one of them the next is no surprise. So a search begins with those of a fit to fewer
evaluations, and what would be surprising next, and then next, is tried together, or half of it.

An outlier is alone: its nearest neighbour is not as bad. Once there is such a one, both have a reason, such as a cliff
that they have fallen off, and count [2]_. And only what is worse than expected is ever set aside: what is surprisingly
good is what a search is for.

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
from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters, MarginalLikelihood, fit_hyperparameters
from hypermap_lite.surrogates.offsets import SAYS_NOTHING, Offsets
from hypermap_lite.surrogates.process import Standardized
from hypermap_lite.typing import BoolArray, FloatArray, IntArray

RARE: Final = 0.02
"""Share of evaluations that are outliers, as far as is known beforehand."""

LOG_ODDS: Final = math.log(RARE / (1 - RARE))

SUSPECT: Final = 2.5
"""By how many standard deviations an output is worse than expected before it is looked at."""

GROSS: Final = 5.0
"""The same where the expectation is that of a fit to fewer outputs, which is too sure of itself."""

MARGIN: Final = 10.0
"""Log of the factor by which outputs must be likelier where more of them are set aside.

A rough function, as of a skill with cliffs, has many evaluations that seem to be outliers by less.
"""

MOST: Final = 0.2
"""Largest share of outliers. What happens more often is no exception."""

FEWEST: Final = 12
"""With fewer outputs none is set aside."""

LOG_SQRT_2_PI_E: Final = 0.5 * math.log(2 * math.pi * math.e)


@dataclass(frozen=True, slots=True, kw_only=True)
class Start:
    """What was found of the first n outputs, from which a fit to more may start."""

    n: int
    hyperparameters: Hyperparameters
    scale: float
    """Of the outputs, in whose units the hyperparameters are."""

    outliers: tuple[int, ...]


def without_outliers(
    likelihood: MarginalLikelihood,
    y: FloatArray,
    starts: Sequence[Hyperparameters],
    before: Start | None = None,
    *,
    is_exact: bool,
) -> Found:
    """Find the outliers of one objective, and fit with these saying nothing.

    Parameters
    ----------
    likelihood
        Of n standardized outputs that nothing is known of beforehand.
    y
        These outputs in their own units, to be minimized, shape (n,).
    starts
        Of the fit, and of those that set outputs aside.
    before
        What a fit to the first of the outputs has found; None if there is none.
    is_exact
        As in `fit_hyperparameters`.
    """
    found = Found.fitted(likelihood, y, () if before is None else before.outliers, starts, is_exact=is_exact)
    if len(y) < FEWEST:
        return found
    found = _without_mistakes(found)
    while (more := _likelier(found, found.suspects())) is not None:
        found = more
    if before is not None and (more := _likelier(found, found.suspects(before))) is not None:
        found = more
    while (fewer := found.with_least_surprising()) is not None and fewer.log_density > found.log_density:
        found = fewer
    return _without_mistakes(found)


def log_density_with_outliers(
    likelihood: MarginalLikelihood, y: FloatArray, outliers: Sequence[int], starts: Sequence[Hyperparameters]
) -> float:
    """Return the log density of n outputs if certain ones are outliers, but for those that are not alone.

    Parameters
    ----------
    likelihood, y, starts
        As in `without_outliers`.
    outliers
        Positions of the outputs, which may be more than a search would find; minus infinity if there are too many.
    """
    if len(outliers) > MOST * len(y) or len(y) < FEWEST:
        return -math.inf
    return _without_mistakes(Found.fitted(likelihood, y, outliers, starts, is_exact=False)).log_density


def _without_mistakes(found: Found) -> Found:
    """Return the same with every outlier back that is better than expected, or not alone."""
    while mistakes := found.mistakes():
        found = found.with_outliers(mistakes, are_outliers=False)
    return found


def _likelier(found: Found, suspects: Sequence[int]) -> Found | None:
    """Return the same with more outliers, if that is much likelier."""
    k = len(suspects)
    while k:
        tried = found.with_outliers(suspects[:k], are_outliers=True)
        if tried.log_density > found.log_density + MARGIN:
            return tried
        k //= 2
    return None


@dataclass(frozen=True, kw_only=True)
class Found:
    """A fit, and which of its outputs say nothing."""

    fit: Fitted
    is_outlier: BoolArray
    y: FloatArray
    starts: Sequence[Hyperparameters]
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
    ) -> Found:
        """Fit what is left without some of the outputs."""
        is_outlier = np.zeros(len(y), dtype=bool)
        is_outlier[list(outliers)] = True
        output, offsets = Standardized.of(y), None
        if is_outlier.any():
            output, offsets = Standardized.without(y, is_outlier), Offsets.of_outliers(is_outlier)
        likelihood = replace(likelihood, y=output.values, offsets=offsets)
        best = fit_hyperparameters(likelihood, starts, is_exact=is_exact)
        fit = Fitted(output=output, likelihood=likelihood, hyperparameters=best)
        return cls(fit=fit, is_outlier=is_outlier, y=y, starts=starts, is_exact=is_exact)

    def with_outliers(self, outputs: Sequence[int], *, are_outliers: bool) -> Found:
        """Return the same with other outputs taken for outliers, or not."""
        is_outlier = self.is_outlier.copy()
        is_outlier[list(outputs)] = are_outliers
        outliers = np.flatnonzero(is_outlier).tolist()
        return Found.fitted(self.fit.likelihood, self.y, outliers, self.starts, is_exact=self.is_exact)

    def suspects(self, before: Start | None = None) -> list[int]:
        """Return outputs that are surprisingly bad, each the most surprising one where those before it are left out.

        To hyperparameters that have to explain several of them none may be a surprise; to those of a fit to fewer
        outputs the new ones are. What is left out leaves the others' precision in closed form. Outputs that are not
        alone stay in.
        """
        is_left, may_be_one, process, enough = ~self.is_outlier, ~self.is_outlier, self.fit.process, SUSPECT
        scale = self.fit.output.scale
        if before is not None:
            may_be_one[: before.n] = False
            scale, enough = before.scale, GROSS
            known = replace(self.fit.output, values=self.fit.output.values * (self.fit.output.scale / scale))
            process = replace(self.fit, output=known, hyperparameters=before.hyperparameters).process
        precision, values = process.precision(), process.output.values
        suspects: list[int] = []
        while (~is_left).sum() + 1 <= MOST * len(is_left):
            weight = np.where(is_left, np.diag(precision), 1.0)
            residual = (precision @ values) / weight
            surprise = np.where(may_be_one, residual * np.sqrt(weight), -np.inf)
            worst = int(np.argmax(surprise))
            if not surprise[worst] >= enough:
                break
            may_be_one[worst] = False
            if self._is_alone(worst, residual[worst] * scale):
                suspects.append(worst)
                is_left[worst] = False
                precision = precision - np.outer(precision[worst], precision[worst]) / precision[worst, worst]
        return suspects

    def mistakes(self) -> list[int]:
        """Return the outliers that are none: better than the others foretell, or not alone."""
        outputs = np.flatnonzero(self.is_outlier).tolist()
        distances = self._surprises[0].tolist() if outputs else []
        return [i for i, d in zip(outputs, distances, strict=True) if d <= 0 or not self._is_alone(i, d)]

    def _is_alone(self, output: int, distance: float) -> bool:
        """Tell whether the nearest neighbour of an output that is too bad by so much is not half as bad."""
        return bool(self.y[self._nearest[output]] < self.y[output] - distance / 2)

    def with_least_surprising(self) -> Found | None:
        """Return the same with the least surprising outlier back, if it would be likelier as none; None otherwise."""
        outputs = np.flatnonzero(self.is_outlier)
        if not len(outputs):
            return None
        distance, std = self._surprises
        square = np.clip(distance / std, 1.0, 1e100) ** 2
        gain = 0.5 * (square - 1 - np.log(square)) + LOG_ODDS  # in log density, of being set aside
        least = int(np.argmin(gain))
        return self.with_outliers(outputs[least : least + 1].tolist(), are_outliers=False) if gain[least] < 0 else None

    @cached_property
    def log_density(self) -> float:
        """Log density of all outputs in their own units, of the hyperparameters, and of which are outliers.

        Minus infinity where all others are equal: their density has no bound, so nothing could be compared.
        """
        k, scale = int(self.is_outlier.sum()), self.fit.output.scale
        others = -self.fit.likelihood(self.fit.hyperparameters.to_log())[0] - (len(self.y) - k) * math.log(scale)
        if not k:
            return others
        if not self.fit.output.values.any():
            return -math.inf
        nothing = -0.5 * math.log(2 * math.pi * SAYS_NOTHING)  # each one's part in the likelihood
        distance = np.maximum(np.abs(self._surprises[0]), np.finfo(float).tiny)
        return others + k * (LOG_ODDS - nothing - LOG_SQRT_2_PI_E) - float(np.log(distance).sum())

    @cached_property
    def _nearest(self) -> IntArray:
        """Which other output is the nearest, shape (n,).

        By the kernel before any data: hyperparameters that explain two outliers together make them neighbours.
        """
        given = self.fit.likelihood
        kernel = MaternHammingKernel(given.prior.mode().lengthscales, given.is_ordered, given.permutations)
        likeness = kernel(given.X, given.X)
        np.fill_diagonal(likeness, -np.inf)
        return np.asarray(likeness.argmax(axis=1))

    @cached_property
    def _surprises(self) -> tuple[FloatArray, FloatArray]:
        """How far the outliers are above what the others predict, and its std, shape (k,), in the outputs' units."""
        process, output = self.fit.process, self.fit.output
        mean, covariance = process.joint(process.X[self.is_outlier])
        variance = np.diag(covariance) + process.hyperparameters.noise_variance
        return self.y[self.is_outlier] - output.offset - output.scale * mean, output.scale * np.sqrt(variance)
