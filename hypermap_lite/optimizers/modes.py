"""Two kinds of evaluations of which the front needs both: each has models of its own.

A skill that gives up early is gentle, and one that does not gets something done. One Gaussian process for both sees the
cliff between them and promises what lies halfway, most of all where the cliff may be. So what an evaluation is expected
to bring is that of either kind times the chance of that kind, to a power. To the models of one kind the evaluations of
the other are infeasible.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hypermap_lite.acquisition.base import Acquisition, AcquisitionContext, Scorer
from hypermap_lite.acquisition.either import Either
from hypermap_lite.acquisition.feasibility_weighted import FeasibilityWeighted
from hypermap_lite.optimizers.models import Models
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.surrogates.reported import TwoModes


@dataclass(frozen=True, slots=True)
class Modes:
    """The models of either kind."""

    low: Models
    """Of evaluations up to the limit that tells them apart."""

    high: Models
    """Of those above it."""

    def known(self) -> TwoModes:
        """Return what is known of the objectives."""
        return TwoModes(
            posteriors=(self.low.posterior(), self.high.posterior()),
            chances=(_chance(self.low), _chance(self.high)),
            points=(self.low.observed()[0], self.high.observed()[0]),
        )

    def scorer(self, acquisition: Acquisition, context: AcquisitionContext, exponent: float) -> Scorer:
        """Return what either kind is expected to add to the front of both, times its chance to a power.

        Of what is under way each point is expected to be of its likelier kind.
        """
        known, pending = self.known(), context.X_pending
        are_low = known.are_first(pending)
        under_way = pending[are_low], pending[~are_low]

        def of_kind(k: int) -> Scorer:
            other = np.vstack([known.points[1 - k], under_way[1 - k]])
            own = replace(
                context,
                posterior=known.posteriors[k],
                X=known.points[k],
                Y=(self.low, self.high)[k].observed()[1],
                X_pending=under_way[k],
                beside=known.posteriors[1 - k].predict(other).mean,
            )
            return FeasibilityWeighted(inner=acquisition.scorer(own), feasibility=known.chances[k], exponent=exponent)

        return Either(of_kind(0), of_kind(1))

    def outliers(self) -> set[int]:
        """Return the trials of which an objective is set aside."""
        return {trial for models in (self.low, self.high) for trial in outliers_of(models)}


def outliers_of(models: Models) -> set[int]:
    """Return the trials of which the models set an objective aside."""
    seen, outliers = models.history.completed, models.posterior().outliers()
    return {seen[row].trial for row in (() if outliers is None else np.flatnonzero(outliers.any(axis=1)))}


def _chance(models: Models) -> FeasibilityPosterior:
    chance = models.feasibility()
    assert chance is not None  # there are evaluations of the other kind
    return chance
