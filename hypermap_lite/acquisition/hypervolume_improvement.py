"""Expected growth of the dominated hypervolume, in log form."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.special import ndtr

from hypermap_lite.acquisition.base import Rough
from hypermap_lite.acquisition.boxes import Boxes
from hypermap_lite.acquisition.improvement import LOG_SQRT_2PI, log_h, log_h_slope, log_sum_exp
from hypermap_lite.surrogates.base import Field
from hypermap_lite.typing import FloatArray

LOG_SURELY_A_NUMBER = -400.0
"""Log of a growth, in units of the front's range, above which no float of the plain formula vanishes."""

BLOCK = 256
"""So many points are scored at once: what is worked out for them on the way stays in the processor's cache."""

LOG_NOTHING = -1e30
"""Stands for the log of no gain, so that two of them can be subtracted."""

Slopes: TypeAlias = tuple[FloatArray, FloatArray]
"""Derivatives by means and by standard deviations, shapes (S, n, m)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HypervolumeImprovement:
    r"""Log of the growth of the dominated hypervolume that a point is expected to bring, averaged over S fronts.

    With independent normal objectives, and boxes from :math:`l` to :math:`u` in the first and the third objective that
    are undominated up to :math:`h` in the second,

    .. math:: \sum (E_1(u_1) - E_1(l_1)) \, E_2(h) \, (E_3(u_3) - E_3(l_3)), \qquad E_k(t) = E[\max(0, t - y_k)],

    which is exact [1]_ for each front; the mean over fronts drawn from the posterior makes it noisy expected
    hypervolume improvement [2]_. Sums and differences are taken of logarithms where a float would vanish [3]_.

    References
    ----------
    .. [1] Yang, Emmerich, Deutz, Baeck. Efficient Computation of Expected Hypervolume Improvement Using Box
       Decomposition Algorithms. Journal of Global Optimization, 2019.
    .. [2] Daulton, Balandat, Bakshy. Parallel Bayesian Optimization of Multiple Noisy Objectives with Expected
       Hypervolume Improvement. NeurIPS 2021.
    .. [3] Ament et al. Unexpected Improvements to Expected Improvement for Bayesian Optimization. NeurIPS 2023.
    """

    field: Field
    """With S scenarios, or one."""

    boxes: Boxes
    is_differentiable: bool
    screening: int = 0
    """Fronts that tell which points are worth a closer look; 0 for all."""

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the log acquisition value at n points, shape (n,)."""
        c = self.field(X)
        return self._score(c.mean, c.std, self.boxes)

    @property
    def rough(self) -> Rough | None:
        """The same over a few of the fronts."""
        return self._rough if 0 < self.screening < len(self.boxes) else None

    def _rough(self, X: FloatArray) -> FloatArray:
        c, few = self.field(X), slice(self.screening)
        return self._score(c.mean[few], c.std[few], self.boxes.first(self.screening))

    @staticmethod
    def _score(mean: FloatArray, std: FloatArray, boxes: Boxes) -> FloatArray:
        k = math.ceil(mean.shape[1] / BLOCK) or 1
        blocks = zip(np.array_split(mean, k, axis=1), np.array_split(std, k, axis=1), strict=True)
        growth = np.concatenate([Growth.of(boxes, *block).value for block in blocks])
        with np.errstate(divide="ignore"):
            score = np.log(growth)
        tiny = score < LOG_SURELY_A_NUMBER
        if tiny.any():
            score[tiny] = LogGrowth.of(boxes, mean[:, tiny], std[:, tiny]).score
        return score

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        growth = Growth.of(self.boxes, c.mean, c.std)
        with np.errstate(divide="ignore", invalid="ignore"):
            score = np.log(growth.value)
            by_mean, by_std = (slope / growth.value[:, None] for slope in growth.slopes())
        tiny = score < LOG_SURELY_A_NUMBER
        if tiny.any():
            exact = LogGrowth.of(self.boxes, c.mean[:, tiny], c.std[:, tiny])
            score[tiny] = exact.score
            by_mean[:, tiny], by_std[:, tiny] = exact.slopes()
        return score, c.gradient(by_mean, by_std)


