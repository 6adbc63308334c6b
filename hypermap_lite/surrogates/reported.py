"""Predictions in the units in which the objectives are reported."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.surrogates.base import Posterior, Prediction, Predictor
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.surrogates.tails import Tails
from hypermap_lite.typing import BoolArray, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class AsReported:
    """What a posterior of objectives with compressed tails predicts of the objectives themselves."""

    posterior: Predictor
    tails: Tails

    def predict(self, X: FloatArray) -> Prediction:
        """Predict the noise-free objectives at n points, shape (n, d).

        Above the limit of a tail the mean is what the mean of the compressed values stands for, which is the median,
        and the standard deviation half the distance of what one up and one down stand for.
        """
        prediction = self.posterior.predict(X)
        means, stds = [], []
        for k, tail in enumerate(self.tails):
            mean, std = prediction.mean[:, k], prediction.std[:, k]
            if tail is not None:
                low, high = tail.stretch(mean - std), tail.stretch(mean + std)
                mean, std = tail.stretch(mean), np.where(mean + std > tail.limit, (high - low) / 2, std)
            means.append(mean)
            stds.append(std)
        return Prediction(mean=np.column_stack(means), std=np.column_stack(stds))


@dataclass(frozen=True, slots=True, kw_only=True)
class WithFailures:
    """What is predicted of objectives where some evaluations fail: a mixture of successes and failures."""

    predictor: Predictor
    """Of successes."""

    success: FeasibilityPosterior
    """Where they are."""

    failed: FloatArray
    """Objectives of k failures, shape (k, m), k >= 1, of which any other may be one."""

    def predict(self, X: FloatArray) -> Prediction:
        """Predict the noise-free objectives at n points, shape (n, d): mean and standard deviation of the mixture."""
        of_success, p = self.predictor.predict(X), np.exp(self.success.log_probability(X))[:, None]
        failed_mean, failed_variance = self.failed.mean(axis=0), self.failed.var(axis=0)
        failed = Prediction(mean=failed_mean[None], std=np.sqrt(failed_variance)[None])
        return _mixture(p, of_success, failed)


@dataclass(frozen=True, slots=True, kw_only=True)
class TwoModes:
    """What is known of objectives whose values are of two kinds: what each is like, and where it is likely."""

    posteriors: tuple[Posterior, Posterior]
    """Of either kind."""

    chances: tuple[FeasibilityPosterior, FeasibilityPosterior]
    """That a configuration is feasible and of that kind."""

    points: tuple[FloatArray, FloatArray]
    """Evaluations of either kind, shapes (k, d) and (n - k, d)."""

    def predict(self, X: FloatArray) -> Prediction:
        """Predict the noise-free objectives at n points, shape (n, d), each by its likelier kind.

        Their mean over both kinds is often of neither. Of an evaluated point the kind is known.
        """
        is_first = self.are_first(X)[:, None]
        a, b = (posterior.predict(X) for posterior in self.posteriors)
        return Prediction(mean=np.where(is_first, a.mean, b.mean), std=np.where(is_first, a.std, b.std))

    def are_first(self, X: FloatArray) -> BoolArray:
        """Tell which of n points, shape (n, d), were of the first kind, or else are more likely to be, shape (n,)."""
        first, second = (chance.log_probability(X) for chance in self.chances)
        were_first, were_second = ({x.tobytes() for x in points} for points in self.points)
        seen = [(x.tobytes() in were_first) - (x.tobytes() in were_second) for x in np.ascontiguousarray(X)]
        return np.where(seen, np.array(seen) > 0, first >= second)

    def explained(self) -> FloatArray | None:
        """Return how much is known of each objective of the kind of which more is; see `Posterior.explained`."""
        a, b = (posterior.explained() for posterior in self.posteriors)
        return None if a is None or b is None else np.maximum(a, b)


@dataclass(frozen=True, slots=True)
class MixtureOfModes:
    """What is expected of either kind, in one mean and standard deviation."""

    modes: TwoModes

    def predict(self, X: FloatArray) -> Prediction:
        """Predict the noise-free objectives at n points, shape (n, d): mean and standard deviation of the mixture."""
        first, second = (chance.log_probability(X) for chance in self.modes.chances)
        p = np.exp(first - np.logaddexp(first, second))[:, None]
        return _mixture(p, *(posterior.predict(X) for posterior in self.modes.posteriors))


def _mixture(p: FloatArray, a: Prediction, b: Prediction) -> Prediction:
    """Return the mean and the standard deviation of what is like a with the probabilities p, shape (n, 1), else b."""
    variance = p * a.std**2 + (1 - p) * b.std**2 + p * (1 - p) * (a.mean - b.mean) ** 2
    return Prediction(mean=p * a.mean + (1 - p) * b.mean, std=np.sqrt(variance))
