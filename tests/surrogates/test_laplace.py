"""Tests for laplace.py."""

import numpy as np
import pytest
from scipy.special import log_ndtr
from scipy.stats import norm

from hypermap_lite.surrogates.laplace import Laplace, derivatives

RNG = np.random.default_rng(0)
X = RNG.random((20, 2))
SQUARES = ((X[:, None] - X[None]) ** 2).sum(axis=-1)
LABELS = np.where(X.sum(axis=1) > 1.1, 1.0, -1.0)


def covariance(theta) -> np.ndarray:
    return np.exp(theta[1]) * np.exp(-0.5 * SQUARES / np.exp(2 * theta[0])) + 1.0


def test_derivatives_are_those_of_the_log_likelihood() -> None:
    f, h = 3 * RNG.standard_normal(20), 1e-5
    slope, curvature, third = derivatives(f, LABELS)
    value = [log_ndtr(LABELS * (f + step)) for step in (-h, h)]
    np.testing.assert_allclose(slope, (value[1] - value[0]) / (2 * h), atol=1e-8)
    before, after = derivatives(f - h, LABELS), derivatives(f + h, LABELS)
    np.testing.assert_allclose(-curvature, (after[0] - before[0]) / (2 * h), atol=1e-7)
    np.testing.assert_allclose(-third, (after[1] - before[1]) / (2 * h), atol=1e-7)


def test_mode_of_one_label_solves_its_equation() -> None:
    (f,) = Laplace.at(np.array([[4.0]]), np.array([1.0])).latent
    assert f == pytest.approx(4.0 * norm.pdf(f) / norm.cdf(f), rel=1e-3)


def test_mode_is_where_the_prior_pulls_as_much_as_the_labels() -> None:
    K = covariance([-1.0, 4.0])
    laplace = Laplace.at(K, LABELS)
    np.testing.assert_allclose(K @ laplace.slope, laplace.latent, atol=1e-2)


def test_evidence_of_one_label_is_close_to_one_half() -> None:
    assert np.exp(Laplace.at(np.array([[1.0]]), np.array([-1.0])).log_evidence) == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("j", [0, 1])
def test_evidence_has_the_slope_that_its_weights_say(j) -> None:
    theta, h = np.array([-1.0, 1.0]), 1e-5 * np.eye(2)[j]
    values = [Laplace.at(covariance(t), LABELS).log_evidence for t in (theta - h, theta + h)]
    change = (covariance(theta + h) - covariance(theta - h)) / 2e-5
    expected = (Laplace.at(covariance(theta), LABELS).evidence_weights() * change).sum()
    assert (values[1] - values[0]) / 2e-5 == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("theta", [(-1.0, 1.0), (-1.0, 4.0), (1.0, 2.0)])
def test_what_is_left_out_is_foretold_as_by_all_others_alone(theta) -> None:
    K = covariance(theta)
    expected = []
    for i in range(len(X)):
        others = np.arange(len(X)) != i
        laplace = Laplace.at(K[np.ix_(others, others)], LABELS[others])
        v = np.linalg.solve(laplace.L, laplace.root * K[others, i])
        mean, variance = K[others, i] @ laplace.slope, K[i, i] - v @ v
        expected.append(log_ndtr(LABELS[i] * mean / np.sqrt(1 + variance)))
    found = Laplace.at(K, LABELS).log_left_out(LABELS)
    np.testing.assert_allclose(np.exp(found), np.exp(expected), atol=0.08)  # the mode moves with each label
    assert np.abs(np.exp(found) - np.exp(expected)).mean() < 0.02
