"""piBO."""

import numpy as np
import pytest

from hypermap_lite.acquisition import Pibo, PriorWeighted
from hypermap_lite.acquisition.improvement import LinearImprovement
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import AsJoint, BetaPrior, GaussianPrior, ProductPrior, UniformPrior, WeightsPrior
from hypermap_lite.space import CategoricalParameter, RealParameter
from tests.acquisition.toy_field import toy_field

X = np.random.default_rng(0).random((6, 2))


def prior(scale: float = 1.0) -> ProductPrior:
    axis = RealParameter(name="x", low=0, high=scale)
    return ProductPrior(2, (((0,), AsJoint(GaussianPrior(mean=0.3 * scale, std=0.1 * scale).on(axis))),))


def inner() -> LinearImprovement:
    return LinearImprovement(
        field=toy_field(4),
        incumbents=np.zeros((4, 2)),
        weights=np.array([0.5, 0.5]),
        scale=np.ones(2),
        is_differentiable=True,
    )


def test_without_floor_it_is_the_acquisition_times_the_density_to_the_power_beta_over_n() -> None:
    weight = Pibo(beta=5.0).weight(n=2, model_budget=100)
    scorer = PriorWeighted(inner=inner(), prior=prior(), weight=weight, floor=0.0)
    relative = np.exp(prior().log_density(X) - prior().log_peak())
    assert np.exp(scorer(X)) == pytest.approx(np.exp(inner()(X)) * relative**2.5)


def test_the_floor_is_relative_to_the_peak() -> None:
    scorer = PriorWeighted(inner=inner(), prior=prior(), weight=1.0, floor=0.05)
    far, peak = np.array([[1.0, 0.5]]), np.array([[0.3, 0.5]])
    assert scorer.log_relative_density(far)[0] == pytest.approx(np.log(0.05), abs=1e-6)
    assert scorer.log_relative_density(peak)[0] == pytest.approx(0.0)


def test_units_play_no_part() -> None:
    metres = PriorWeighted(inner=inner(), prior=prior(), weight=1.0, floor=0.05)
    millimetres = PriorWeighted(inner=inner(), prior=prior(1000.0), weight=1.0, floor=0.05)
    assert metres(X) == pytest.approx(millimetres(X))


def test_gradient_agrees_with_finite_differences() -> None:
    scorer = PriorWeighted(inner=inner(), prior=prior(), weight=2.0, floor=0.05)
    score, gradient = scorer.with_gradient(X)
    assert score == pytest.approx(scorer(X))
    for j, e in enumerate(1e-6 * np.eye(2)):
        assert gradient[:, j] == pytest.approx((scorer(X + e) - scorer(X - e)) / 2e-6, rel=1e-4, abs=1e-5)


def test_an_unbounded_density_counts_no_more_than_its_peak() -> None:
    axis = RealParameter(name="x", low=0, high=1)
    decay = ProductPrior(2, (((0,), AsJoint(BetaPrior(shape="decay").on(axis))),))
    scorer = PriorWeighted(inner=inner(), prior=decay, weight=4.8, floor=0.05)
    at_bound, near = scorer.log_relative_density(np.array([[0.0, 0.5], [0.005, 0.5]]))
    assert (at_bound, near) == pytest.approx((0.0, 0.0))


def decaying() -> ProductPrior:
    return ProductPrior(2, (((0,), AsJoint(BetaPrior(shape="decay").on(RealParameter(name="x", low=0, high=1)))),))


def test_in_full_an_unbounded_density_draws_to_its_bound() -> None:
    scorer = PriorWeighted(inner=inner(), prior=decaying(), weight=1.0, floor=1e-6, unbounded=True)
    edge, peak = scorer.log_relative_density(np.array([[0.0, 0.5], [0.01, 0.5]]))
    assert peak == pytest.approx(0.0, abs=1e-5)
    assert edge == pytest.approx(0.2 * np.log(0.01 / 1e-9), rel=1e-6)  # evaluated 1e-9 from the bound


@pytest.mark.parametrize("unbounded", [False, True])
def test_gradient_of_an_unbounded_density_agrees_with_finite_differences_around_its_peak(unbounded: bool) -> None:
    scorer = PriorWeighted(inner=inner(), prior=decaying(), weight=1.0, floor=0.05, unbounded=unbounded)
    points = np.array([[0.003, 0.4], [0.2, 0.4]])
    _, gradient = scorer.with_gradient(points)
    e = np.array([1e-7, 0.0])
    assert gradient[:, 0] == pytest.approx((scorer(points + e) - scorer(points - e)) / 2e-7, rel=1e-3, abs=1e-6)


def test_without_floor_gradients_are_finite_where_the_prior_forbids() -> None:
    axis = CategoricalParameter(name="c", values=("a", "b"))
    forbids = ProductPrior(2, (((0,), AsJoint(WeightsPrior(weights=[0, 1]).on(axis))),))
    scorer = PriorWeighted(inner=inner(), prior=forbids, weight=1.0, floor=0.0)
    score, gradient = scorer.with_gradient(np.array([[0.25, 0.5], [0.75, 0.5]]))
    assert score[0] == -np.inf
    assert np.isfinite(gradient).all()


@pytest.mark.parametrize("floor", [0.0, 0.05])
def test_outside_the_range_of_a_uniform_prior_there_is_only_the_floor(floor: float) -> None:
    axis = RealParameter(name="x", low=0, high=1)
    ranged = ProductPrior(2, (((0,), AsJoint(UniformPrior(low=0.2, high=0.6).on(axis))),))
    scorer = PriorWeighted(inner=inner(), prior=ranged, weight=2.0, floor=floor)
    outside, inside = np.array([[0.1, 0.5]]), np.array([[0.4, 0.5]])
    with np.errstate(divide="ignore"):
        assert scorer.log_relative_density(outside)[0] == pytest.approx(np.log(floor))
    assert scorer.log_relative_density(inside)[0] == pytest.approx(0.0)
    for x in (outside, inside):
        score, gradient = scorer.with_gradient(x)
        assert score == pytest.approx(scorer(x))
        assert gradient == pytest.approx(inner().with_gradient(x)[1])


def test_the_default_strength_is_a_tenth_of_the_model_based_budget() -> None:
    assert Pibo().weight(n=1, model_budget=48) == pytest.approx(4.8)
    assert Pibo().weight(n=48, model_budget=48) == pytest.approx(0.1)


@pytest.mark.parametrize("options", [{"beta": -1}, {"floor": 1.0}, {"floor": -0.1}])
def test_impossible_options_are_refused(options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        Pibo(**options)
