"""BOPrO."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from hypermap_lite.acquisition import AcquisitionContext, Bopro, ExpectedImprovement
from hypermap_lite.acquisition.bopro import BoproScorer, LogOddsBelow, SampledLogOddsBelow
from hypermap_lite.errors import ScenarioError
from hypermap_lite.priors import AsJoint, BetaPrior, GaussianPrior, ProductPrior, WeightsPrior
from hypermap_lite.scalarization import SCALARIZATIONS, Normalization, Tchebyshev
from hypermap_lite.space import CategoricalParameter, RealParameter
from hypermap_lite.surrogates import SURROGATES
from hypermap_lite.surrogates.base import Conditional
from tests.acquisition.toy_field import toy_field

RNG = np.random.default_rng(0)
X = RNG.random((12, 2))
Y = np.column_stack([((X - 0.3) ** 2).sum(axis=1), ((X - 0.7) ** 2).sum(axis=1)])
Z = RNG.random((6, 2))
AXIS = RealParameter(name="x", low=0, high=1)
GAUSSIAN = ProductPrior(2, (((0,), AsJoint(GaussianPrior(mean=0.3, std=0.2).on(AXIS))),))


def context(surrogate: str, *, Y: np.ndarray = Y, scalarization: str = "tchebyshev") -> AcquisitionContext:
    return AcquisitionContext(
        posterior=SURROGATES[surrogate]().fit(X, Y, is_ordered=np.ones(2, bool), rng=np.random.default_rng(0)),
        X=X,
        Y=Y,
        X_pending=np.empty((0, 2)),
        scalarization=SCALARIZATIONS[scalarization](),
        weights=np.full(Y.shape[1], 1 / Y.shape[1]),
        normalization=Normalization.of_front(Y),
        rng=np.random.default_rng(1),
    )


def scorer(ctx: AcquisitionContext, *, weight: float = 1.0, prior: ProductPrior = GAUSSIAN) -> BoproScorer:
    return Bopro().scorer(ExpectedImprovement(), ctx, prior, weight)


def test_the_score_is_the_sum_of_both_log_odds_weighted_by_t_over_b() -> None:
    weight = Bopro(model_weight=10.0).weight(n=4, model_budget=100)
    assert weight == pytest.approx(2.5)
    ctx = context("gaussian_process", Y=Y[:, :1])
    d = np.exp(GAUSSIAN.log_density(Z) - GAUSSIAN.log_peak())
    by_prior = np.log(0.01 + 0.99 * d) - np.log(0.01 + 0.99 * (1 - d))
    c = ctx.posterior.predict(Z)
    resolution = 0.01 * np.ptp(Y[:, 0])
    z = (np.quantile(Y[:, 0], 0.05, method="inverted_cdf") - c.mean[:, 0]) / np.hypot(c.std[:, 0], resolution)
    by_model = norm.logcdf(z) - norm.logcdf(-z)
    assert scorer(ctx, weight=weight)(Z) == pytest.approx(by_prior + 0.4 * by_model, rel=1e-6)


def test_both_opinions_count_equally_where_the_suggestions_reach_the_weight_of_the_model() -> None:
    assert Bopro(model_weight=7.0).weight(n=7, model_budget=100) == 1.0


def test_the_prior_alone_is_symmetric_and_bounded_by_the_floor() -> None:
    at = scorer(context("gaussian_process"))
    peak, far = at.log_odds_of_prior(np.array([[0.3, 0.5], [30.0, 0.5]]))
    assert peak == pytest.approx(np.log(1 / 0.01))
    assert far == pytest.approx(np.log(0.01))


def test_an_unbounded_density_counts_no_more_than_its_peak() -> None:
    decay = ProductPrior(2, (((0,), AsJoint(BetaPrior(shape="decay").on(AXIS))),))
    scores = scorer(context("gaussian_process"), prior=decay).log_odds_of_prior(np.array([[0.0, 0.5], [0.005, 0.5]]))
    assert scores == pytest.approx(np.full(2, np.log(1 / 0.01)))


def test_the_probability_of_several_objectives_is_that_of_joint_samples() -> None:
    good = SampledLogOddsBelow(
        field=toy_field(1),
        threshold=0.6,
        normal=RNG.standard_normal((20_000, 2)),
        scalarization=Tchebyshev(),
        weights=np.array([0.6, 0.4]),
        normalization=Normalization(offset=np.zeros(2), scale=np.ones(2)),
        is_differentiable=True,
    )
    c = good.field(Z)
    samples = c.mean + c.std * good.normal[:, None, :]
    share = (Tchebyshev()(samples, good.weights) < 0.6).mean(axis=0)
    assert good(Z) == pytest.approx(np.log(share) - np.log(1 - share), abs=0.05)


@pytest.mark.parametrize("scalarization", list(SCALARIZATIONS))
@pytest.mark.parametrize("n_objectives", [1, 2])
def test_gradients_agree_with_finite_differences(n_objectives: int, scalarization: str) -> None:
    at = scorer(context("gaussian_process", Y=Y[:, :n_objectives], scalarization=scalarization))
    assert at.is_differentiable
    score, gradient = at.with_gradient(Z)
    assert score == pytest.approx(at(Z))
    for j, e in enumerate(1e-6 * np.eye(2)):
        numeric = (at(Z + e) - at(Z - e)) / 2e-6
        assert gradient[:, j] == pytest.approx(numeric, rel=2e-2, abs=1e-3 * max(1.0, np.abs(gradient).max()))


@pytest.mark.parametrize("n_objectives", [1, 2])
def test_a_pending_point_is_less_worth_trying_again(n_objectives: int) -> None:
    free = context("gaussian_process", Y=Y[:, :n_objectives])
    many = RNG.random((500, 2))
    candidate = many[[np.argmax(scorer(free)(many))]]
    around = np.clip(candidate + 1e-3, 0, 1)
    taken = scorer(replace(free, X_pending=candidate, rng=np.random.default_rng(1)))
    assert taken(around)[0] < scorer(replace(free, rng=np.random.default_rng(1)))(around)[0]


@pytest.mark.parametrize("n_objectives", [1, 2])
def test_a_forest_is_scored_without_gradient(n_objectives: int) -> None:
    at = scorer(context("random_forest", Y=Y[:, :n_objectives]))
    assert not at.is_differentiable
    assert np.isfinite(at(Z)).all()


def test_categories_have_their_odds_and_a_forbidden_one_keeps_the_floor() -> None:
    axis = CategoricalParameter(name="c", values=("a", "b", "c"))
    weights = ProductPrior(2, (((0,), AsJoint(WeightsPrior(weights=[0, 1, 2]).on(axis))),))
    at = scorer(context("gaussian_process"), prior=weights)
    levels = np.array([[1 / 6, 0.5], [0.5, 0.5], [5 / 6, 0.5]])
    assert np.exp(at.log_odds_of_prior(levels)) == pytest.approx([0.01, 0.505 / 0.505, 100.0])
    assert np.isfinite(at.with_gradient(levels)[1]).all()


@pytest.mark.parametrize("mean", [-1e9, 1e9])
def test_a_sure_model_gives_finite_scores_and_gradients(mean: float) -> None:
    def field(at: np.ndarray) -> Conditional:
        shape = (1, len(at), 1)
        return Conditional(
            mean=np.full(shape, mean), std=np.full(shape, 1e-3), pullback=lambda by_mean, by_std: by_mean[0]
        )

    odds = LogOddsBelow(field=field, threshold=0.0, resolution=0.0, is_differentiable=True)
    score, gradient = odds.with_gradient(np.zeros((2, 1)))
    assert np.isfinite(score).all()
    assert np.isfinite(gradient).all()


@pytest.mark.parametrize(
    "options", [{"model_weight": 0}, {"good_quantile": 0}, {"good_quantile": 1}, {"floor": 0}, {"floor": 0.5}]
)
def test_impossible_options_are_refused(options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        Bopro(**options)