@dataclass(frozen=True, slots=True, kw_only=True)
class Gain:
    """E[max(0, limit - y)] of k limits for n normal y in S scenarios; all of shape (S, k, n)."""

    value: FloatArray
    cdf: FloatArray
    """Minus its derivative by the mean."""

    density: FloatArray
    """Its derivative by the standard deviation."""

    @classmethod
    def of(cls, limits: FloatArray, mean: FloatArray, std: FloatArray) -> Gain:
        """Take it for limits (S, k), means (S or 1, n) and standard deviations (S or 1, n)."""
        # In place: memory that is asked for and given back again and again costs more than the arithmetic.
        std = std[:, None]
        z = limits[:, :, None] - mean[:, None]
        z /= std
        density = -0.5 * z
        density *= z
        density -= LOG_SQRT_2PI
        np.exp(density, out=density)
        cdf = ndtr(z)
        value: FloatArray = np.multiply(z, cdf, out=z)
        value += density
        value *= std
        return cls(value=np.maximum(value, 0.0, out=value), cdf=cdf, density=density)


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """The growth itself, and what its derivatives need; for points at which it does not vanish."""

    boxes: Boxes
    gains: tuple[Gain, ...]
    factors: tuple[FloatArray, ...]
    """What each objective gives to each box, shapes (S, B, n), >= 0."""

    @classmethod
    def of(cls, boxes: Boxes, mean: FloatArray, std: FloatArray) -> Growth:
        """Take it for means (S or 1, n, m) and standard deviations (S or 1, n, m)."""
        gains = tuple(Gain.of(limits, mean[:, :, k], std[:, :, k]) for k, limits in enumerate(boxes.limits))
        factors = tuple(np.maximum(boxes.sides(k, gain.value), 0.0) for k, gain in enumerate(gains))
        return cls(boxes=boxes, gains=gains, factors=factors)

    @property
    def value(self) -> FloatArray:
        """Mean growth at n points, shape (n,), >= 0."""
        return np.asarray(_total(self.factors).sum(axis=0) / len(self.boxes))

    def slopes(self) -> Slopes:
        """Return the derivatives of the mean growth."""
        by_mean = [self._slope(k, -gain.cdf) for k, gain in enumerate(self.gains)]
        by_std = [self._slope(k, gain.density) for k, gain in enumerate(self.gains)]
        return np.stack(by_mean, axis=2) / len(self.boxes), np.stack(by_std, axis=2) / len(self.boxes)

    def _slope(self, k: int, slopes: FloatArray) -> FloatArray:
        others = [factor for j, factor in enumerate(self.factors) if j != k]
        return _total([self.boxes.sides(k, slopes), *others])


def _total(factors: list[FloatArray] | tuple[FloatArray, ...]) -> FloatArray:
    """Return the sum over the boxes of the products of their factors, shape (S, n)."""
    return np.asarray(np.einsum(",".join(["sbn"] * len(factors)) + "->sn", *factors))


@dataclass(frozen=True, slots=True, kw_only=True)
class LogGrowth:
    """The logarithm of every box's part at n points, and what their derivatives need."""

    score: FloatArray
    """Log of the mean growth, shape (n,)."""

    share: FloatArray
    """Each box's part of the growth, shape (S, B, n)."""

    boxes: Boxes
    z: tuple[FloatArray, ...]
    """Standardized limits of each objective, shapes (S, k, n)."""

    log_gains: tuple[FloatArray, ...]
    std: FloatArray

    @classmethod
    def of(cls, boxes: Boxes, mean: FloatArray, std: FloatArray) -> LogGrowth:
        """Take it for means (S or 1, n, m) and standard deviations (S or 1, n, m)."""
        zs, log_gains = [], []
        terms: FloatArray | float = 0.0
        for k, limits in enumerate(boxes.limits):
            z = (limits[:, :, None] - mean[:, None, :, k]) / std[:, None, :, k]
            log_gain = log_h(z) + np.log(std[:, None, :, k])
            terms = terms + _log_sides(boxes, k, log_gain)
            zs.append(z)
            log_gains.append(log_gain)
        terms = np.asarray(terms)
        total = log_sum_exp(terms.reshape(-1, terms.shape[2]))
        with np.errstate(invalid="ignore"):
            share = np.nan_to_num(np.exp(terms - total))
        score = total - math.log(len(boxes))
        return cls(score=score, share=share, boxes=boxes, z=tuple(zs), log_gains=tuple(log_gains), std=std)

    def slopes(self) -> Slopes:
        """Return the derivatives of the score."""
        by_mean, by_std = zip(*self._slopes(), strict=True)
        return np.stack(by_mean, axis=2), np.stack(by_std, axis=2)

    def _slopes(self) -> Iterator[tuple[FloatArray, FloatArray]]:
        for k, (z, log_gain) in enumerate(zip(self.z, self.log_gains, strict=True)):
            slope, std = log_h_slope(z), self.std[:, :, k]
            by_mean, by_std = (_log_slopes(self.boxes, k, log_gain, s) for s in (-slope, 1 - slope * z))
            yield (self.share * by_mean).sum(axis=1) / std, (self.share * by_std).sum(axis=1) / std


def _log_sides(boxes: Boxes, k: int, log_gain: FloatArray) -> FloatArray:
    """Return the logs of `Boxes.sides`, from those of the gains."""
    if k == 1:
        return boxes.sides(k, log_gain)
    lower, upper = boxes.ends(k, log_gain, below=LOG_NOTHING)
    with np.errstate(divide="ignore"):
        return np.asarray(upper + np.log1p(-np.exp(np.minimum(lower - upper, 0.0))))


def _log_slopes(boxes: Boxes, k: int, log_gain: FloatArray, slopes: FloatArray) -> FloatArray:
    """Return the derivatives of `_log_sides`, from those of the gains' logs: of log(u - l) from log u and log l."""
    if k == 1:
        return boxes.sides(k, slopes)
    lower, upper = boxes.ends(k, log_gain, below=LOG_NOTHING)
    ratio = np.exp(np.minimum(lower - upper, 0.0))
    of_lower, of_upper = boxes.ends(k, slopes, below=0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(ratio < 1, (of_upper - ratio * of_lower) / (1 - ratio), 0.0)
