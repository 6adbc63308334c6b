"""Expected improvement in log form, and the scorers made from it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import erfcx, log_ndtr

from hypermap_lite.acquisition.base import Rough
from hypermap_lite.scalarization.base import Normalization, Scalarization
from hypermap_lite.surrogates.base import Conditional, Field
from hypermap_lite.typing import FloatArray

LOG_SQRT_2PI = 0.5 * math.log(2 * math.pi)
SQRT_HALF_PI = math.sqrt(math.pi / 2)
FAR_TAIL = -1e5
"""Below this, the closed form loses its digits and the leading term of its expansion is exact."""

SMOOTHING = 1e-2
"""Width over which sampled improvements fade to zero, in normalized objectives."""


def log_h(z: FloatArray) -> FloatArray:
    r"""Return log(phi(z) + z Phi(z)), the log expected improvement of a unit normal over -z.

    Exact in both tails [1]_: for z > -1 directly; below, with the scaled complementary error function,
    log phi(z) + log(1 - sqrt(pi/2) |z| erfcx(|z|/sqrt 2)); far below, log phi(z) - 2 log|z|.

    References
    ----------
    .. [1] Ament et al. Unexpected Improvements to Expected Improvement for Bayesian Optimization, eq. 9.
       NeurIPS 2023.
    """
    z = np.asarray(z, dtype=float)
    log_phi = -0.5 * z * z - LOG_SQRT_2PI
    upper = np.maximum(z, -1.0)
    direct = np.log(np.exp(-0.5 * upper * upper - LOG_SQRT_2PI) + upper * np.exp(log_ndtr(upper)))
    size = np.clip(-z, 1.0, -FAR_TAIL)
    middle = log_phi + np.log1p(-SQRT_HALF_PI * size * erfcx(size / math.sqrt(2)))
    far = log_phi - 2 * np.log(np.maximum(-z, 1.0))
    return np.where(z > -1.0, direct, np.where(z > FAR_TAIL, middle, far))


def log_h_slope(z: FloatArray) -> FloatArray:
    """Return the derivative of `log_h`, Phi(z) / (phi(z) + z Phi(z)), which tends to -z in the lower tail."""
    z = np.asarray(z, dtype=float)
    upper = np.maximum(z, -1.0)
    cdf = np.exp(log_ndtr(upper))
    direct = cdf / (np.exp(-0.5 * upper * upper - LOG_SQRT_2PI) + upper * cdf)
    size = np.clip(-z, 1.0, -FAR_TAIL)
    mills = SQRT_HALF_PI * erfcx(size / math.sqrt(2))  # Phi(-size) / phi(size)
    middle = mills / (1.0 - size * mills)
    return np.where(z > -1.0, direct, np.where(z > FAR_TAIL, middle, -z))


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearImprovement:
    """Log of the weighted sum of the objectives' expected improvements, averaged over scenarios.

    With one scenario and the best observed values as incumbents it is EI, with draws of the noise-free values it is
    noisy EI; with one objective both are the usual single-objective forms.
    """

    field: Field
    incumbents: FloatArray
    """Best value of each objective in each scenario, shape (S, m)."""

    weights: FloatArray
    scale: FloatArray
    """Units in which the objectives are compared, shape (m,)."""

    is_differentiable: bool

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the log acquisition value at n points, shape (n,)."""
        return self._score(self.field(X))[0]

    def _score(self, c: Conditional) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the scores (n,), and z and the log terms of the sum, both (S, n, m)."""
        z = (self.incumbents[:, None, :] - c.mean) / c.std
        with np.errstate(divide="ignore"):
            terms = log_h(z) + np.log(c.std) + np.log(self.weights / self.scale)
        return log_sum_exp(np.moveaxis(terms, 2, 1).reshape(-1, terms.shape[1])) - math.log(len(z)), z, terms

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        score, z, terms = self._score(c)
        with np.errstate(invalid="ignore"):
            share = np.nan_to_num(np.exp(terms - (score + math.log(len(z)))[None, :, None]))  # each term's part
        slope = log_h_slope(z)
        by_mean = -share * slope / c.std
        by_std = share * (1.0 - slope * z) / c.std
        assert c.pullback is not None
        return score, c.pullback(by_mean, by_std)


@dataclass(frozen=True, slots=True, kw_only=True)
class SampledImprovement:
    """Log of the mean improvement of a scalarization over joint samples of all objectives.

    The improvement max(0, t) is smoothed to s log(1 + exp(t / s)), whose logarithm has a slope everywhere [1]_.

    References
    ----------
    .. [1] Ament et al. Unexpected Improvements to Expected Improvement for Bayesian Optimization, sec. 4.
       NeurIPS 2023.
    """

    field: Field
    incumbents: FloatArray
    """Best scalar in each sample, shape (E,)."""

    normal: FloatArray
    """One standard normal draw per sample and objective, shape (E, m), E a multiple of the scenarios or one."""

    scalarization: Scalarization
    weights: FloatArray
    normalization: Normalization
    is_differentiable: bool
    screening: int = 0
    """Samples that tell which points are worth a closer look; 0 for all."""

    def __call__(self, X: FloatArray) -> FloatArray:
        """Return the log acquisition value at n points, shape (n,)."""
        return self._score(self.field(X))[0]

    @property
    def rough(self) -> Rough | None:
        """The same over a few of the samples."""
        return self._rough if 0 < self.screening < len(self.normal) else None

    def _rough(self, X: FloatArray) -> FloatArray:
        c, few = self.field(X), slice(self.screening)
        mean = c.mean if len(c.mean) == 1 else c.mean[few]
        std = c.std if len(c.std) == 1 else c.std[few]
        part = replace(self, incumbents=self.incumbents[few], normal=self.normal[few])
        return part._score(Conditional(mean=mean, std=std))[0]

    def _score(self, c: Conditional) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the scores (n,), the normalized samples (E, n, m), improvements and log smooth improvements (E, n)."""
        samples = self.normalization(c.mean + c.std * self.normal[:, None, :])
        t = (self.incumbents[:, None] - self.scalarization(samples, self.weights)) / SMOOTHING
        log_improvement = log_softplus(t) + math.log(SMOOTHING)
        score = log_sum_exp(log_improvement) - math.log(len(t))
        return score, samples, t, log_improvement

    def with_gradient(self, X: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the scores, shape (n,), and their gradients, shape (n, d)."""
        c = self.field(X)
        score, samples, t, log_improvement = self._score(c)
        log_sigmoid = -np.logaddexp(0.0, -t)
        by_t = np.exp(log_improvement + log_sigmoid - log_softplus(t) - score - math.log(len(t))) / SMOOTHING
        by_sample = -by_t[..., None] * self.scalarization.gradient(samples, self.weights) / self.normalization.scale
        by_mean, by_std = by_sample, by_sample * self.normal[:, None, :]
        return score, c.gradient(by_mean, by_std)


def log_sum_exp(terms: FloatArray) -> FloatArray:
    """Return log(sum(exp(terms))) over the first of two axes, shape (k, n) to (n,); -inf where all terms are."""
    largest = terms.max(axis=0)
    shift = np.where(np.isfinite(largest), largest, 0.0)
    with np.errstate(divide="ignore"):
        return shift + np.log(np.exp(terms - shift).sum(axis=0))


def log_softplus(t: FloatArray) -> FloatArray:
    """Return log(log(1 + exp(t))), which is t far below zero and log(t) far above."""
    inner = np.maximum(t, -30.0)
    return np.where(t < -30.0, t, np.log(np.logaddexp(0.0, inner)))
