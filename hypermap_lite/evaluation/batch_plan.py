"""Which trials are asked for together."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self


@dataclass(frozen=True, slots=True, kw_only=True)
class BatchPlan:
    """Cuts the trials into batches: a first one, whose size may be its own, and others of equal size.

    The cuts depend on nothing that happens in a run, so a run that goes on after a stop cuts as it did before.
    """

    size: int
    """Trials of a batch."""

    first: int | None = None
    """Trials of the first batch; None: as many as in the others."""

    def after(self, n: int) -> Self:
        """Return the plan of the trials after n that are done before the run: the first batch holds so many fewer."""
        return self if self.first is None else replace(self, first=max(self.first - n, 0))

    @property
    def _first(self) -> int:
        return self.size if self.first is None else self.first

    def end_of_batch(self, trial: int) -> int:
        """Return the first trial that is not in the batch of a trial, nor before it."""
        if trial < self._first:
            return self._first
        return self._first + ((trial - self._first) // self.size + 1) * self.size

    def n_in_whole_batches(self, n: int) -> int:
        """Return how many of the first n trials are in batches that lie within these n."""
        return 0 if n < self._first else self._first + (n - self._first) // self.size * self.size
