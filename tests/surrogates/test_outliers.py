"""What a Gaussian process makes of evaluations that are far worse than the others foretell."""

import math

import numpy as np
import pytest

from hypermap_lite.optimizers.models import milestones
from hypermap_lite.surrogates import GaussianProcess
from hypermap_lite.surrogates.gaussian_process import GaussianProcessPosterior
from hypermap_lite.surrogates.marginal_likelihood import HyperPrior, MarginalLikelihood, fit_hyperparameters
from hypermap_lite.surrogates.outliers import FEWEST, RARE, Start, without_outliers
from hypermap_lite.surrogates.process import Standardized
from tests.slow import slow_after

ORDERED = np.ones(2, dtype=bool)
X = np.random.default_rng(2).random((30, 2))
Z = np.random.default_rng(3).random((200, 2))


def waves(points: np.ndarray) -> np.ndarray:
    return np.sin(6 * points[:, 0]) + points[:, 1] ** 2


def posterior(y: np.ndarray, points: np.ndarray = X, **options: bool) -> GaussianProcessPosterior:
    """Return what is known after the last of a chain of fits, as there is in a run."""
    model, start = GaussianProcess(**options), None
    for n in [*milestones(len(points), 1.2), len(points)]:
        rng = np.random.default_rng(0)
        fitted = model.fit(
            points[:n],
            y[:n, None],
            is_ordered=np.ones(points.shape[1], dtype=bool),
            rng=rng,
            start=start,
            anew=n < len(points),
        )
        start = fitted.start
    assert isinstance(fitted, GaussianProcessPosterior)
    return fitted


def start(*outliers: int) -> Start:
    h = HyperPrior.over(ORDERED, {}).mode()
    return Start(n=25, hyperparameters=h, scale=1.0, outliers=outliers)


def spoilt(*rows: int, by: float = 5.0) -> np.ndarray:
    y = waves(X)
    y[list(rows)] += by
    return y


def set_aside(fitted: GaussianProcessPosterior) -> list[int]:
    return np.flatnonzero(fitted.outliers()[:, 0]).tolist()


def error(fitted: GaussianProcessPosterior) -> float:
    return float(np.abs(fitted.predict(Z).mean[:, 0] - waves(Z)).mean())


@pytest.mark.parametrize("by", [2.0, 5.0, 1e6])
def test_failures_without_a_reason_leave_the_model_as_it_would_be_without_them(by: float) -> None:
    rows = [14, 17, 21]
    told = posterior(spoilt(*rows, by=by))
    assert set_aside(told) == rows
    rest = np.setdiff1d(np.arange(len(X)), rows)
    without = posterior(waves(X)[rest], X[rest])
    assert told.predict(Z).mean == pytest.approx(without.predict(Z).mean, abs=0.02)
    assert error(told) < 0.1 * error(posterior(spoilt(*rows, by=by), ignore_outliers=False))


@pytest.mark.parametrize("dimension", slow_after(2, [1, 4, 2, 6]))
@pytest.mark.parametrize("power", [1, 2])
def test_failures_are_found_on_smooth_functions_however_far_the_model_extrapolates(dimension: int, power: int) -> None:
    found = 0
    for seed in range(6):
        rng = np.random.default_rng(seed)
        points = rng.random((30, dimension))
        y = (points**power) @ rng.normal(size=dimension)
        rows = np.sort(rng.choice(np.arange(12, 30), 2, replace=False)).tolist()
        y[rows] += 20 * y.std()
        found += set_aside(posterior(y, points)) == rows
    assert found >= 5


def test_a_failure_with_a_reason_counts_once_there_are_two() -> None:
    """On the first one it cannot be known."""
    place = np.array([[0.5, 0.5], [0.52, 0.5]])
    failed = waves(place) + 5
    first, both = (posterior(np.append(waves(X), failed[:k]), np.vstack([X, place[:k]])) for k in (1, 2))
    assert set_aside(first) == [30]
    assert set_aside(both) == []
    assert first.predict(place).mean[0, 0] == pytest.approx(waves(place)[0], abs=0.1)
    assert both.predict(place).mean[:, 0] == pytest.approx(failed, rel=0.1)


def test_a_failure_next_to_one_that_counts_counts_too() -> None:
    """As on the edge of a region of failures, whose inner ones foretell each other."""
    inner = np.array([0.9, 0.9]) + 0.1 * np.random.default_rng(1).random((6, 2))
    points = np.vstack([inner, X, [[0.88, 0.88]]])
    y = np.append(np.append(np.full(6, 9.0), waves(X)), 9.0)
    assert set_aside(posterior(y, points)) == []


def test_what_is_surprisingly_good_counts() -> None:
    assert set_aside(posterior(spoilt(4, by=-5))) == []


