"""Tests for expectation_propagation.py."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from hypermap_lite.surrogates.expectation_propagation import ExpectationPropagation
from hypermap_lite.surrogates.laplace import Laplace


def covariance(X, variance=9.0):
    squares = ((X[:, None] - X[None]) ** 2).sum(axis=-1)
    return variance * np.exp(-0.5 * squares / 0.3**2) + 1.0


@pytest.mark.parametrize("n", [1, 3, 35])
def test_labels_of_one_place_have_the_mean_of_quadrature_and_one_label_its_variance(n) -> None:
    """All labels are of one latent value, whose posterior density is one-dimensional."""
    K = np.full((n, n), 9.0)

    def moment(k):
        return quad(lambda f: f**k * norm.pdf(f, scale=3) * norm.cdf(-f) ** n, -20, 20, epsabs=1e-14)[0]

    mean = moment(1) / moment(0)
    found, mode = (method.at(K, -np.ones(n)) for method in (ExpectationPropagation, Laplace))
    np.testing.assert_allclose(found.latent, mean, rtol=0.03)
    assert np.all(np.abs(found.latent - mean) < np.abs(mode.latent - mean))
    if n == 1:
        v = np.linalg.solve(found.L, found.root * K[0])
        assert 9.0 - v @ v == pytest.approx(moment(2) / moment(0) - mean**2, rel=1e-4)


def test_probability_among_infeasible_ones_is_that_of_quadrature_where_the_mode_is_unsure() -> None:
    n = 35

    def mass(k):
        return quad(lambda f: norm.pdf(f, scale=3) * norm.cdf(-f) ** n * norm.cdf(f) ** k, -20, 20, epsabs=1e-14)[0]

    def probability(values):
        v = np.linalg.solve(values.L, values.root * 9.0)
        return norm.cdf(values.latent[0] / np.sqrt(1 + 9.0 - v @ v))

    K, labels = np.full((n, n), 9.0), -np.ones(n)
    exact = mass(1) / mass(0)
    assert probability(ExpectationPropagation.at(K, labels)) == pytest.approx(exact, rel=0.3)
    assert probability(Laplace.at(K, labels)) > 3 * exact


@pytest.mark.parametrize("kind", ["a boundary", "chance", "one kind"])
@pytest.mark.parametrize("variance", [4.0, 1000.0])
def test_sites_leave_the_moments_of_each_label(kind, variance) -> None:
    """What defines the fixed point: a site put back in place of its label changes neither mean nor variance."""
    rng = np.random.default_rng(3)
    X = np.vstack([rng.random((30, 2)), [0.4, 0.6] + 0.02 * rng.random((20, 2))])
    labels = {"a boundary": np.sign(X.sum(axis=1) - 1), "chance": rng.choice([-1.0, 1.0], 50), "one kind": -np.ones(50)}
    K = covariance(X, variance)
    found = ExpectationPropagation.at(K, labels[kind])
    np.testing.assert_allclose(K @ found.slope, found.latent)
    precision = found.root**2
    posterior = np.linalg.inv(np.linalg.inv(K + 1e-9 * np.eye(50)) + np.diag(precision))
    rest = 1 / np.diag(posterior) - precision
    shift = found.latent / np.diag(posterior) - (found.slope + precision * found.latent)
    mean, var = shift / rest, 1 / rest
    z = labels[kind] * mean / np.sqrt(1 + var)
    ratio = norm.pdf(z) / norm.cdf(z)
    scale = np.abs(found.latent).max()
    np.testing.assert_allclose(found.latent, mean + labels[kind] * var * ratio / np.sqrt(1 + var), atol=3e-3 * scale)


def test_all_labels_reversed_reverse_the_means() -> None:
    X = np.random.default_rng(1).random((20, 3))
    labels = np.where(X[:, 0] > 0.5, 1.0, -1.0)
    one, other = (ExpectationPropagation.at(covariance(X), sign * labels) for sign in (1, -1))
    np.testing.assert_allclose(one.latent, -other.latent, atol=1e-6)
