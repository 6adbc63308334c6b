"""Predictions in the units in which the objectives are reported."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.surrogates.base import Prediction, Predictor
from hypermap_lite.surrogates.feasibility import FeasibilityPosterior
from hypermap_lite.surrogates.tails import Tails
from hypermap_lite.typing import FloatArray


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
        mean = p * of_success.mean + (1 - p) * failed_mean
        apart = p * (1 - p) * (of_success.mean - failed_mean) ** 2
        return Prediction(mean=mean, std=np.sqrt(p * of_success.std**2 + (1 - p) * failed_variance + apart))
