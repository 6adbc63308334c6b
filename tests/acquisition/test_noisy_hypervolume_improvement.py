"""Noisy expected hypervolume improvement: what becomes of the front."""

from dataclasses import replace

import numpy as np
import pytest

from hypermap_lite.acquisition import AcquisitionContext, NoisyExpectedHypervolumeImprovement
from hypermap_lite.acquisition.hypervolume_improvement import HypervolumeImprovement
from hypermap_lite.pareto.hypervolume import hypervolume, infer_reference_point
from hypermap_lite.scalarization import Normalization, Tchebyshev
from hypermap_lite.surrogates import GaussianProcess
from hypermap_lite.typing import FloatArray

RNG = np.random.default_rng(0)
X = RNG.random((20, 2))


def objectives(X: FloatArray, m: int = 2) -> FloatArray:
    """Squared distances from m corners."""
    corners = np.array([[0.1, 0.1], [0.9, 0.2], [0.5, 0.9], [0.2, 0.7], [0.6, 0.5]])[:m]
    return ((X[:, None] - corners) ** 2).sum(axis=2)


def context(Y: FloatArray, *, noise: bool = False, reference_point: FloatArray | None = None) -> AcquisitionContext:
    posterior = GaussianProcess(noise=noise).fit(X, Y, is_ordered=np.ones(2, bool), rng=np.random.default_rng(0))
    return AcquisitionContext(
        posterior=posterior,
        X=X,
        Y=Y,
        X_pending=np.empty((0, 2)),
        scalarization=Tchebyshev(),
        weights=np.full(Y.shape[1], 1 / Y.shape[1]),
        normalization=Normalization.of_front(Y),
        rng=np.random.default_rng(1),
        reference_point=reference_point,
    )


@pytest.mark.parametrize("m", [2, 3])
def test_without_noise_it_is_the_growth_of_the_observed_hypervolume(m: int) -> None:
    Y, corner = objectives(X, m), np.ones(m)
    base = context(Y, reference_point=corner)
    Z = np.random.default_rng(2).random((40, 2))
    truth = [hypervolume(np.vstack([Y, y]), corner) - hypervolume(Y, corner) for y in objectives(Z, m)]
    scores = NoisyExpectedHypervolumeImprovement().scorer(base)(Z)
    assert np.exp(scores) * np.prod(base.normalization.scale) == pytest.approx(truth, abs=0.1 * max(truth))


def test_known_values_have_one_front_and_uncertain_ones_many() -> None:
    Y = objectives(X)
    exact = NoisyExpectedHypervolumeImprovement(samples=16).scorer(context(Y))
    noisy = Y + 0.2 * np.random.default_rng(3).standard_normal(Y.shape)
    drawn = NoisyExpectedHypervolumeImprovement(samples=16).scorer(context(noisy, noise=True))
    assert isinstance(exact, HypervolumeImprovement)
    assert isinstance(drawn, HypervolumeImprovement)
    assert len(exact.boxes) == 1
    assert len(drawn.boxes) == 16


@pytest.mark.parametrize("noise", [False, True])
def test_what_is_beside_the_evaluations_is_on_the_front(noise: bool) -> None:
    """Half of the evaluations are told as values alone, to a model that knows all of them."""
    base = context(objectives(X), noise=noise, reference_point=np.ones(2))
    Z = np.random.default_rng(4).random((30, 2))
    function = NoisyExpectedHypervolumeImprovement()
    whole = function.scorer(base)(Z)
    half = function.scorer(replace(base, X=X[:10], Y=base.Y[:10]))(Z)
    told = function.scorer(replace(base, X=X[:10], Y=base.Y[:10], beside=base.posterior.predict(X[10:]).mean))(Z)
    likely = whole > whole.max() - 5
    assert told[likely] == pytest.approx(whole[likely], abs=0.1)
    if not noise:  # its draws are of all points that it knows
        assert (half[likely] > whole[likely] + 0.1).any()


def test_drawn_fronts_agree_with_the_known_one() -> None:
    base = context(objectives(X))
    Z = np.random.default_rng(4).random((30, 2))
    known = NoisyExpectedHypervolumeImprovement().scorer(base)(Z)
    far_away = replace(base, X_pending=np.array([[0.999, 0.999]]))  # worth nothing, but it asks for drawn fronts
    drawn = NoisyExpectedHypervolumeImprovement().scorer(far_away)(Z)
    likely = known > known.max() - 5
    assert drawn[likely] == pytest.approx(known[likely], abs=0.1)


def test_a_reference_point_is_inferred_where_there_is_none() -> None:
    base = context(objectives(X))
    corner = infer_reference_point(base.posterior.predict(X).mean)
    Z = np.random.default_rng(5).random((10, 2))
    inferred = NoisyExpectedHypervolumeImprovement().scorer(base)(Z)
    given = NoisyExpectedHypervolumeImprovement().scorer(replace(base, reference_point=corner))(Z)
    assert np.array_equal(inferred, given)


def test_a_reference_point_that_nothing_dominates_yet_draws_the_search_to_it() -> None:
    Y = objectives(X)
    corner = np.array([0.05, 0.4])  # near the first corner
    assert not (corner > Y).all(axis=1).any()
    scorer = NoisyExpectedHypervolumeImprovement().scorer(context(Y, reference_point=corner))
    Z = np.random.default_rng(6).random((500, 2))
    scores = scorer(Z)
    assert np.isfinite(scores).all()
    assert (objectives(Z)[np.argmax(scores)] < corner + 0.05).all()


def test_units_do_not_matter() -> None:
    Y, Z = objectives(X), np.random.default_rng(7).random((20, 2))
    factors = np.array([1e-6, 1e9])
    plain = NoisyExpectedHypervolumeImprovement().scorer(context(Y))(Z)
    scaled = NoisyExpectedHypervolumeImprovement().scorer(context(Y * factors))(Z)
    assert scaled == pytest.approx(plain, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize("m", [1, 4, 5])
def test_other_numbers_of_objectives_have_scores_with_gradients_too(m: int) -> None:
    scorer = NoisyExpectedHypervolumeImprovement().scorer(context(objectives(X, m)))
    Z = np.random.default_rng(8).random((6, 2))
    score, gradient = scorer.with_gradient(Z)
    assert np.isfinite(score).all()
    for j, e in enumerate(1e-6 * np.eye(2)):
        numeric = (scorer(Z + e) - scorer(Z - e)) / 2e-6
        assert gradient[:, j] == pytest.approx(numeric, rel=2e-2, abs=1e-3 * max(1.0, np.abs(gradient).max()))
