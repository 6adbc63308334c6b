"""Tests for reported.py."""

import numpy as np
import pytest

from hypermap_lite.surrogates.base import Prediction
from hypermap_lite.surrogates.reported import AsReported, WithFailures
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


class Chance:
    """Knows how likely success is."""

    def __init__(self, *probabilities: float) -> None:
        self.probabilities = np.array(probabilities)

    def log_probability(self, X):
        return np.log(self.probabilities)


def test_with_failures_a_prediction_is_that_of_the_mixture() -> None:
    failed = np.array([[6.0, 0.5], [7.0, 0.1], [6.5, 0.9]])
    known = Known([[1.0, 2.0]] * 3, [[0.2, 0.3]] * 3)
    whole = WithFailures(predictor=known, success=Chance(1.0, 0.3, 1e-9), failed=failed)
    prediction = whole.predict(np.zeros((3, 1)))
    assert prediction.mean[0] == pytest.approx([1.0, 2.0])
    assert prediction.std[0] == pytest.approx([0.2, 0.3])
    assert prediction.mean[2] == pytest.approx(failed.mean(axis=0))
    assert prediction.std[2] == pytest.approx(failed.std(axis=0), rel=1e-6)
    rng = np.random.default_rng(0)
    n = 400_000
    succeeds = rng.random((n, 1)) < 0.3
    drawn = np.where(succeeds, rng.normal([1.0, 2.0], [0.2, 0.3], (n, 2)), failed[rng.integers(3, size=n)])
    assert prediction.mean[1] == pytest.approx(drawn.mean(axis=0), rel=0.01)
    assert prediction.std[1] == pytest.approx(drawn.std(axis=0), rel=0.01)
