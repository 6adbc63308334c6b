"""Stopping the replicates of a configuration that is clearly dominated already.

The rule has a stated error: a configuration c that no evaluated one dominates is stopped with a probability of at most
alpha. At each of L looks c is tested against each of N evaluated configurations f, and stopped if one of them is better
in all objectives, each by a one-sided test of level alpha / (L N). As f does not dominate c, there is an objective in
which c is not worse. For c to be stopped because of f, the test in this one must err, whatever the others say: an
intersection-union test [1]_, whose level does not grow with the number of objectives. Over looks and rivals the errors
add up to at most alpha (Bonferroni), however the rival is chosen: it is accounted for that the best of N looks better
than it is.

The test is Welch's on the difference of the means, with moderated variances [2]_: a few results say little of a
variance, so that of a configuration is its own or the one that is shrunk towards what is usual (`shrunk_variances`),
whichever is larger, with the degrees of freedom of both. The level holds on average over configurations whose results
are normal, and whose variances are alike to the degree that the shrinkage says. For those that scatter much more than
usual, or have two kinds of results, simulations in tests/evaluation/test_racing.py show it. Only rows with all their
replicates are rivals: where the number of replicates depends on the results, so does their mean.

References
----------
.. [1] Berger. Multiparameter Hypothesis Testing and Acceptance Sampling. Technometrics, 1982.
.. [2] Smyth. Linear Models and Empirical Bayes Methods for Assessing Differential Expression in Microarray
   Experiments. Statistical Applications in Genetics and Molecular Biology, 2004.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from hypermap_lite.evaluation.outcome import CONFIRM, Evaluation, Replicate, Suggestion
from hypermap_lite.history.replicate_noise import PRIOR_FREEDOM
from hypermap_lite.objectives import Objective, values_of
from hypermap_lite.scenario.model import RacingSpec
from hypermap_lite.typing import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rivals:
    """The finished rows that may dominate a configuration."""

    means: FloatArray
    """Objectives to be minimized, shape (N, m), N >= 1."""

    variances: FloatArray
    """Moderated variances of these means, shape (N, m)."""

    usual: FloatArray
    """Pooled variance of single replicates, shape (m,)."""

    freedom: float
    """Degrees of freedom of each variance."""

    @classmethod
    def of(cls, means: FloatArray, variances: FloatArray, replicates: int) -> Rivals:
        """Return the rivals from the samples of N rows.

        Parameters
        ----------
        means, variances
            Of the samples, objectives to be minimized, shape (N, m).
        replicates
            Size of each sample, >= 2.
        """
        usual = variances.mean(axis=0)
        moderated = moderate(variances, usual, replicates - 1) / replicates
        return cls(means=means, variances=moderated, usual=usual, freedom=replicates - 1 + PRIOR_FREEDOM)

    def beat(self, Y: FloatArray, alpha: float) -> bool:
        """Tell whether one of them is better in all objectives than a configuration with some results.

        Parameters
        ----------
        Y
            The results, objectives to be minimized, shape (k, m), k >= 2.
        alpha
            Level of all tests together: probability that one says so though it is not better in all objectives.
        """
        n = len(Y)
        own = moderate(Y.var(axis=0, ddof=1), self.usual, n - 1) / n
        total = self.variances + own  # (N, m)
        with np.errstate(invalid="ignore", divide="ignore"):
            shares = self.variances / total
            freedom = 1 / (shares**2 / self.freedom + (1 - shares) ** 2 / (n - 1 + PRIOR_FREEDOM))
            needed = stdtrit(np.nan_to_num(freedom, nan=1.0), 1 - alpha / len(self.means)) * np.sqrt(total)
        difference = Y.mean(axis=0) - self.means
        return bool(((difference >= needed).all(axis=1) & (difference > 0).any(axis=1)).any())


def moderate(variances: FloatArray, usual: FloatArray, freedom: int) -> FloatArray:
    """Return the larger of sample variances, shape (..., m), and what they are shrunk to, given what is usual, (m,)."""
    shrunk = (PRIOR_FREEDOM * usual + freedom * variances) / (PRIOR_FREEDOM + freedom)
    return np.asarray(np.maximum(variances, shrunk))


@dataclass(frozen=True, slots=True, kw_only=True)
class Race:
    """How many replicates the configurations of one batch get: a function of the rows before it and of the calls."""

    replicates: int
    """Of a configuration that is not stopped."""

    objectives: tuple[Objective, ...]
    spec: RacingSpec | None = None
    """None: nobody is stopped."""

    rivals: Rivals | None = None

    @classmethod
    def against(
        cls, rows: Sequence[Evaluation], objectives: Sequence[Objective], spec: RacingSpec | None, replicates: int
    ) -> Race:
        """Return the race of a batch against the finished rows."""
        objectives = tuple(objectives)
        rivals = None
        if spec is not None:
            names = [o.name for o in objectives]
            full = [row for row in rows if row.is_completed and row.replicates == replicates]
            full = [row for row in full if _has_spread(row, names)]
            means = np.array([values_of(objectives, row.values) for row in full])
            errors = np.array([[row.standard_errors[name] for name in names] for row in full])
            if full:
                with np.errstate(over="ignore"):
                    rivals = Rivals.of(means, replicates * errors**2, replicates)
        return cls(replicates=replicates, objectives=objectives, spec=spec, rivals=rivals)

    @property
    def looks(self) -> range:
        """Numbers of replicates after which a configuration may be stopped."""
        return range(0) if self.spec is None else range(self.spec.minimum, self.replicates, self.spec.step)

    def required(self, suggestion: Suggestion, calls: Sequence[Replicate]) -> int:
        """Return how many replicates a configuration gets at least, as far as the calls that are done can tell.

        Those up to the first look that is not done yet, all if none stops it. A repetition that confirms the front is
        never stopped, nor is a configuration of which a call did not complete: it will not be in any model.
        """
        if self.rivals is None or suggestion.phase == CONFIRM:
            return self.replicates
        done = {call.replicate: call for call in calls}
        for look in self.looks:
            if any(r not in done for r in range(look)) or self._is_beaten([done[r] for r in range(look)]):
                return look
        return self.replicates

    def _is_beaten(self, calls: Sequence[Replicate]) -> bool:
        """Tell whether a rival is better in all objectives, so far as one look can tell."""
        assert self.spec is not None
        assert self.rivals is not None
        outcomes = [call.outcome for call in calls]
        if any(outcome.state.is_feasible is not True for outcome in outcomes):
            return False
        Y = np.array([values_of(self.objectives, outcome.values) for outcome in outcomes])
        with np.errstate(over="ignore", invalid="ignore"):
            return self.rivals.beat(Y, self.spec.alpha / len(self.looks))


def _has_spread(row: Evaluation, names: Sequence[str]) -> bool:
    return all(np.isfinite(row.standard_errors.get(name, np.nan)) for name in names)
