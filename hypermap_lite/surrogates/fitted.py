"""One objective's outputs with their likely hyperparameters, before the process is worked out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters, MarginalLikelihood
from hypermap_lite.surrogates.process import Process, Standardized


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """One objective's outputs, and the hyperparameters that are likely by them."""

    output: Standardized
    likelihood: MarginalLikelihood
    hyperparameters: Hyperparameters

    @cached_property
    def process(self) -> Process:
        """The process given the outputs."""
        given = self.likelihood
        return Process.condition(
            given.X,
            self.output,
            self.hyperparameters,
            given.is_ordered,
            given.permutations,
            given.known_noise,
            given.offsets,
        )
