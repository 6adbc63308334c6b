"""Tests for replicate_noise.py."""

import numpy as np
import pytest

from hypermap_lite.history.replicate_noise import shrunk_variances


def column(*values):
    return np.array(values, dtype=float)[:, None]


def test_estimate_is_the_weighted_mean_of_own_and_pooled_variance():
    # pooled: (2 * 1 + 2 * 4 + 6 * 0) / 10 = 1; then (4 * 1 + nu s^2) / (4 + nu)
    assert shrunk_variances(column(1, 4, 0), column(2, 2, 6)).ravel() == pytest.approx([1.0, 2.0, 0.4])


def test_single_replicate_has_the_pooled_variance():
    estimate = shrunk_variances(column(9, np.nan), column(3, 0))
    assert estimate.ravel() == pytest.approx([9.0, 9.0])


def test_many_replicates_speak_for_themselves():
    estimate = shrunk_variances(column(2, 8), column(1e9, 1e9))
    assert estimate.ravel() == pytest.approx([2.0, 8.0])


def test_objectives_are_independent():
    variances, freedom = np.array([[1.0, 10.0], [3.0, 30.0]]), np.full((2, 2), 5.0)
    estimate = shrunk_variances(variances, freedom)
    assert estimate[:, 1] == pytest.approx(10 * estimate[:, 0])


@pytest.mark.parametrize(
    "freedom",
    [
        pytest.param(np.zeros((3, 2)), id="one replicate everywhere"),
        pytest.param(np.array([[1.0, 0.0]] * 3), id="one objective without spread"),
        pytest.param(np.zeros((0, 2)), id="no configuration"),
    ],
)
def test_nothing_is_known_without_a_degree_of_freedom(freedom):
    assert shrunk_variances(np.full(freedom.shape, np.nan), freedom) is None


def test_shrunk_variances_are_closer_to_the_truth_than_sample_variances():
    rng = np.random.default_rng(0)
    truth = 4 / rng.chisquare(4, size=(2000, 1))  # drawn as the estimator assumes
    samples = np.sqrt(truth)[:, :, None] * rng.standard_normal((2000, 1, 4))
    variances = samples.var(axis=2, ddof=1)
    shrunk = shrunk_variances(variances, np.full(variances.shape, 3.0))
    error = {name: np.mean((np.log(v) - np.log(truth)) ** 2) for name, v in (("own", variances), ("shrunk", shrunk))}
    assert error["shrunk"] < 0.5 * error["own"]
