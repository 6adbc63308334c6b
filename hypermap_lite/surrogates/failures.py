"""Evaluations whose objective is in a mode of its own, and which these may be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
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
    are_needed: bool = False
    """Whether the front needs them and the others, so that they are no failures but outcomes of another kind."""

    def among(self, Y: FloatArray) -> BoolArray:
        """Tell which of n evaluations, shape (n, m), fail, shape (n,)."""
        return np.asarray(Y[:, self.objective] > self.limit)


def candidates(Y: FloatArray, corner: FloatArray | None, *, or_needed: bool = False) -> Iterator[Failures]:
    """Yield for each objective the failures that make its values most like two normal modes, if one is less likely.

    Without those where all successes are worth the same and nothing is left to improve, and those that the front would
    miss; if such are asked for, too, with those of which the front needs both kinds.
    """
    for k, y in enumerate(Y.T):
        limit = _between_modes(np.sort(y))
        if limit is None:
            continue
        failures = Failures(objective=k, limit=limit)
        fails = failures.among(Y)
        if corner is None:
            if np.ptp(y[~fails]) > 0:
                yield failures
            continue
        close = np.minimum(corner, infer_reference_point(Y))
        if _volume(Y, corner) == 0 or _volume(Y, close) == 0:
            continue
        are_needed, others_are_needed = (
            _lost(Y, kind, corner) > LOST or _lost(Y, kind, close) > LOST_CLOSE for kind in (fails, ~fails)
        )
        if not are_needed or (or_needed and others_are_needed):
            yield replace(failures, are_needed=are_needed)


def _lost(Y: FloatArray, kind: BoolArray, corner: FloatArray) -> float:
    """Return which share of the hypervolume of outputs, shape (n, m), is lost without those of a kind."""
    return 1.0 - _volume(Y, corner, kind) / _volume(Y, corner)


def _volume(Y: FloatArray, corner: FloatArray, without: BoolArray | None = None) -> float:
    """Return the hypervolume of outputs, shape (n, m), as a share of the box from their best values to a corner."""
    best = Y.min(axis=0)
    if not (best < corner).all():
        return 0.0
    box = (Y - best) / (corner - best)  # so that no units are too large or too small
    return hypervolume(box if without is None else box[~without], np.ones(len(corner)))


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
