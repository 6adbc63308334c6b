"""Evaluations whose objective is in a bad mode of its own, and which these may be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.pareto.hypervolume import hypervolume, infer_reference_point
from hypermap_lite.typing import BoolArray, FloatArray

FEWEST_OF_A_KIND: Final = 3
"""Successes, and failures, at least."""

SMALLEST_SPREAD: Final = 0.05
"""Standard deviation of a kind, as a share of that of all values, below which it counts as so much.

The density of values that are all the same has no bound.
"""

LOST: Final = 0.02
"""Share of the hypervolume that failures may have, at most: a skill that does nothing may be the least effort."""

LOST_CLOSE: Final = 1 / 3
"""The same from a reference point close to the front. A stated one may be so far that half of the front is nothing."""

ROUNDING: Final = 1e-12
"""Standard deviation of values, relative to their size, that may be rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Failures:
    """Which evaluations fail: those of which an objective, to be minimized, is above a limit."""

    objective: int
    """Its position."""

    limit: float

    def among(self, Y: FloatArray) -> BoolArray:
        """Tell which of n evaluations, shape (n, m), fail, shape (n,)."""
        return np.asarray(Y[:, self.objective] > self.limit)


def candidates(Y: FloatArray, corner: FloatArray | None) -> Iterator[Failures]:
    """Yield for each objective the failures that make its values most like two normal modes, if one is less likely.

    Without those that the front would miss, and where all successes are worth the same and nothing is left to improve.
    """
    for k, y in enumerate(Y.T):
        limit = _between_modes(np.sort(y))
        if limit is None:
            continue
        failures = Failures(objective=k, limit=limit)
        fails = failures.among(Y)
        if corner is None:
            is_needless = bool(np.ptp(y[~fails]) > 0)
        else:
            close = np.minimum(corner, infer_reference_point(Y))
            is_needless = _lost(Y, fails, corner) <= LOST and _lost(Y, fails, close) <= LOST_CLOSE
        if is_needless:
            yield failures


def _lost(Y: FloatArray, fails: BoolArray, corner: FloatArray) -> float:
    """Return which share of the hypervolume of outputs, shape (n, m), is lost without those that fail; 1 of nothing."""
    best = Y.min(axis=0)
    if not (best < corner).all():
        return 1.0
    box = (Y - best) / (corner - best)  # so that no units are too large or too small
    whole = hypervolume(box, np.ones(len(corner)))
    return 1.0 - hypervolume(box[~fails], np.ones(len(corner))) / whole if whole > 0 else 1.0


def _between_modes(y: FloatArray) -> float | None:
    """Return the limit between the two likeliest normal modes of sorted values, shape (n,).

    None if one mode is better by Schwarz' criterion, two having three more parameters.
    """
    n, std = len(y), float(y.std())
    if std <= ROUNDING * float(np.abs(y).max()):
        return None
    best, most = None, 1.5 * math.log(n)
    for k in range(FEWEST_OF_A_KIND, n - FEWEST_OF_A_KIND + 1):
        if y[k] > y[k - 1]:
            gain = n * math.log(std)
            for kind in (y[:k], y[k:]):
                gain += len(kind) * math.log(len(kind) / n / max(float(kind.std()), SMALLEST_SPREAD * std))
            if gain > most:
                middle = float(y[k - 1] + (y[k] - y[k - 1]) / 2)
                best, most = middle if middle < y[k] else float(y[k - 1]), gain
    return best
