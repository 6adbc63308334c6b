"""The fit of the hyperparameters."""

import math

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

from hypermap_lite.space import PermutationParameter
from hypermap_lite.surrogates.gaussian_process import GaussianProcess
from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.surrogates.marginal_likelihood import (
    Hyperparameters,
    HyperPrior,
    MarginalLikelihood,
    constant_mean,
    fit_hyperparameters,
)


def example(n: int = 25, categorical: bool = False) -> MarginalLikelihood:
    rng = np.random.default_rng(0)
    X = rng.random((n, 3))
    is_ordered = np.array([True, True, not categorical])
    if categorical:
        X[:, 2] = (rng.integers(3, size=n) + 0.5) / 3
    y = np.sin(6 * X[:, 0]) + X[:, 2] + 0.1 * rng.standard_normal(n)
    return MarginalLikelihood(X, (y - y.mean()) / y.std(), is_ordered, HyperPrior(3))


@pytest.mark.parametrize("categorical", [False, True])
def test_gradient_agrees_with_finite_differences(categorical: bool) -> None:
    likelihood = example(categorical=categorical)
    for seed in range(3):
        theta = likelihood.prior.mode().to_log() + 0.5 * np.random.default_rng(seed).standard_normal(5)
        numeric = approx_fprime(theta, lambda t: likelihood(t)[0], 1e-7)
        assert likelihood(theta)[1] == pytest.approx(numeric, rel=1e-4, abs=1e-4)


def test_value_is_scikit_learns_likelihood_plus_the_prior() -> None:
    likelihood = example()
    h = Hyperparameters(np.array([0.4, 0.9, 2.0]), 1.7, 0.03)
    kernel = ConstantKernel(1.7) * Matern(h.lengthscales, nu=2.5) + WhiteKernel(0.03)
    K = kernel(likelihood.X)
    mean = constant_mean(np.linalg.inv(K), likelihood.y)
    oracle = GaussianProcessRegressor(kernel, alpha=0, optimizer=None).fit(likelihood.X, likelihood.y - mean)
    penalty = likelihood.prior.penalty(h.to_log())[0]
    assert likelihood(h.to_log())[0] == pytest.approx(-oracle.log_marginal_likelihood_value_ + penalty, rel=1e-9)


def test_penalty_is_the_negative_log_normal_density_up_to_a_constant() -> None:
    prior = HyperPrior(4)
    a, b = math.log(0.3), math.log(2.0)
    mu, sigma = prior.lengthscale_mu, prior.lengthscale_sigma

    def negative_log_density(log_x: float) -> float:
        return log_x + 0.5 * ((log_x - mu) / sigma) ** 2

    theta = prior.mode().to_log()
    first, second = theta.copy(), theta.copy()
    first[0], second[0] = a, b
    difference = prior.penalty(first)[0] - prior.penalty(second)[0]
    assert difference == pytest.approx(negative_log_density(a) - negative_log_density(b))


@pytest.mark.parametrize("log_noise", [-20.0, -8.5, -8.0, -7.5, 0.0])
def test_the_noise_prior_has_a_width_of_its_own_on_either_side_of_its_mode(log_noise: float) -> None:
    prior, mode = HyperPrior(1, noise_tail=5.0), math.log(HyperPrior(1).mode().noise_variance)
    at, at_mode = (np.array([0.3, 0.1, value]) for value in (log_noise, mode))
    width = 5.0 if log_noise < mode else 2.0
    assert prior.penalty(at)[0] - prior.penalty(at_mode)[0] == pytest.approx(0.5 * ((log_noise - mode) / width) ** 2)
    assert prior.penalty(at)[1][-1] == pytest.approx((log_noise - mode) / width**2)


def test_with_a_long_tail_an_objective_without_noise_is_sooner_taken_for_one() -> None:
    X = np.random.default_rng(0).random((25, 2))
    y = np.sin(3 * X[:, 0]) + X[:, 1] ** 2
    short, long = (
        GaussianProcess(noise_tail=tail).fit(
            X, y[:, None], is_ordered=np.array([True, True]), rng=np.random.default_rng(0)
        )
        for tail in (2.0, 5.0)
    )
    noise = [posterior.hyperparameters[0].noise_variance for posterior in (short, long)]
    assert noise[1] < 0.1 * noise[0]


def test_lengthscale_prior_has_the_published_parameters() -> None:
    prior = HyperPrior(9)
    assert prior.lengthscale_mu == pytest.approx(math.sqrt(2) + math.log(3))
    assert prior.mode().lengthscales == pytest.approx(np.full(9, 3 * math.exp(math.sqrt(2) - 3)))


@pytest.mark.parametrize("n_axes", [1, 3, 20])
def test_points_that_differ_in_all_categories_keep_their_correlation_however_many_there_are(n_axes: int) -> None:
    is_ordered = np.zeros(n_axes, dtype=bool)
    mode = HyperPrior.over(is_ordered, {}).mode()
    X = np.array([np.full(n_axes, 0.25), np.full(n_axes, 0.75)])
    assert MaternHammingKernel(mode.lengthscales, is_ordered)(X, X)[0, 1] == pytest.approx(math.exp(-2))


def test_the_mode_of_categorical_lengthscales_is_where_their_prior_is_densest() -> None:
    prior = HyperPrior.over(np.array([True, False, False]), {})
    mode = prior.mode().to_log()
    assert np.exp(mode[1:3]) == pytest.approx([1, 1])
    assert prior.penalty(mode)[1][:3] == pytest.approx([0, 0, 0], abs=1e-12)


