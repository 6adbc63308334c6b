"""Whether failures are told apart, by evidence."""

import warnings
from typing import Any

import numpy as np
import pytest

from hypermap_lite.surrogates import GaussianProcess, failure_evidence
from hypermap_lite.surrogates.failure_evidence import FEWEST
from hypermap_lite.surrogates.failures import Failures
from hypermap_lite.surrogates.feasibility import ProbitProcess
from hypermap_lite.surrogates.marginal_likelihood import MarginalLikelihood, fit_hyperparameters
from hypermap_lite.surrogates.process import Standardized

X = np.random.default_rng(5).random((40, 3))
ORDERED = np.ones(3, dtype=bool)
SUCCEEDS = np.hypot(X[:, 0] - 0.6, X[:, 1] - 0.5) < 0.4
DURATION = 1 + (X[:, 2] - 0.3) ** 2 + 0.5 * (X[:, 0] - 0.5) ** 2
FAILED = 2.5
SKILL = np.where(SUCCEEDS, DURATION, FAILED)


def told_apart(
    Y: np.ndarray, points: np.ndarray = X, corner: Any = None, *, or_needed: bool = False, **options: Any
) -> Failures | None:
    Y = Y.reshape(len(points), -1)
    least = np.full(Y.shape[1], -np.inf)
    return GaussianProcess(**options).failures(
        points, Y, least, corner, is_ordered=np.ones(points.shape[1], dtype=bool), or_needed=or_needed
    )


def test_what_the_front_needs_is_told_apart_if_asked_for() -> None:
    """Where the skill gives up it takes less effort."""
    Y, corner = np.column_stack([SKILL, np.where(SUCCEEDS, 2 - DURATION / 2, 0.1 + 0.1 * X[:, 1])]), np.full(2, 3.0)
    assert told_apart(Y, corner=corner) is None
    assert told_apart(Y, corner=corner, or_needed=True, separate_modes=False) is None
    found = told_apart(Y, corner=corner, or_needed=True)
    assert found is not None
    assert found.are_needed
    assert np.array_equal(found.among(Y), ~SUCCEEDS if found.objective == 0 else SUCCEEDS)


@pytest.mark.parametrize("factor", [1e-6, 1.0, 1e6])
def test_failures_of_a_skill_are_told_apart_in_all_units(factor: float) -> None:
    found = told_apart(factor * SKILL)
    assert found is not None
    assert np.array_equal(found.among(factor * SKILL[:, None]), ~SUCCEEDS)


def test_so_are_failures_with_values_of_their_own_and_noise() -> None:
    noise = 0.02 * np.random.default_rng(0).normal(size=40)
    y = np.where(SUCCEEDS, DURATION, FAILED + 0.3 * X[:, 2]) + noise
    found = told_apart(y)
    assert found is not None
    assert np.array_equal(found.among(y[:, None]), ~SUCCEEDS)


def test_penalties_are_rather_failures_than_a_tail() -> None:
    found = told_apart(np.where(SUCCEEDS, DURATION, 1e5))
    assert found is not None
    assert 1e2 < found.limit < 1e5


@pytest.mark.parametrize(
    "function",
    [
        lambda points: ((points - 0.4) ** 2).sum(axis=1),
        lambda points: np.tanh(20 * (points[:, 0] - 0.5)),
        lambda points: np.sin(9 * points[:, 0]) + np.cos(7 * points[:, 1]),
        lambda points: np.exp(12 * points[:, 0]) + np.exp(9 * points[:, 1]),
        lambda points: np.random.default_rng(1).normal(size=len(points)),
    ],
    ids=["bowl", "steep", "waves", "decades", "noise"],
)
def test_functions_without_failures_have_none(function: Any) -> None:
    for n in (11, 20, 40):
        assert told_apart(function(X[:n]), X[:n]) is None


