"""What outputs may be off by."""

import numpy as np
import pytest

from hypermap_lite.surrogates.offsets import SAYS_NOTHING, Offsets

OFFSETS = Offsets(np.array([False, False, True, True]), 2.0, np.array([0.0, 0.5, 0.1, 0.0]))


def test_draws_have_the_covariance() -> None:
    rng = np.random.default_rng(0)
    draws = np.array([OFFSETS.draw(rng) for _ in range(20_000)])
    assert np.cov(draws.T, bias=True) == pytest.approx(OFFSETS.covariance, abs=0.06)
    assert draws.mean(axis=0) == pytest.approx(np.zeros(4), abs=0.05)


def test_constant_is_shared_by_outputs_beside_alone() -> None:
    assert OFFSETS.covariance.tolist() == [[0, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 2.1, 2], [0, 0, 2, 2]]


def test_more_outputs_are_off_by_nothing() -> None:
    padded = OFFSETS.padded(2).covariance
    assert np.array_equal(padded[:4, :4], OFFSETS.covariance)
    assert not padded[4:].any()


def test_outliers_say_nothing_and_share_nothing() -> None:
    offsets = Offsets.of_outliers(np.array([False, True, True]))
    assert offsets.says_something.tolist() == [True, False, False]
    assert offsets.covariance.tolist() == np.diag([0, SAYS_NOTHING, SAYS_NOTHING]).tolist()
    assert OFFSETS.says_something.all()
