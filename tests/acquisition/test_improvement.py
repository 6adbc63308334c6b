"""Expected improvement in log form."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from hypermap_lite.acquisition.improvement import (
    LinearImprovement,
    SampledImprovement,
    log_h,
    log_h_slope,
    log_softplus,
)
from hypermap_lite.scalarization import Normalization, Tchebyshev
from hypermap_lite.surrogates.base import Conditional
from tests.acquisition.toy_field import toy_field

RNG = np.random.default_rng(0)
X = RNG.random((5, 2))


EXACT_LOG_H = {  # computed with 80 to 400 digits
    8.0: 2.0794415416798357,
    1.0: 0.08002621884930694,
    0.0: -0.9189385332046728,
    -0.5: -1.6205162643873199,
    -0.999: -2.4832171154475855,
    -1.0: -2.4851210257126413,
    -1.001: -2.4870256579553893,
    -5.0: -16.74430116266099,
    -25.0: -319.86146358149597,
    -40.0: -808.29856835662,
    -300.0: -45012.32653681455,
    -1e4: -50000019.33961931,
}


@pytest.mark.parametrize(("z", "expected"), EXACT_LOG_H.items())
def test_log_h_is_exact_in_both_tails(z: float, expected: float) -> None:
    assert log_h(np.array(z)) == pytest.approx(expected, rel=1e-9)


def test_log_h_is_finite_and_falls_smoothly_beyond_every_switch() -> None:
    z = -np.logspace(-2, 8, 2001)
    values = log_h(z)
    assert np.isfinite(values).all()
    assert np.all(np.diff(values) < 0)


@pytest.mark.parametrize("z", [3.0, 0.0, -0.9, -1.1, -10.0, -40.0, -1e3])
def test_slope_agrees_with_finite_differences(z: float) -> None:
    step = 1e-6 * max(1.0, abs(z))
    numeric = (log_h(np.array(z + step)) - log_h(np.array(z - step))) / (2 * step)
    assert log_h_slope(np.array(z)) == pytest.approx(numeric, rel=1e-4)


@pytest.mark.parametrize("z", [-1e4, -9e4, -1.1e5, -1e8, -1e12])
def test_slope_far_below_tends_to_the_distance(z: float) -> None:
    assert log_h_slope(np.array(z)) == pytest.approx(-z, rel=1e-5)


def test_log_softplus_has_its_limits() -> None:
    assert log_softplus(np.array([-1e4, -31.0, 0.0, 50.0])) == pytest.approx(
        [-1e4, -31.0, math.log(math.log(2)), math.log(50.0)]
    )


def test_one_objective_and_scenario_is_textbook_expected_improvement() -> None:
    mean, std, best = np.array([0.3, -1.0, 2.0]), np.array([0.5, 0.1, 1.0]), 0.2
    score = LinearImprovement(
        field=lambda X: Conditional(mean=mean[None, :, None], std=std[None, :, None]),
        incumbents=np.array([[best]]),
        weights=np.ones(1),
        scale=np.ones(1),
        is_differentiable=False,
    )
    z = (best - mean) / std
    textbook = (best - mean) * norm.cdf(z) + std * norm.pdf(z)
    assert np.exp(score(np.zeros((3, 1)))) == pytest.approx(textbook)


def linear(scenarios: int, weights: list[float]) -> LinearImprovement:
    return LinearImprovement(
        field=toy_field(scenarios),
        incumbents=RNG.standard_normal((scenarios, 2)),
        weights=np.array(weights),
        scale=np.array([1.0, 10.0]),
        is_differentiable=True,
    )


def sampled(scenarios: int, normal: int) -> SampledImprovement:
    return SampledImprovement(
        field=toy_field(scenarios),
        incumbents=np.full(max(scenarios, 1), 0.4) if scenarios > 1 else np.array([0.4]),
        normal=RNG.standard_normal((normal, 2)),
        scalarization=Tchebyshev(),
        weights=np.array([0.6, 0.4]),
        normalization=Normalization(offset=np.zeros(2), scale=np.array([1.0, 2.0])),
        is_differentiable=True,
    )


def test_linear_improvement_sums_objectives_and_averages_scenarios() -> None:
    scorer = linear(4, [0.7, 0.3])
    c = scorer.field(X)
    z = (scorer.incumbents[:, None, :] - c.mean) / c.std
    improvement = c.std * (norm.pdf(z) + z * norm.cdf(z)) * np.array([0.7, 0.3]) / scorer.scale
    assert np.exp(scorer(X)) == pytest.approx(improvement.sum(axis=2).mean(axis=0))


def test_a_weight_of_zero_leaves_the_other_objective() -> None:
    scorer = linear(4, [1.0, 0.0])
    score, gradient = scorer.with_gradient(X)
    assert np.isfinite(score).all()
    assert np.isfinite(gradient).all()


def test_sampled_improvement_is_close_to_the_mean_improvement_of_many_samples() -> None:
    scorer = sampled(1, 20_000)
    c = scorer.field(X)
    samples = scorer.normalization(c.mean + c.std * scorer.normal[:, None, :])
    improvement = np.maximum(0.4 - scorer.scalarization(samples, scorer.weights), 0).mean(axis=0)
    assert np.exp(scorer(X)) == pytest.approx(improvement, abs=0.005)


@pytest.mark.parametrize(
    "scorer",
    [
        pytest.param(linear(1, [0.7, 0.3]), id="linear-one-scenario"),
        pytest.param(linear(8, [0.7, 0.3]), id="linear-many-scenarios"),
        pytest.param(sampled(1, 16), id="sampled-one-scenario"),
        pytest.param(sampled(16, 16), id="sampled-many-scenarios"),
    ],
)
def test_gradients_agree_with_finite_differences(scorer: LinearImprovement | SampledImprovement) -> None:
    score, gradient = scorer.with_gradient(X)
    assert score == pytest.approx(scorer(X))
    for j, e in enumerate(1e-6 * np.eye(2)):
        assert gradient[:, j] == pytest.approx((scorer(X + e) - scorer(X - e)) / 2e-6, rel=1e-4, abs=1e-6)