@pytest.mark.parametrize("rows", [(1, 9, 17, 25), (4, 13, 22, 31)], ids=["alone", "neighbours"])
def test_a_few_failures_without_a_reason_are_none(rows: tuple[int, ...]) -> None:
    y = DURATION.copy()
    y[list(rows)] = FAILED
    assert told_apart(y) is None


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5])
@pytest.mark.parametrize("has_values", [False, True])
def test_where_success_is_a_matter_of_chance_nothing_is_told_apart(share: float, has_values: bool) -> None:
    found = 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        points = rng.random((40, 2))
        success = 1 + 0.5 * points[:, 0] if has_values else 1 + 0.01 * rng.random(40)
        found += told_apart(np.where(rng.random(40) < share, 6.0, success), points) is not None
    assert found <= 1


def test_with_one_objective_successes_must_differ() -> None:
    assert told_apart(np.where(SUCCEEDS, 0.0, 1.0)) is None


def test_half_of_a_front_is_no_failure_however_far_the_reference_point() -> None:
    """Fast and forceful, or slow and gentle; nobody wants a third kind."""
    rng = np.random.default_rng(0)
    fast = np.column_stack([1 + 0.3 * X[:, 2], 1 + 0.3 * rng.random(40)])
    slow = np.column_stack([5 + 0.3 * X[:, 2], 0.1 + 0.03 * rng.random(40)])
    Y = np.where(SUCCEEDS[:, None], fast, slow)
    for corner in (6.0, 50.0, 1e6):
        assert told_apart(Y, corner=np.full(2, corner)) is None


@pytest.mark.parametrize("factor", [1e-200, 1e-161, 1e150])
def test_neither_tiny_nor_huge_values_are_a_mistake(factor: float) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for Y in (factor * SKILL, np.column_stack([factor * SKILL] * 4)):
            told_apart(Y, corner=None if Y.ndim == 1 else np.full(4, 2.0 * factor))


def test_values_that_differ_by_rounding_have_no_failures() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert told_apart(np.where(SUCCEEDS, 0.3, 0.1 + 0.2)) is None


def test_with_several_objectives_failures_are_those_of_one() -> None:
    effort = np.where(SUCCEEDS, 2 - X[:, 2], 5 + X[:, 1])
    Y = np.column_stack([SKILL, effort])
    found = told_apart(Y, corner=np.array([2.2, 2.2]))
    assert found is not None
    assert np.array_equal(found.among(Y), ~SUCCEEDS)


def test_nothing_is_told_apart_where_that_is_not_asked_for_or_known_from_replicates_or_too_soon() -> None:
    assert told_apart(SKILL, separate_failures=False) is None
    assert told_apart(SKILL, noise_from_replicates=True) is None
    assert told_apart(SKILL[: FEWEST - 1], X[: FEWEST - 1]) is None


def test_the_whole_is_likelier_by_the_margin(monkeypatch: pytest.MonkeyPatch) -> None:
    """The densities that are compared, worked out from those of processes."""
    model = GaussianProcess(ignore_outliers=False, compress_tails=False)
    prior = model._prior(ORDERED, {})

    def density(points: np.ndarray, y: np.ndarray) -> float:
        output = Standardized.of(y)
        likelihood = MarginalLikelihood(points, output.values, ORDERED, prior)
        best = fit_hyperparameters(likelihood, [prior.mode()], is_exact=False)
        return -likelihood(best.to_log())[0] - len(y) * np.log(output.scale)

    y = np.where(SUCCEEDS, DURATION, FAILED + 0.2 * X[:, 1]) + 0.02 * np.random.default_rng(0).normal(size=40)
    of_labels = ProbitProcess().evidence(X, SUCCEEDS, is_ordered=ORDERED)[0]
    apart = density(X[SUCCEEDS], y[SUCCEEDS]) + density(X[~SUCCEEDS], y[~SUCCEEDS]) + of_labels
    gain = (apart - density(X, y)) / len(X)
    for margin, is_found in ((gain - 1e-3, True), (gain + 1e-3, False)):
        monkeypatch.setattr(failure_evidence, "MARGIN", margin)
        assert (told_apart(y, ignore_outliers=False, compress_tails=False) is not None) == is_found