def test_categories_leave_the_prior_of_other_axes_as_it_is() -> None:
    permutation = PermutationParameter(name="order", size=4)
    prior = HyperPrior.over(np.array([True, False, False]), {2: permutation})
    mu, sigma = prior.lengthscale_priors()
    assert mu[[0, 2]].tolist() == [HyperPrior(3).lengthscale_mu] * 2
    assert sigma[[0, 2]].tolist() == [HyperPrior(3).lengthscale_sigma] * 2


def test_a_space_without_categories_has_the_prior_it_always_had() -> None:
    theta = np.linspace(-2, 1, 6)
    with_axes, plain = HyperPrior.over(np.ones(4, dtype=bool), {}), HyperPrior(4)
    assert with_axes == plain
    mu = np.array([*[plain.lengthscale_mu] * 4, 0.0, plain.noise_mu])
    sigma = np.array([*[plain.lengthscale_sigma] * 4, plain.output_sigma, plain.noise_sigma])
    z, jacobian = (theta - mu) / sigma, np.array([1.0, 1.0, 1.0, 1.0, 0.0, 1.0])
    value, gradient = with_axes.penalty(theta)
    assert value == float((0.5 * z * z + jacobian * theta).sum())
    assert np.array_equal(gradient, z / sigma + jacobian)


def test_twenty_categorical_axes_are_learnt_from_sixty_evaluations() -> None:
    rng = np.random.default_rng(0)
    levels = rng.integers(3, size=(160, 20))
    worth = rng.standard_normal((20, 3))
    X, y = (levels + 0.5) / 3, worth[np.arange(20), levels].sum(axis=1)
    posterior = GaussianProcess().fit(X[:60], y[:60, None], is_ordered=np.zeros(20, dtype=bool), rng=rng)
    correlation = np.corrcoef(posterior.predict(X[60:]).mean[:, 0], y[60:])[0, 1]
    assert correlation > 0.7


def test_the_fit_finds_the_axis_that_does_not_matter_and_the_noise() -> None:
    h = fit_hyperparameters(example(60), [HyperPrior(3).mode()])
    assert h.lengthscales[1] > 3 * h.lengthscales[0]
    assert 0.005 < h.noise_variance < 0.1  # 0.01 over a variance of about 0.6


def test_a_second_start_never_makes_the_fit_worse() -> None:
    likelihood = example()
    one = fit_hyperparameters(likelihood, [HyperPrior(3).mode()])
    odd = Hyperparameters(np.full(3, 50.0), 0.02, 3.0)
    two = fit_hyperparameters(likelihood, [odd, HyperPrior(3).mode()])
    assert likelihood(two.to_log())[0] <= likelihood(one.to_log())[0] + 1e-9


def test_data_that_cannot_be_fitted_leave_the_mode_of_the_prior(caplog: pytest.LogCaptureFixture) -> None:
    broken = MarginalLikelihood(np.full((3, 1), np.nan), np.zeros(3), np.array([True]), HyperPrior(1))
    h = fit_hyperparameters(broken, [HyperPrior(1).mode()])
    assert h.lengthscales == pytest.approx(HyperPrior(1).mode().lengthscales)
    assert "could not be fitted" in caplog.text


def known(n: int = 25) -> MarginalLikelihood:
    """Return the example with noise that is known but for a factor."""
    plain, noise = example(n), np.random.default_rng(1).uniform(0.01, 0.5, n)
    prior = HyperPrior(3).of_known_noise()
    return MarginalLikelihood(plain.X, plain.y, plain.is_ordered, prior, known_noise=noise)


def test_gradient_with_known_noise_agrees_with_finite_differences() -> None:
    likelihood = known()
    for seed in range(3):
        theta = likelihood.prior.mode().to_log() + 0.5 * np.random.default_rng(seed).standard_normal(5)
        numeric = approx_fprime(theta, lambda t: likelihood(t)[0], 1e-7)
        assert likelihood(theta)[1] == pytest.approx(numeric, rel=1e-4, abs=1e-4)


def test_value_with_known_noise_is_scikit_learns() -> None:
    likelihood, h = known(), Hyperparameters(np.array([0.4, 0.9, 2.0]), 1.7, 1.2)
    kernel = ConstantKernel(1.7) * Matern(h.lengthscales, nu=2.5)
    noise = 1.2 * likelihood.known_noise
    mean = constant_mean(np.linalg.inv(kernel(likelihood.X) + np.diag(noise)), likelihood.y)
    oracle = GaussianProcessRegressor(kernel, alpha=noise, optimizer=None).fit(likelihood.X, likelihood.y - mean)
    penalty = likelihood.prior.penalty(h.to_log())[0]
    assert likelihood(h.to_log())[0] == pytest.approx(-oracle.log_marginal_likelihood_value_ + penalty, rel=1e-9)


def test_known_noise_is_believed_unless_the_data_contradict_it() -> None:
    prior = HyperPrior(3).of_known_noise()
    assert prior.mode().noise_variance == pytest.approx(1.0)
    low, high = np.exp(prior.bounds()[-1])
    found = fit_hyperparameters(known(), [prior.mode()])
    assert low < found.noise_variance < high
    equal_noise = MarginalLikelihood(known().X, example().y, np.ones(3, bool), HyperPrior(3), known_noise=np.ones(25))
    assert equal_noise(prior.mode().to_log())[0] == pytest.approx(example()(prior.mode().to_log())[0], rel=1e-12)