def test_what_turns_out_to_be_good_counts_again() -> None:
    y = spoilt(4, by=-3)
    likelihood = MarginalLikelihood(X, Standardized.of(y).values, ORDERED, HyperPrior.over(ORDERED, {}))
    found = without_outliers(likelihood, y, [likelihood.prior.mode()], before=start(4), is_exact=True).fit
    assert found.likelihood.offsets is None


def test_equal_values_foretell_nothing_in_whatever_units() -> None:
    for by in (1e-9, 1.0, 1e9):
        y = np.ones(20)
        y[13] += by
        assert set_aside(posterior(y, X[:20])) == []


def test_values_of_all_sizes_are_met_with_numbers() -> None:
    y = spoilt(14, by=1e149)
    y[20] = -1e149
    assert np.isfinite(posterior(y).predict(Z).mean).all()


def test_a_success_among_failures_counts_and_so_do_the_failures() -> None:
    y = np.ones(30)
    y[11] = 0.2
    assert set_aside(posterior(y)) == []


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_smooth_functions_and_noise_have_no_outliers(seed: int, noise: float) -> None:
    rng = np.random.default_rng(seed)
    points = rng.random((40, 2))
    assert set_aside(posterior(waves(points) + noise * rng.standard_normal(40), points)) == []


def test_what_happens_often_is_no_exception() -> None:
    """Of twelve failures in thirty the model believes most."""
    rows = np.random.default_rng(0).permutation(30)[:12]
    assert len(set_aside(posterior(spoilt(*rows.tolist())))) <= 2


def test_none_among_few_evaluations() -> None:
    y = waves(X)
    y[3] += 100
    assert set_aside(posterior(y[: FEWEST - 1], X[: FEWEST - 1])) == []
    assert set_aside(posterior(y[:16], X[:16])) == [3]


def test_none_where_the_noise_is_known_or_there_is_none() -> None:
    y = spoilt(4)
    assert set_aside(posterior(y, noise=False)) == []
    known = GaussianProcess(noise_from_replicates=True).fit(
        X,
        y[:, None],
        is_ordered=ORDERED,
        rng=np.random.default_rng(0),
        noise_variance=np.full((30, 1), 0.01),
    )
    assert not known.outliers().any()


def test_each_objective_has_its_own() -> None:
    Y = np.column_stack([spoilt(4), spoilt(9)])
    outliers = GaussianProcess().fit(X, Y, is_ordered=ORDERED, rng=np.random.default_rng(0)).outliers()
    assert np.argwhere(outliers).tolist() == [[4, 0], [9, 1]]


def test_infeasible_evaluations_beside_are_none_of_them() -> None:
    """They are learnt from as ever, next to outliers."""
    beyond = np.random.default_rng(5).random((10, 2)) + np.array([1.0, 0.0])
    told = GaussianProcess().fit(
        np.vstack([X, beyond]),
        np.append(spoilt(4), waves(beyond) + 1.0)[:, None],
        is_ordered=ORDERED,
        rng=np.random.default_rng(0),
        n_beside=len(beyond),
    )
    assert set_aside(told) == [4]
    assert told.outliers().shape == (30, 1)
    assert told.predict(beyond).mean[:, 0] == pytest.approx(waves(beyond), abs=0.5)


def test_what_is_set_aside_is_likelier_as_an_outlier() -> None:
    """The densities that are compared, worked out from those of processes."""
    y, prior = spoilt(4), HyperPrior.over(ORDERED, {})
    output = Standardized.of(y)
    likelihood = MarginalLikelihood(X, output.values, ORDERED, prior)
    best = fit_hyperparameters(likelihood, [prior.mode()])
    found = without_outliers(likelihood, y, [prior.mode()], is_exact=True).fit
    others = np.arange(30) != 4
    alone = MarginalLikelihood(X[others], found.output.values[others], ORDERED, prior)
    mean = found.process.joint(X[4:5])[0][0]
    distance = y[4] - found.output.offset - found.output.scale * mean
    of_outlier = math.log(RARE / (1 - RARE)) - 0.5 * math.log(2 * math.pi * math.e) - math.log(distance)
    of_others = -alone(found.hyperparameters.to_log())[0] - 29 * math.log(found.output.scale)
    of_all = -likelihood(best.to_log())[0] - 30 * math.log(output.scale)
    assert of_others + of_outlier > of_all + 10
    assert found.output.values[4] == 0.0
    assert found.output.values[others] == pytest.approx(Standardized.of(y[others]).values)


def test_outliers_that_are_none_any_more_count_again() -> None:
    y = waves(X)
    likelihood = MarginalLikelihood(X, Standardized.of(y).values, ORDERED, HyperPrior.over(ORDERED, {}))
    found = without_outliers(likelihood, y, [likelihood.prior.mode()], before=start(3, 8), is_exact=True).fit
    assert found.likelihood.offsets is None
    assert np.array_equal(found.output.values, Standardized.of(y).values)
