"""Which prior, if any, takes part in a suggestion, and how strongly."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from hypermap_lite.acquisition.base import PriorWeighting
from hypermap_lite.evaluation.outcome import Evaluation, Suggestion
from hypermap_lite.optimizers.prior_trust import LEVELS, Evidence, checkpoints, compare
from hypermap_lite.optimizers.streams import Stream, generator
from hypermap_lite.priors.beliefs import Belief, together
from hypermap_lite.priors.product import ProductPrior
from hypermap_lite.space.search_space import SearchSpace

Evidences = Callable[[int], Evidence | None]
"""What was known when the history had so many rows; None if that was too little for a check."""

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Guidance:
    """What one suggestion owes to a prior."""

    belief: Belief
    """Whose draws are among the candidates."""

    weight: float | None = None
    """Exponent of the prior; 0 in a prior-free step and once the prior is dropped, None where none has a part."""

    trust: float | None = None
    """Factor in the weight: 1, halved by each failed check; None without checks."""

    def said_of(self, suggestion: Suggestion) -> Suggestion:
        """Return a suggestion with the prior's part in it."""
        return replace(suggestion, prior_weight=self.weight, prior_trust=self.trust, prior_of=self.belief.name)


class Guide:
    """Decides how the priors take part in each suggestion; a function of the scenario and the completed evaluations.

    Parameters
    ----------
    beliefs
        The priors; a guided step follows one of them, drawn at random.
    weighting
        How priors enter the acquisition; None if they do not.
    space
        The search space.
    seed
        Of the scenario.
    """

    def __init__(
        self, beliefs: Sequence[Belief], weighting: PriorWeighting | None, space: SearchSpace, seed: int
    ) -> None:
        self._beliefs = tuple(beliefs)
        self._weighting = weighting
        self._space = space
        self._seed = seed
        self._failed: dict[tuple[int, int], bool] = {}

    @property
    def is_idle(self) -> bool:
        """Whether there is nothing to decide: no prior says anything, or none enters the acquisition."""
        return self._weighting is None or all(belief.prior.is_uniform for belief in self._beliefs)

    def guidance(
        self, trial: int, *, n: int, model_budget: int, history: Sequence[Evaluation], first: int, evidence: Evidences
    ) -> Guidance:
        """Return the part of the priors in one suggestion.

        Parameters
        ----------
        trial
            Its number, which decides on prior-free steps and on the prior.
        n
            Its running number among the model-based suggestions that are not prior-free, from 1.
        model_budget
            Model-based suggestions of the whole run.
        history
            All evaluations so far.
        first
            How many of them there are when priors are checked first: those of the design.
        evidence
            What was known when there were so many.
        """
        weighting = self._weighting
        if weighting is None or self.is_idle:
            return Guidance(belief=Belief(prior=together(self._beliefs)))
        is_free, place = self._drawn(trial)
        if not weighting.safeguard:
            belief = self._beliefs[int(place * len(self._beliefs))]
            return Guidance(belief=belief, weight=0.0 if is_free else weighting.weight(n, model_budget))
        trusts = [self._trust(i, history, first, evidence) for i in range(len(self._beliefs))]
        followed = [i for i, trust in enumerate(trusts) if trust] or [*range(len(trusts))]
        i = followed[int(place * len(followed))]
        belief, trust = self._beliefs[i], trusts[i]
        if not trust:
            belief = replace(belief, prior=ProductPrior(self._space.dimension))
        weight = 0.0 if is_free else trust * weighting.weight(n, model_budget)
        return Guidance(belief=belief, weight=weight, trust=trust)

    def is_free(self, trial: int) -> bool:
        """Tell whether a suggestion leaves the priors out by chance."""
        return self._drawn(trial)[0]

    def _drawn(self, trial: int) -> tuple[bool, float]:
        """Return what chance decides: whether a suggestion is prior-free, and whose prior it follows, in [0, 1)."""
        rng, weighting = generator(self._seed, Stream.PRIOR, trial), self._weighting
        share = 0.0 if weighting is None else weighting.prior_free
        return rng.random() < share, rng.random()

    def _trust(self, i: int, history: Sequence[Evaluation], first: int, evidence: Evidences) -> float:
        """Return the trust in the i-th prior after all checks so far."""
        level = 0
        for n in checkpoints(first, len(history)):
            is_new = (i, n) not in self._failed
            if is_new:
                self._failed[i, n] = self._fails(i, n, evidence)
            level += self._failed[i, n]
            if is_new and self._failed[i, n] and LEVELS[level] < _recorded_trust(history, self._beliefs[i].name):
                _tell(self._beliefs[i].name, n, LEVELS[level])
            if not LEVELS[level]:
                break
        return LEVELS[level]

    def _fails(self, i: int, n: int, evidence: Evidences) -> bool:
        """Tell whether the i-th prior fails the check after n evaluations."""
        known, rng = evidence(n), generator(self._seed, Stream.TRUST, n, i)
        return known is not None and compare(known, self._beliefs[i], self._space, rng).has_failed


def _recorded_trust(history: Sequence[Evaluation], name: str) -> float:
    """Return the least trust in a prior that the history shows."""
    shown = (row.suggestion for row in history if row.suggestion.prior_of == name)
    return min((s.prior_trust for s in shown if s.prior_trust is not None), default=LEVELS[0])


def _tell(name: str, n: int, trust: float) -> None:
    """Log a decision that the history does not show yet."""
    prior = f"the prior of {name}" if name else "the prior"
    if trust:
        text = "after %d evaluations %s is in doubt: its region has given less than the rest and promises less; "
        logger.info(text + "it counts for %g of what it did at first", n, prior, trust)
    else:
        text = "after %d evaluations %s is dropped: its region still gives less than the rest and promises less; "
        logger.warning(text + "the run goes on without it", n, prior)
