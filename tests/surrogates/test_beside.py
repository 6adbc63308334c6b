"""What a Gaussian process makes of what is reported beside the evaluations that count."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from hypermap_lite.surrogates import GaussianProcess
from hypermap_lite.surrogates.beside import NONSENSE, SHARED, loss_of_nonsense
from hypermap_lite.surrogates.gaussian_process import GaussianProcessPosterior
from hypermap_lite.surrogates.marginal_likelihood import Hyperparameters
from hypermap_lite.surrogates.offsets import Offsets
from hypermap_lite.surrogates.process import Process, Standardized

ORDERED = np.ones(2, dtype=bool)
EDGE = 0.6
KNOWN = np.random.default_rng(4).random((16, 2)) * np.array([EDGE, 1])
BEYOND = np.random.default_rng(5).random((12, 2)) * np.array([1 - EDGE, 1]) + np.array([EDGE, 0])


def waves(X: np.ndarray) -> np.ndarray:
    return np.sin(6 * X[:, :1]) + X[:, 1:] ** 2


def error_beyond(reported: np.ndarray | None) -> float:
    """Return the error beyond what is known, with what is reported there, in standard deviations of the outputs."""
    Z = np.random.default_rng(6).random((200, 2)) * np.array([1 - EDGE, 1]) + np.array([EDGE, 0])
    model, options = GaussianProcess(), {"is_ordered": ORDERED, "rng": np.random.default_rng(0)}
    if reported is None:
        posterior = model.fit(KNOWN, waves(KNOWN), **options)
    else:
        values = np.vstack([waves(KNOWN), reported])
        posterior = model.fit(np.vstack([KNOWN, BEYOND]), values, **options, n_beside=len(BEYOND))
    return float(np.abs(posterior.predict(Z).mean - waves(Z)).mean() / waves(KNOWN).std())


def test_what_is_reported_beside_is_learned() -> None:
    assert error_beyond(waves(BEYOND)) < 0.3 * error_beyond(None)


@pytest.mark.parametrize("penalty", [-1.5, 1.5])
def test_a_penalty_beside_is_found_out(penalty: float) -> None:
    """An unknown constant is told from the objective by what both are near the edge."""
    assert error_beyond(waves(BEYOND) + penalty) < 0.6 * error_beyond(None)


@pytest.mark.parametrize("seed", range(3))
def test_nonsense_beside_teaches_nothing(seed: int) -> None:
    nonsense = np.random.default_rng(seed).uniform(-3, 3, (len(BEYOND), 1))
    assert error_beyond(nonsense) == pytest.approx(error_beyond(None), rel=1e-3)


def test_what_is_not_known_beside_changes_nothing() -> None:
    unknown = np.full((len(BEYOND), 1), np.nan)
    assert error_beyond(unknown) == error_beyond(None)
    some = waves(BEYOND)
    some[::2] = np.nan
    model, options = GaussianProcess(), {"is_ordered": ORDERED, "rng": np.random.default_rng(0)}
    rows = [*range(len(KNOWN)), *range(len(KNOWN) + 1, len(KNOWN) + len(BEYOND), 2)]
    X, Y = np.vstack([KNOWN, BEYOND]), np.vstack([waves(KNOWN), some])
    with_gaps = model.fit(X, Y, **options, n_beside=len(BEYOND))
    without = model.fit(X[rows], Y[rows], **options, n_beside=len(BEYOND) // 2)
    assert with_gaps.predict(X).mean == pytest.approx(without.predict(X).mean, abs=1e-4)
    assert with_gaps.predict(X).std == pytest.approx(without.predict(X).std, abs=1e-4)


def test_one_objective_may_be_known_beside_and_another_not() -> None:
    X, alone = np.vstack([KNOWN, BEYOND]), np.column_stack([waves(KNOWN), waves(KNOWN)])
    beside = np.column_stack([waves(BEYOND)[:, 0], np.full(len(BEYOND), np.nan)])
    model, options = GaussianProcess(), {"is_ordered": ORDERED, "rng": np.random.default_rng(0)}
    prediction = model.fit(X, np.vstack([alone, beside]), **options, n_beside=len(BEYOND)).predict(BEYOND)
    one = model.fit(KNOWN, alone, **options).predict(BEYOND)
    assert prediction.mean[:, 0] == pytest.approx(waves(BEYOND)[:, 0], abs=0.01)
    assert prediction.mean[:, 1] == pytest.approx(one.mean[:, 1], abs=1e-4)
    assert prediction.std[:, 1] == pytest.approx(one.std[:, 1], abs=1e-4)


def test_density_of_nonsense_is_that_of_its_covariance() -> None:
    y = np.random.default_rng(0).normal(1, 2, 7)
    covariances = [SHARED * np.ones((7, 7)) + variance * np.eye(7) for variance in NONSENSE]
    densities = [multivariate_normal(np.zeros(7), covariance).logpdf(y) for covariance in covariances]
    assert loss_of_nonsense(y) == pytest.approx(-max(densities))


def test_points_beside_leave_the_draws_at_the_others() -> None:
    posterior = GaussianProcess().fit(
        np.vstack([KNOWN, BEYOND]),
        np.vstack([waves(KNOWN), waves(BEYOND) - 5]),
        is_ordered=ORDERED,
        rng=np.random.default_rng(0),
        n_beside=len(BEYOND),
    )
    pending = np.array([[0.1, 0.2], [0.5, 0.9]])
    for known, more in ((posterior, pending), (posterior.believe(pending), pending[:0])):
        draws = known.fantasies(more, 16, np.random.default_rng(1)).values
        assert draws.shape == (16, len(KNOWN) + len(pending), 1)
        assert draws.mean(axis=0)[:16] == pytest.approx(waves(KNOWN), abs=0.1)


def test_drawn_functions_are_as_unsure_as_the_predictions() -> None:
    """A path that left the shared error out would be sure of what is reported beside."""
    is_beside = np.array([False, False, True, True])
    process = Process.condition(
        np.array([[0.1, 0.5], [0.3, 0.5], [0.8, 0.4], [0.9, 0.6]]),
        Standardized(np.array([0.0, 0.5, 1.0, 1.2]), 0.0, 1.0),
        Hyperparameters(np.array([0.2, 0.8]), 1.0, 1e-4),
        ORDERED,
        offsets=Offsets(is_beside, SHARED, np.zeros(4)),
    )
    posterior = GaussianProcessPosterior(processes=(process,), may_be_best=~is_beside, lacks_noise=(False,))
    Z, rng = process.X[2:], np.random.default_rng(1)
    draws = np.array([posterior.sample_path(rng, 512)(Z).mean[0, :, 0] for _ in range(500)])
    prediction = posterior.predict(Z)
    assert draws.mean(axis=0) == pytest.approx(prediction.mean[:, 0], abs=0.1)
    assert draws.std(axis=0) == pytest.approx(prediction.std[:, 0], rel=0.15)


@pytest.mark.parametrize(("shared", "own"), [(SHARED, 0.0), (SHARED, 0.1), (0.0, 1e6)])
def test_share_explained_is_that_of_predictions_without_each_output_that_counts(shared: float, own: float) -> None:
    X, n = np.vstack([KNOWN, BEYOND]), len(KNOWN)
    h = Hyperparameters(lengthscales=np.array([0.4, 0.8]), output_variance=1.2, noise_variance=0.02)
    values = Standardized.of(waves(KNOWN)[:, 0]).also(waves(BEYOND)[:, 0] + 0.5).values
    is_beside = np.arange(len(X)) >= n

    def process(rows: np.ndarray) -> Process:
        output = Standardized(values[rows], 0.0, 1.0)
        offsets = Offsets(is_beside[rows], shared, own * is_beside[rows])
        return Process.condition(X[rows], output, h, ORDERED, offsets=offsets)

    every = np.arange(len(X))
    left_out = np.array([process(every[every != i]).joint(X[i : i + 1])[0][0] for i in range(n)])
    others = (values[:n].sum() - values[:n]) / (n - 1)
    expected = 1 - np.square(values[:n] - left_out).sum() / np.square(values[:n] - others).sum()
    assert process(every).explained(~is_beside) == pytest.approx(expected)
