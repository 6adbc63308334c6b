"""Tests for beliefs.py."""

import math

import numpy as np
import pytest

from hypermap_lite.priors import AsJoint, ProductPrior
from hypermap_lite.priors.beliefs import Belief, InTurn, completed, together
from hypermap_lite.priors.quantiles import quantiles
from hypermap_lite.priors.truncated_gaussian import TruncatedNormal
from hypermap_lite.priors.uniform import UniformDensity


def on(axis: int, location: float, scale: float = 0.01) -> ProductPrior:
    return ProductPrior(2, (((axis,), AsJoint(TruncatedNormal(location, scale))),))


def halves() -> InTurn:
    return InTurn((AsJoint(UniformDensity(0.0, 0.5)), AsJoint(UniformDensity(0.5, 1.0))))


def test_draws_take_the_densities_in_turn() -> None:
    X = halves().sample(5, np.random.default_rng(0))
    assert (X[:, 0] > 0.5).tolist() == [False, True, False, True, False]


@pytest.mark.parametrize("n", [0, 1])
def test_there_may_be_fewer_draws_than_densities(n: int) -> None:
    assert halves().sample(n, np.random.default_rng(0)).shape == (n, 1)


def test_the_density_is_the_mean_of_the_densities() -> None:
    flat = InTurn((AsJoint(UniformDensity(0.0, 0.5)), AsJoint(UniformDensity())))
    assert np.exp(flat.log_density(np.array([[0.2], [0.8]]))) == pytest.approx([1.5, 0.5])


def test_the_gradient_is_that_of_the_density_and_zero_where_there_is_none() -> None:
    mixed = InTurn((AsJoint(TruncatedNormal(0.3, 0.2)), AsJoint(TruncatedNormal(0.7, 0.1))))
    u, h = np.array([[0.1], [0.45], [0.6]]), 1e-6
    slope = (mixed.log_density(u + h) - mixed.log_density(u - h)) / (2 * h)
    assert mixed.log_gradient(u)[:, 0] == pytest.approx(slope, rel=1e-5)
    nowhere = InTurn((AsJoint(UniformDensity(0.0, 0.2)), AsJoint(UniformDensity(0.1, 0.3))))
    assert nowhere.log_density(np.array([[0.9]]))[0] == -math.inf
    assert nowhere.log_gradient(np.array([[0.9]]))[0, 0] == 0.0


def test_the_mode_is_that_of_the_densest() -> None:
    mixed = InTurn((AsJoint(TruncatedNormal(0.3, 0.2)), AsJoint(TruncatedNormal(0.7, 0.1))))
    assert mixed.mode() == pytest.approx([0.7])


def test_one_belief_stays_what_it_is() -> None:
    prior = on(0, 0.3)
    assert together([Belief(prior=prior)]) is prior


def test_several_beliefs_are_one_mixture_whose_marginals_are_mixtures() -> None:
    prior = together([Belief(prior=on(0, 0.2), name="a"), Belief(prior=on(0, 0.8), name="b")])
    X = prior.sample(4, np.random.default_rng(0))
    assert X[:, 0] == pytest.approx([0.2, 0.8, 0.2, 0.8], abs=0.05)
    assert quantiles(prior, 0, np.array([0.25, 0.75])) == pytest.approx([0.2, 0.8], abs=0.01)
    assert np.exp(prior.marginal([1]).log_density(np.array([[0.4]]))) == pytest.approx([1.0])


def test_a_prior_is_completed_where_it_says_nothing() -> None:
    whole = completed(on(0, 0.2), on(1, 0.9))
    assert whole.mode() == pytest.approx([0.2, 0.9])


def test_a_prior_is_not_changed_where_it_speaks() -> None:
    whole = completed(on(0, 0.2), on(0, 0.9))
    assert whole.mode()[0] == pytest.approx(0.2)
    assert len(whole.factors) == 1


def test_of_a_joint_prior_the_marginal_on_the_other_axes_is_kept() -> None:
    joint = ProductPrior(2, (((1, 0), ProductPrior(2, (((0,), AsJoint(TruncatedNormal(0.9, 0.01))),))),))
    whole = completed(on(0, 0.2), joint)
    assert whole.mode() == pytest.approx([0.2, 0.9])
