"""Expected growth of the dominated hypervolume, in log form."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from hypermap_lite.acquisition.base import Rough
from hypermap_lite.acquisition.improvement import LOG_SQRT_2PI, log_h, log_h_slope, log_sum_exp
from hypermap_lite.pareto.dominance import non_dominated
from hypermap_lite.surrogates.base import Field
from hypermap_lite.typing import FloatArray, IntArray

LOG_SURELY_A_NUMBER = -400.0
"""Log of a growth, in units of the front's range, above which no float of the plain formula vanishes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """What S fronts of two or three objectives leave undominated below the reference point.

    The first and the third objective are cut at the points of a front; in each cell of that grid everything whose
    second objective is below one height is undominated. With two objectives the third axis has a single cell that
    reaches from minus to plus infinity.
    """

    edges: FloatArray
    """Upper ends of the cells along the first objective, rising, shape (S, a)."""

    heights: FloatArray
    """Values of the second objective at which cells may end, shape (S, b)."""

    layers: FloatArray | None
    """Upper ends along the third objective, rising, shape (S, c); None for two objectives."""

    height_of: IntArray
    """Index of the height of each cell, shape (S, c, a); c is 1 for two objectives."""

    def first(self, n: int) -> Cells:
        """Return those of the first n fronts."""
        layers = None if self.layers is None else self.layers[:n]
        return Cells(edges=self.edges[:n], heights=self.heights[:n], layers=layers, height_of=self.height_of[:n])

    @classmethod
    def of(cls, fronts: FloatArray, reference_point: FloatArray) -> Cells:
        """Cut the space below the reference point.

        Parameters
        ----------
        fronts
            S sets of points, to be minimized, shape (S, k, m), m in {2, 3}; dominated points, and those not below the
            reference point, leave no trace.
        reference_point
            Shape (m,).
        """
        kept = [np.unique(front_below(points, reference_point), axis=0) for points in fronts]
        size = max(map(len, kept))
        corner = reference_point[None, None]
        padded = np.broadcast_to(corner, (len(kept), size + 1, corner.shape[2])).copy()
        for s, front in enumerate(kept):
            padded[s, : len(front)] = front  # sorted by the first objective; the rest is the reference point itself
        edges, heights = padded[:, :, 0], padded[:, :, 1]
        # The height of a cell is the least second objective of the points before it, of those below its layer.
        before = np.concatenate([heights[:, -1:], heights[:, :-1]], axis=1)
        if padded.shape[2] == 2:
            return cls(edges=edges, heights=before, layers=None, height_of=_running_argmin(before)[:, None])
        third = np.concatenate([np.full((len(kept), 1), -np.inf), padded[:, :-1, 2]], axis=1)
        layers = np.sort(padded[:, :, 2], axis=1)
        lower = np.concatenate([np.full((len(kept), 1), -np.inf), layers[:, :-1]], axis=1)
        is_below = third[:, None] <= lower[:, :, None]
        seen = np.where(is_below, before[:, None], np.inf)
        return cls(edges=edges, heights=before, layers=layers, height_of=_running_argmin(seen))


def _running_argmin(values: FloatArray) -> IntArray:
    """Return the index of the least value up to each position of the last axis, the first of equals."""
    least = np.minimum.accumulate(values, axis=-1)
    is_new = np.concatenate([np.ones_like(least[..., :1], dtype=bool), least[..., 1:] < least[..., :-1]], axis=-1)
    positions = np.where(is_new, np.arange(values.shape[-1]), 0)
    return np.asarray(np.maximum.accumulate(positions, axis=-1))


def front_below(Y: FloatArray, reference_point: FloatArray) -> FloatArray:
    """Return the non-dominated rows that are better than the reference point everywhere, shape (k, m)."""
    inside = Y[(reference_point > Y).all(axis=1)]
    return inside[non_dominated(inside)] if len(inside) else inside


@dataclass(frozen=True, slots=True, kw_only=True)
class HypervolumeImprovement:
    r"""Log of the growth of the dominated hypervolume that a point is expected to bring, averaged over S fronts.

    With independent normal objectives and the cells of `Cells`,

    .. math:: \sum_{ij} (E_1(e_j) - E_1(e_{j-1})) \, E_2(h_{ij}) \, (E_3(l_i) - E_3(l_{i-1})), \qquad
        E_k(t) = E[\max(0, t - y_k)],

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

    cells: Cells
    is_differentiable: bool
    screening: int = 0
    """Fronts that tell which points are worth a closer look; 0 for all."""

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the log acquisition value at n points, shape (n,)."""
        c = self.field(X)
        return self._score(c.mean, c.std, self.cells)

    @property
    def rough(self) -> Rough | None:
        """The same over a few of the fronts."""
        return self._rough if 0 < self.screening < len(self.cells.edges) else None

    def _rough(self, X: FloatArray) -> FloatArray:
        c, few = self.field(X), slice(self.screening)
        return self._score(c.mean[few], c.std[few], self.cells.first(self.screening))

    @staticmethod
    def _score(mean: FloatArray, std: FloatArray, cells: Cells) -> FloatArray:
        with np.errstate(divide="ignore"):
            score = np.log(Growth.of(cells, mean, std).value)
        tiny = score < LOG_SURELY_A_NUMBER
        if tiny.any():
            score[tiny] = LogGrowth.of(cells, mean[:, tiny], std[:, tiny]).score
        return score

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        growth = Growth.of(self.cells, c.mean, c.std)
        with np.errstate(divide="ignore", invalid="ignore"):
            score = np.log(growth.value)
            by_mean, by_std = (slope / growth.value[:, None] for slope in growth.slopes())
        tiny = score < LOG_SURELY_A_NUMBER
        if tiny.any():
            exact = LogGrowth.of(self.cells, c.mean[:, tiny], c.std[:, tiny])
            score[tiny] = exact.score
            by_mean[:, tiny], by_std[:, tiny] = exact.slopes()
        if len(c.mean) == 1:
            by_mean = by_mean.sum(axis=0, keepdims=True)
        if len(c.std) == 1:
            by_std = by_std.sum(axis=0, keepdims=True)
        assert c.pullback is not None
        return score, c.pullback(by_mean, by_std)


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """The growth itself, and what its derivatives need; for points at which it does not vanish."""

    gains: tuple[Gain, ...]
    """Of edges, heights and layers."""

    height_of: IntArray

    @classmethod
    def of(cls, cells: Cells, mean: FloatArray, std: FloatArray) -> Growth:
        """Take it for means (S or 1, n, m) and standard deviations (S or 1, n, m)."""
        limits = (cells.edges, cells.heights) if cells.layers is None else (cells.edges, cells.heights, cells.layers)
        gains = tuple(Gain.of(limit, mean[:, :, k], std[:, :, k]) for k, limit in enumerate(limits))
        return cls(gains=gains, height_of=cells.height_of)

    @property
    def value(self) -> FloatArray:
        """Mean growth at n points, shape (n,), >= 0."""
        first, second = self.gains[0].steps, self.gains[1].value
        if len(self.gains) == 2:
            return np.asarray(np.einsum("sna,sna->n", first, self._at(second, 0)) / len(first))
        third = self.gains[2].steps
        layers = range(third.shape[2])
        total = sum(third[:, :, i] * np.einsum("sna,sna->sn", first, self._at(second, i)) for i in layers)
        return np.asarray(np.mean(total, axis=0))

    def _at(self, of_heights: FloatArray, layer: int) -> FloatArray:
        """Return what belongs to the heights of a layer's cells, (S, n, b) to (S, n, a)."""
        return np.take_along_axis(of_heights, self.height_of[:, layer, None], axis=2)

    def slopes(self) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of the mean growth by means and standard deviations, shapes (S, n, m)."""
        return self._slopes([-gain.cdf for gain in self.gains]), self._slopes([gain.density for gain in self.gains])

    def _slopes(self, slopes: list[FloatArray]) -> FloatArray:
        """Return the derivatives, given those of every gain."""
        first, second = self.gains[0].steps, self.gains[1].value
        first_slope = _differences(slopes[0])
        has_layers = len(self.gains) == 3
        third = self.gains[2].steps if has_layers else np.ones((*first.shape[:2], 1))
        third_slope = _differences(slopes[2]) if has_layers else None
        by = np.zeros((*first.shape[:2], len(self.gains)))
        for i in range(third.shape[2]):
            below = self._at(second, i)
            by[:, :, 0] += third[:, :, i] * np.einsum("sna,sna->sn", first_slope, below)
            by[:, :, 1] += third[:, :, i] * np.einsum("sna,sna->sn", first, self._at(slopes[1], i))
            if third_slope is not None:
                by[:, :, 2] += third_slope[:, :, i] * np.einsum("sna,sna->sn", first, below)
        return by / len(first)


@dataclass(frozen=True, slots=True, kw_only=True)
class Gain:
    """E[max(0, limit - y)] of k limits for n normal y in S scenarios; all of shape (S, n, k)."""

    value: FloatArray
    cdf: FloatArray
    """Minus its derivative by the mean."""

    density: FloatArray
    """Its derivative by the standard deviation."""

    @classmethod
    def of(cls, limits: FloatArray, mean: FloatArray, std: FloatArray) -> Gain:
        """Take it for limits (S, k), means (S or 1, n) and standard deviations (S or 1, n)."""
        std = std[:, :, None]
        z = (limits[:, None] - mean[:, :, None]) / std
        density = np.exp(-0.5 * z * z - LOG_SQRT_2PI)
        cdf = ndtr(z)
        return cls(value=np.maximum(std * (density + z * cdf), 0.0), cdf=cdf, density=density)

    @property
    def steps(self) -> FloatArray:
        """What each limit gains over the one before."""
        return np.maximum(_differences(self.value), 0.0)


def _differences(values: FloatArray) -> FloatArray:
    """Return the differences along the last axis, the first value as it is."""
    steps = values.copy()
    steps[..., 1:] -= values[..., :-1]
    return steps


@dataclass(frozen=True, slots=True, kw_only=True)
class LogGrowth:
    """The logarithm of every cell's part at n points, and what their derivatives need."""

    score: FloatArray
    """Log of the mean growth, shape (n,)."""

    share: FloatArray
    """Each cell's part of the growth, shape (S, n, c, a)."""

    z: tuple[FloatArray, ...]
    """Standardized edges, heights and layers, shapes (S, n, k)."""

    ratios: tuple[FloatArray, ...]
    """Gain of each edge, or layer, relative to the following one, shapes (S, n, k - 1)."""

    std: FloatArray
    height_of: IntArray

    @classmethod
    def of(cls, cells: Cells, mean: FloatArray, std: FloatArray) -> LogGrowth:
        """Take them for means (S or 1, n, m) and standard deviations (S or 1, n, m)."""
        first, *of_first = cls._log_steps(cells.edges, mean[:, :, 0], std[:, :, 0])
        z = (cells.heights[:, None] - mean[:, :, 1, None]) / std[:, :, 1, None]
        second = log_h(z) + np.log(std[:, :, 1, None])
        n_fronts = len(cells.height_of)
        index = np.broadcast_to(cells.height_of[:, None], (n_fronts, second.shape[1], *cells.height_of.shape[1:]))
        terms = first[:, :, None] + np.take_along_axis(second[:, :, None], index, axis=3)
        zs, ratios = [of_first[0], z], [of_first[1]]
        if cells.layers is not None:
            third, *of_third = cls._log_steps(cells.layers, mean[:, :, 2], std[:, :, 2])
            terms = terms + third[..., None]
            zs.append(of_third[0])
            ratios.append(of_third[1])
        n = terms.shape[1]
        total = log_sum_exp(np.moveaxis(terms, 1, -1).reshape(-1, n))
        with np.errstate(invalid="ignore"):
            share = np.nan_to_num(np.exp(terms - total[None, :, None, None]))
        score = total - math.log(n_fronts)
        return cls(score=score, share=share, z=tuple(zs), ratios=tuple(ratios), std=std, height_of=cells.height_of)

    @staticmethod
    def _log_steps(limits: FloatArray, mean: FloatArray, std: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the logs of the steps between the gains of rising limits, the limits' z, and the gains' ratios."""
        z = (limits[:, None] - mean[:, :, None]) / std[:, :, None]
        log_gain = log_h(z) + np.log(std[:, :, None])
        ratio = np.exp(np.minimum(log_gain[..., :-1] - log_gain[..., 1:], 0.0))
        with np.errstate(divide="ignore"):
            rest = log_gain[..., 1:] + np.log1p(-ratio)
        return np.concatenate([log_gain[..., :1], rest], axis=2), z, ratio

    def slopes(self) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of the score by means and standard deviations, shapes (S, n, m)."""
        by_mean, by_std = [], []
        for k, z in enumerate(self.z):
            std, slope = self.std[:, :, k], log_h_slope(z)
            by_mean.append(-self._sum(k, slope) / std)
            by_std.append(self._sum(k, 1 - slope * z) / std)
        return np.stack(by_mean, axis=2), np.stack(by_std, axis=2)

    def _sum(self, k: int, slopes: FloatArray) -> FloatArray:
        """Return the mean over all cells, by their parts, of what belongs to objective k's limits, shape (S, n)."""
        if k == 1:
            index = np.broadcast_to(self.height_of[:, None], self.share.shape)
            return np.asarray((self.share * np.take_along_axis(slopes[:, :, None], index, axis=3)).sum(axis=(2, 3)))
        share = self.share.sum(axis=2 if k == 0 else 3)
        return np.asarray((share * _log_difference(slopes, self.ratios[k // 2])).sum(axis=2))


def _log_difference(slopes: FloatArray, ratio: FloatArray) -> FloatArray:
    """Return the derivatives of log(g_i - g_(i-1)), from those of log g_i and the ratios g_(i-1) / g_i."""
    rest = 1.0 - ratio
    with np.errstate(divide="ignore", invalid="ignore"):
        inner = (slopes[..., 1:] - ratio * slopes[..., :-1]) / rest
    return np.concatenate([slopes[..., :1], np.where(rest > 0, inner, 0.0)], axis=-1)
