r"""Objectives with a tail: values far beyond those that count, such as penalties for failures.

A failure that is worth 1e5 is all that a Gaussian process sees: beside it a difference between 0.3 and 0.8 is nothing,
and the cliff in between sets the lengthscales. So values above a limit are compressed, to

.. math:: l + s \log(1 + (y - l) / s)

or once more, with :math:`\log(1 + \log(1 + (y - l) / s))` in place of the logarithm; s is the range of the values below
the limit l. Below it nothing changes, and the order of all values stays, so fronts and improvements are the same. This
is a warped Gaussian process [1]_: the slope of the transform makes densities of the outputs comparable, and it is taken
only where it makes them much likelier. Transforming always [2]_ costs more than it gains: the values of a smooth
function that happen to be large say what it is like.

References
----------
.. [1] Snelson, Rasmussen, Ghahramani. Warped Gaussian Processes. NIPS 2003.
.. [2] Eriksson, Poloczek. Scalable Constrained Bayesian Optimization. AISTATS 2021.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hypermap_lite.typing import FloatArray

MARGIN: Final = 0.5
"""Log of the factor by which an evaluation must be likelier, on average."""

FEW: Final = 20
"""Fewer evaluations must together be as much likelier as so many."""

GAP: Final = 3.0
"""Values followed by a gap of so many of their ranges may be all that counts."""

FEWEST_BELOW: Final = 0.1
"""Share of the values that are below such a gap, at least; and there are two of them."""

SMALLEST_SPREAD: Final = 1e-9
"""Smallest range of the values that count, relative to their size: less may be rounding."""

SAME: Final = 1e-3
"""Values that differ by less, in standard deviations, count once."""

BEYOND: Final = 3.0
"""Predictions stand for values up to so many times the largest excess over the limit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tail:
    """How the values of an objective above a limit are compressed."""

    limit: float
    spread: float
    """Unit of the excess over the limit, > 0."""

    highest: float
    """Largest value so far, > limit."""

    is_double: bool = False
    """Whether the logarithm of the logarithm is taken."""

    def compress(self, y: FloatArray) -> FloatArray:
        """Return compressed values, of the same shape."""
        log = self._log(y)
        return np.where(y > self.limit, self.limit + self.spread * (np.log1p(log) if self.is_double else log), y)

    def log_slope(self, y: FloatArray) -> FloatArray:
        """Return the log of the derivative of `compress`, at most 0."""
        log = self._log(y)
        return -log - np.log1p(log) if self.is_double else -log

    def distinct(self, y: FloatArray) -> FloatArray:
        """Return the values that differ once they are compressed, rising: of those within `SAME` of it only the least.

        A penalty that comes again, give or take a little, has a probability and no density, which would depend on the
        slope.
        """
        y = np.sort(y)
        z = self.compress(y)
        kept, step = [0], SAME * float(z.std())
        for k, value in enumerate(z.tolist()):
            if value > z[kept[-1]] + step:
                kept.append(k)
        return y[kept]

    def stretch(self, z: FloatArray) -> FloatArray:
        """Return the values whose compressed ones are given, none far beyond the largest one so far.

        A step of a compressed value is a factor, or more, of the value it stands for.
        """
        highest = self.limit + BEYOND * (self.highest - self.limit)
        excess = (np.minimum(z, self.compress(np.array(highest))) - self.limit) / self.spread
        for _ in range(1 + self.is_double):
            excess = np.expm1(np.maximum(excess, 0.0))
        return np.where(z > self.limit, np.minimum(self.limit + self.spread * excess, highest), z)

    def _log(self, y: FloatArray) -> FloatArray:
        return np.asarray(np.log1p(np.maximum(y - self.limit, 0.0) / self.spread))


Tails = Sequence[Tail | None]
"""One per objective; None compresses nothing."""


def compress(Y: FloatArray, tails: Tails) -> FloatArray:
    """Return the objectives, shape (n, m), with their tails compressed."""
    if not any(tails):
        return Y
    return np.column_stack([y if tail is None else tail.compress(y) for y, tail in zip(Y.T, tails, strict=True)])


def slopes(Y: FloatArray, tails: Tails) -> FloatArray:
    """Return by what factor small differences shrink, shape (n, m), all in (0, 1]."""
    columns = [np.ones(len(Y)) if t is None else np.exp(t.log_slope(y)) for y, t in zip(Y.T, tails, strict=True)]
    return np.column_stack(columns)


def likely_tail(y: FloatArray, least: float) -> Tail | None:
    """Return the tail that makes outputs most like independent normal ones; None if that is no tail at all.

    The limit is the median, or below a gap, or `least` where that is more.

    Parameters
    ----------
    y
        Outputs, shape (n,).
    least
        Smallest limit: what is below it counts.
    """
    lowest, highest = float(y.min()), float(y.max())
    best, best_gain = None, 0.0
    for limit in sorted({max(limit, least) for limit in _limits(np.sort(y))}):
        spread = limit - lowest
        if limit >= highest or spread <= SMALLEST_SPREAD * max(abs(lowest), abs(limit)):
            continue
        for is_double in (False, True):
            tail = Tail(limit=limit, spread=spread, highest=highest, is_double=is_double)
            distinct = tail.distinct(y)
            gain = _log_std(distinct) - _log_std(tail.compress(distinct)) + float(tail.log_slope(distinct).mean())
            if gain > best_gain:
                best, best_gain = tail, gain
    return best


def _log_std(y: FloatArray) -> float:
    """Return the log standard deviation of values that are not all equal, shape (n,), of any size."""
    whole = float(np.ptp(y / 2))
    return math.log(whole) + math.log(float((y / whole).std()))


def _limits(y: FloatArray) -> Iterator[float]:
    """Yield the limits to be tried for sorted outputs, shape (n,)."""
    yield float(np.median(y))
    fewest = max(2, int(np.ceil(FEWEST_BELOW * len(y))))
    for k in range(fewest, len(y)):
        if y[k] - y[k - 1] > GAP * (y[k - 1] - y[0]) > 0:
            yield float(y[k - 1])
