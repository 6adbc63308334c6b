r"""Failures: evaluations whose objective has a mode of its own, such as that of a skill that did not succeed.

What a failure is worth says little of what successes are like. Where a skill takes 1.2 to 2.4 s and 6 s if it fails, a
Gaussian process of all values sees the cliff and little else: its lengthscales are the cliff's, and a tenth of a second
is noise. So what is worse than a limit is told apart, as in a hurdle model [1]_: one model says where an evaluation
succeeds, and one of the successes alone what it is worth there [2]_.

It is done on evidence. Let z tell which of n evaluations fail. Then all that is known is as likely as

.. math:: p(z) \, p(y_{success}) \, p(y_{failure})

with a process for each part, in place of one for all values. Where success has no reason in the parameters nothing is
told apart. What the front can't do without, such as its slow and gentle half, is no failure; if asked for, two such
modes are told apart on the same evidence, and both are looked for, as in a mixture of two experts [3]_.

References
----------
.. [1] Cragg. Some Statistical Models for Limited Dependent Variables with Application to the Demand for Durable Goods.
   Econometrica, 1971.
.. [2] Gramacy, Lee. Optimization under Unknown Constraints. Bayesian Statistics 9, 2011.
.. [3] Jacobs, Jordan, Nowlan, Hinton. Adaptive Mixtures of Local Experts. Neural Computation, 1991.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.surrogates.base import Permutations
from hypermap_lite.surrogates.failures import SMALLEST_SPREAD, Failures, candidates
from hypermap_lite.surrogates.feasibility import ProbitProcess
from hypermap_lite.surrogates.marginal_likelihood import (
    REJECTED,
    HyperPrior,
    MarginalLikelihood,
    fit_hyperparameters,
)
from hypermap_lite.surrogates.outliers import log_density_with_outliers, without_outliers
from hypermap_lite.surrogates.process import Standardized
from hypermap_lite.surrogates.tails import likely_tail
from hypermap_lite.typing import BoolArray, FloatArray

MARGIN: Final = 1.5
"""Log of the factor by which an evaluation must be likelier, on average, where failures are told apart."""

FEW: Final = 20
"""Fewer evaluations must together be as much likelier as so many."""

FORETOLD: Final = 0.25
"""Share of the entropy of success and failure that all other evaluations must take away from each, on average.

Where success is a matter of chance they take nothing; then a failure says what is to be expected of its surroundings.
After 40 evaluations the share is -0.1 to 0.2 if success has a constant probability, 0.1 to 0.4 if that falls from 1 to
0.1 along one of two axes, and 0.5 to 0.7 for skills with cliffs in 5 to 12 dimensions.
"""

FEWEST: Final = 10
"""With fewer evaluations none is a failure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Densities:
    """How likely outputs are by the Gaussian process that is to learn from them, its noise not doubted."""

    prior: HyperPrior
    is_ordered: BoolArray
    permutations: Permutations
    compress_tails: bool
    ignore_outliers: bool

    def __call__(self, X: FloatArray, y: FloatArray) -> float:
        """Return the log density of n outputs, shape (n,), at points, shape (n, d), and of the hyperparameters."""
        likelihood, starts = self._likelihood(X, y), [self.prior.mode()]
        if self.ignore_outliers:
            return without_outliers(likelihood, y, starts, is_exact=False).log_density
        best = fit_hyperparameters(likelihood, starts, is_exact=False)
        return -likelihood(best.to_log())[0] - len(y) * math.log(Standardized.of(y).scale)

    def with_outliers(self, X: FloatArray, y: FloatArray, is_outlier: BoolArray) -> float:
        """Return the same with certain outliers; minus infinity where there are none, or never so many."""
        if not self.ignore_outliers:
            return -math.inf
        outliers = np.flatnonzero(is_outlier).tolist()
        return log_density_with_outliers(self._likelihood(X, y), y, outliers, [self.prior.mode()])

    def of_compressed(self, X: FloatArray, y: FloatArray, least: float) -> float:
        """Return the same with their tail compressed, above `least` or more; minus infinity if they have none."""
        tail = likely_tail(y, least) if self.compress_tails else None
        return -math.inf if tail is None else self(X, tail.compress(y)) + float(tail.log_slope(y).sum())

    def _likelihood(self, X: FloatArray, y: FloatArray) -> MarginalLikelihood:
        values = Standardized.of(y).values
        return MarginalLikelihood(X, values, self.is_ordered, self.prior, self.permutations)

    def of_labels(self, X: FloatArray, succeeds: BoolArray) -> float:
        """Return the log probability of which of n evaluations succeed, and the log density of its hyperparameters.

        Minus infinity where success seems to be a matter of chance; see `FORETOLD`.
        """
        log_evidence, foretold = ProbitProcess().evidence(
            X, succeeds, is_ordered=self.is_ordered, permutations=self.permutations
        )
        share = succeeds.mean()
        by_share = len(X) * (share * math.log(share) + (1 - share) * math.log(1 - share))
        return log_evidence if foretold >= (1 - FORETOLD) * by_share else -math.inf


