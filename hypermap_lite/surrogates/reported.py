"""Predictions in the units in which the objectives are reported."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypermap_lite.surrogates.base import Prediction, Predictor
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
