"""Tests for reported.py."""

import numpy as np
import pytest

from hypermap_lite.surrogates.base import Prediction
from hypermap_lite.surrogates.reported import AsReported, MixtureOfModes, TwoModes, WithFailures
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


class Explained(Known):
    """Knows how much it knows."""

    def __init__(self, mean, std, explained) -> None:
        super().__init__(mean, std)
        self._explained = explained

    def explained(self):
        return None if self._explained is None else np.array(self._explained)


def modes(first=(0.5, 0.0), second=(0.2, 0.9)) -> TwoModes:
    return TwoModes(
        posteriors=(
            Explained([[1.0, 2.0]] * 3, [[0.2, 0.3]] * 3, first),
            Explained([[5.0, 0.0]] * 3, [[0.1, 0.4]] * 3, second),
        ),
        chances=(Chance(0.9, 0.1, 0.2), Chance(0.05, 0.6, 0.2)),  # the rest may be infeasible
        points=(np.array([[0.25], [0.75]]), np.array([[0.5], [0.75]])),
    )


def test_what_was_evaluated_is_of_the_kind_that_it_was_of() -> None:
    assert modes().are_first(np.array([[0.5], [0.25], [0.1]])).tolist() == [False, True, True]
    assert modes().are_first(np.full((3, 1), 0.75)).tolist() == [True, False, True]  # once so, once otherwise


def test_of_two_modes_the_likelier_one_is_predicted() -> None:
    prediction = modes().predict(np.zeros((3, 1)))
    assert prediction.mean.tolist() == [[1.0, 2.0], [5.0, 0.0], [1.0, 2.0]]
    assert prediction.std.tolist() == [[0.2, 0.3], [0.1, 0.4], [0.2, 0.3]]


def test_what_either_mode_explains_is_explained() -> None:
    explained = modes().explained()
    assert explained is not None
    assert explained.tolist() == [0.5, 0.9]
    assert modes(second=None).explained() is None


def test_the_mixture_of_two_modes_has_the_moments_of_draws() -> None:
    prediction, rng, n = MixtureOfModes(modes()).predict(np.zeros((3, 1))), np.random.default_rng(0), 400_000
    is_first = rng.random((n, 1)) < 0.1 / 0.7
    draws = np.where(is_first, rng.normal([1.0, 2.0], [0.2, 0.3], (n, 2)), rng.normal([5.0, 0.0], [0.1, 0.4], (n, 2)))
    assert prediction.mean[1] == pytest.approx(draws.mean(axis=0), abs=0.01)
    assert prediction.std[1] == pytest.approx(draws.std(axis=0), abs=0.01)
