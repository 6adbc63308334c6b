"""The whole belief."""

import numpy as np
import pytest

from hypermap_lite.priors import AsJoint, BetaPrior, GaussianPrior, JointMixturePrior, ProductPrior, WeightsPrior
from hypermap_lite.space import CategoricalParameter, RealParameter

A, B = RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=2)
C = CategoricalParameter(name="c", values=("x", "y"))
MIXTURE = JointMixturePrior(components=[{"mean": {"b": 0.4, "a": 0.1}, "std": {"b": 0.2, "a": 0.1}}])
PRIOR = ProductPrior(
    4,
    (((1, 0), MIXTURE.on([B, A])), ((3,), AsJoint(WeightsPrior(weights=[1, 3]).on(C)))),
)


def test_log_density_is_the_sum_over_the_factors() -> None:
    X = np.random.default_rng(0).random((5, 4))
    alone = GaussianPrior(mean=0.1, std=0.1).on(A).log_density(X[:, 0])
    alone = alone + GaussianPrior(mean=0.4, std=0.2).on(B).log_density(X[:, 1])
    alone = alone + WeightsPrior(weights=[1, 3]).on(C).log_density(X[:, 3])
    assert PRIOR.log_density(X) == pytest.approx(alone)


def test_axes_without_prior_are_uniform() -> None:
    X = PRIOR.sample(5000, np.random.default_rng(0))
    assert np.histogram(X[:, 2], bins=4)[0] == pytest.approx(np.full(4, 1250), abs=120)
    assert np.mean(X[:, 3] > 0.5) == pytest.approx(0.75, abs=0.03)


def test_the_product_integrates_to_one() -> None:
    X = np.random.default_rng(0).random((400_000, 4))
    assert np.exp(PRIOR.log_density(X)).mean() == pytest.approx(1.0, abs=0.02)


def test_the_peak_is_at_the_factors_modes() -> None:
    assert PRIOR.mode() == pytest.approx([0.1, 0.2, 0.5, 0.75])
    assert PRIOR.log_peak() >= PRIOR.log_density(PRIOR.sample(1000, np.random.default_rng(0))).max()


def test_the_supremum_is_the_peak_unless_a_density_is_unbounded() -> None:
    assert PRIOR.log_supremum() == PRIOR.log_peak()
    decay = AsJoint(BetaPrior(shape="decay").on(RealParameter(name="x", low=0, high=1)))
    unbounded = ProductPrior(1, (((0,), decay),))
    assert unbounded.log_supremum() == unbounded.log_density(np.zeros((1, 1)))[0] > unbounded.log_peak()


def test_no_factor_means_no_preference() -> None:
    empty = ProductPrior(2)
    assert empty.is_uniform
    assert not PRIOR.is_uniform
    assert np.array_equal(empty.log_density(np.zeros((3, 2))), np.zeros(3))


def test_log_gradient_agrees_with_finite_differences_along_real_axes() -> None:
    X = PRIOR.sample(5, np.random.default_rng(0))
    gradient = PRIOR.log_gradient(X)
    for j, e in enumerate(1e-5 * np.eye(4)[:2]):
        numeric = (PRIOR.log_density(X + e) - PRIOR.log_density(X - e)) / 2e-5
        assert gradient[:, j] == pytest.approx(numeric, rel=1e-4, abs=1e-4)
    assert not gradient[:, 2:].any()