def likely_failures(
    X: FloatArray,
    Y: FloatArray,
    least: Sequence[float],
    corner: FloatArray | None,
    log_density: Densities,
    *,
    or_needed: bool = False,
) -> Failures | None:
    """Return the failures that make all outputs much likelier; None if there are none of the kind.

    Parameters
    ----------
    X
        Points of the unit cube, shape (n, d).
    Y
        Objectives to be minimized there, shape (n, m).
    least
        Of each objective, what is below it is no tail; m numbers.
    corner
        Reference point of the hypervolume, shape (m,); None with one objective.
    log_density
        By which it is judged.
    or_needed
        Whether they may be such that the front needs them.
    """
    if len(Y) < FEWEST:
        return None
    best, most = None, MARGIN * max(len(Y), FEW)
    together: list[float] = []
    for failures in sorted(candidates(Y, corner, or_needed=or_needed), key=lambda failures: failures.are_needed):
        if failures.are_needed and best is not None and not best.are_needed:
            break  # real failures first
        together = together or [log_density(X, y) for y in Y.T]
        gain = _gain(X, Y, failures, together, log_density)
        if gain < most or together[failures.objective] <= -REJECTED:
            continue
        if gain > _gain_by_tails(X, Y, least, together, log_density):
            best, most = failures, gain
    return best


def _gain(X: FloatArray, Y: FloatArray, failures: Failures, together: Sequence[float], log_density: Densities) -> float:
    """Return the log of how much likelier outputs are if failures are told apart; `together`: as they are, each.

    Of an objective that is likelier as one everywhere, failures tell the model as infeasible evaluations do.
    """
    fails = failures.among(Y)
    gain = log_density.of_labels(X, ~fails)
    if gain == -math.inf:
        return gain
    for k, y in enumerate(Y.T):
        least_std = SMALLEST_SPREAD * float(y.std())
        if least_std > 0:
            apart = sum(_of_a_kind(X[kind], y[kind], least_std, log_density) for kind in (fails, ~fails))
            apart -= max(together[k], log_density.with_outliers(X, y, fails))
            gain += apart if k == failures.objective else max(apart, 0.0)
    return gain


def _gain_by_tails(
    X: FloatArray, Y: FloatArray, least: Sequence[float], together: Sequence[float], log_density: Densities
) -> float:
    """Return the log of how much likelier outputs are if tails are compressed, where that makes them likelier."""
    compressed = [log_density.of_compressed(X, y, limit) for y, limit in zip(Y.T, least, strict=True)]
    return sum(max(gain, 0.0) for gain in np.subtract(compressed, together).tolist())


def _of_a_kind(X: FloatArray, y: FloatArray, least_std: float, log_density: Densities) -> float:
    """Return the log density of outputs that may be all the same: then of independent normal ones."""
    if y.std() > least_std:
        return log_density(X, y)
    square = float((((y - y.mean()) / least_std) ** 2).sum())
    return -len(y) * (0.5 * math.log(2 * math.pi) + math.log(least_std)) - 0.5 * square
