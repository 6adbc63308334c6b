"""What holds for every acquisition function, with either surrogate and either scalarization."""

from dataclasses import replace

import numpy as np
import pytest

from hypermap_lite.acquisition import (
    ACQUISITIONS,
    AcquisitionContext,
    ExpectedImprovement,
    NoisyExpectedImprovement,
    UpperConfidenceBound,
)
from hypermap_lite.errors import ScenarioError
from hypermap_lite.scalarization import SCALARIZATIONS, Normalization
from hypermap_lite.surrogates import SURROGATES, GaussianProcess

RNG = np.random.default_rng(0)
X = RNG.random((15, 2))
Y = np.column_stack([((X - 0.3) ** 2).sum(axis=1), ((X - 0.7) ** 2).sum(axis=1)])
Z = RNG.random((9, 2))


def context(
    surrogate: str = "gaussian_process",
    scalarization: str = "tchebyshev",
    *,
    Y: np.ndarray = Y,
    pending: np.ndarray | None = None,
) -> AcquisitionContext:
    posterior = SURROGATES[surrogate]().fit(X, Y, is_ordered=np.ones(2, bool), rng=np.random.default_rng(0))
    return AcquisitionContext(
        posterior=posterior,
        X=X,
        Y=Y,
        X_pending=np.empty((0, 2)) if pending is None else pending,
        scalarization=SCALARIZATIONS[scalarization](),
        weights=np.full(Y.shape[1], 1 / Y.shape[1]),
        normalization=Normalization.of_front(Y),
        rng=np.random.default_rng(1),
    )


every_combination = pytest.mark.parametrize(
    ("name", "surrogate", "scalarization"),
    [(a, s, c) for a in ACQUISITIONS for s in SURROGATES for c in SCALARIZATIONS],
)


@every_combination
def test_scores_are_finite_and_repeatable(name: str, surrogate: str, scalarization: str) -> None:
    first = ACQUISITIONS[name]().scorer(context(surrogate, scalarization))(Z)
    again = ACQUISITIONS[name]().scorer(context(surrogate, scalarization))(Z)
    assert first.shape == (9,)
    assert np.isfinite(first).all()
    assert np.array_equal(first, again)


@every_combination
def test_scores_do_not_depend_on_the_other_points(name: str, surrogate: str, scalarization: str) -> None:
    scorer = ACQUISITIONS[name]().scorer(context(surrogate, scalarization))
    assert scorer(Z)[3:4] == pytest.approx(scorer(Z[3:4]), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("name", list(ACQUISITIONS))
@pytest.mark.parametrize("scalarization", list(SCALARIZATIONS))
@pytest.mark.parametrize("n_objectives", [1, 2])
def test_gradients_agree_with_finite_differences(name: str, scalarization: str, n_objectives: int) -> None:
    scorer = ACQUISITIONS[name]().scorer(context("gaussian_process", scalarization, Y=Y[:, :n_objectives]))
    assert scorer.is_differentiable
    score, gradient = scorer.with_gradient(Z)
    assert score == pytest.approx(scorer(Z))
    for j, e in enumerate(1e-6 * np.eye(2)):
        numeric = (scorer(Z + e) - scorer(Z - e)) / 2e-6
        assert gradient[:, j] == pytest.approx(numeric, rel=2e-2, abs=1e-3 * max(1.0, np.abs(gradient).max()))


@pytest.mark.parametrize("name", [n for n in ACQUISITIONS if n != "thompson_sampling"])
@pytest.mark.parametrize("scalarization", list(SCALARIZATIONS))
@pytest.mark.parametrize("n_objectives", [1, 2])
def test_a_pending_point_is_less_worth_trying_again(name: str, scalarization: str, n_objectives: int) -> None:
    values = Y[:, :n_objectives]
    free = ACQUISITIONS[name]().scorer(context(scalarization=scalarization, Y=values))
    many = np.random.default_rng(5).random((500, 2))
    candidate = many[[np.argmax(free(many))]]
    taken = ACQUISITIONS[name]().scorer(context(scalarization=scalarization, Y=values, pending=candidate))
    assert taken(candidate)[0] < free(candidate)[0]


def test_noisy_expected_improvement_becomes_expected_improvement_without_noise() -> None:
    posterior = GaussianProcess(noise=False).fit(X, Y[:, :1], is_ordered=np.ones(2, bool), rng=np.random.default_rng(0))
    base = context(Y=Y[:, :1])
    ctx = AcquisitionContext(
        **{f: getattr(base, f) for f in ("X", "Y", "X_pending", "scalarization", "weights", "normalization", "rng")},
        posterior=posterior,
    )
    nei, ei = NoisyExpectedImprovement().scorer(ctx)(Z), ExpectedImprovement().scorer(ctx)(Z)
    assert nei == pytest.approx(ei, abs=0.1, rel=0.05)
    assert np.argsort(nei)[-3:].tolist() == np.argsort(ei)[-3:].tolist()


def test_a_lucky_observation_is_no_incumbent_for_noisy_expected_improvement() -> None:
    points = np.repeat(np.linspace(0, 1, 6), 5)[:, None]
    values = 0.3 * np.random.default_rng(3).standard_normal((30, 1))
    values[12] = -3.0  # one lucky draw among five at the same place
    posterior = SURROGATES["gaussian_process"]().fit(
        points, values, is_ordered=np.ones(1, bool), rng=np.random.default_rng(0)
    )
    fantasies = posterior.fantasies(np.empty((0, 1)), 64, np.random.default_rng(0))
    assert fantasies.values.min(axis=1).mean() > -2.0


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("noisy_expected_improvement", {"samples": 1}),
        ("expected_improvement", {"samples": 0}),
        ("upper_confidence_bound", {"beta": -1}),
        ("upper_confidence_bound", {"beta": "linear"}),
        ("thompson_sampling", {"features": 0}),
    ],
)
def test_impossible_options_are_refused(name: str, options: dict) -> None:
    with pytest.raises(ScenarioError, match=next(iter(options))):
        ACQUISITIONS[name](**options)


def test_a_logarithmic_bound_widens_with_the_batches() -> None:
    bound = UpperConfidenceBound(beta="logarithmic")
    assert [bound.width(t) for t in (1, 10)] == pytest.approx([np.sqrt(np.log(3) / 8), np.sqrt(np.log(21) / 8)])
    assert UpperConfidenceBound(beta=1.5).width(10) == 1.5
    scores = [bound.scorer(replace(context(Y=Y[:, :1]), iteration=t))(Z) for t in (1, 100)]
    assert (scores[1] > scores[0]).all()
