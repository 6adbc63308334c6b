"""Tests for reported.py."""

import numpy as np
import pytest

from hypermap_lite.surrogates.base import Prediction
from hypermap_lite.surrogates.reported import AsReported
from hypermap_lite.surrogates.tails import Tail

TAIL = Tail(limit=1.0, spread=0.5, highest=1e5)


class Known:
    """Predicts compressed values."""

    def __init__(self, mean, std) -> None:
        self.prediction = Prediction(mean=np.array(mean), std=np.array(std))

    def predict(self, X):
        return self.prediction


def test_nothing_changes_below_the_limit_and_without_a_tail() -> None:
    known = Known([[0.2, 5.0], [0.4, 9.0]], [[0.1, 3.0], [0.3, 4.0]])
    prediction = AsReported(posterior=known, tails=(TAIL, None)).predict(np.zeros((2, 1)))
    assert np.array_equal(prediction.mean, known.prediction.mean)
    assert np.array_equal(prediction.std, known.prediction.std)


def test_means_beyond_it_are_what_they_stand_for() -> None:
    reported = 2e4
    z = TAIL.compress(np.array([[reported]]))
    prediction = AsReported(posterior=Known(z, [[0.01]]), tails=(TAIL,)).predict(np.zeros((1, 1)))
    assert prediction.mean[0, 0] == pytest.approx(reported)
    slope = np.exp(TAIL.log_slope(np.array([reported])))[0]
    assert prediction.std[0, 0] == pytest.approx(0.01 / slope, rel=0.01)
