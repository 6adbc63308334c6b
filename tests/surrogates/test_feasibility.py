"""Tests for feasibility.py."""

from dataclasses import replace

import numpy as np
import pytest

from hypermap_lite.surrogates.feasibility import MAX_ROWS, Evidence, ProbitProcess
from hypermap_lite.surrogates.kernels import MaternHammingKernel
from hypermap_lite.surrogates.marginal_likelihood import HyperPrior
from hypermap_lite.surrogates.telling_rows import telling_rows

APPROXIMATIONS = ("laplace", "both")
ORDERED = np.ones(2, dtype=bool)
KERNEL = MaternHammingKernel(np.full(2, 0.5), ORDERED)
MIXED = np.array([True, True, False])


def in_the_band(X):
    """Tell which points are in the feasible sixth of Chakong and Haimes' problem."""
    x, y = 40 * X[:, 0] - 20, 40 * X[:, 1] - 20
    return (x**2 + y**2 <= 225) & (x - 3 * y + 10 <= 0)


def fitted(n=40, seed=0):
    X = np.random.default_rng(seed).random((n, 2))
    return ProbitProcess().fit(X, in_the_band(X), is_ordered=ORDERED)


@pytest.mark.parametrize("approximation", ["laplace", "both"])
@pytest.mark.parametrize("name", ["log_probability", "log_novelty"])
def test_gradients_are_those_of_finite_differences_and_zero_along_categories(name, approximation) -> None:
    rng = np.random.default_rng(1)
    X = rng.random((30, 3))
    X[:, 2] = np.round(X[:, 2])
    model = ProbitProcess(approximation=approximation)
    posterior = model.fit(X, X[:, 0] + 0.3 * X[:, 2] > 0.6, is_ordered=MIXED)
    at, h = rng.random((7, 3)), 1e-6
    at[:, 2] = 1.0
    value, gradient = getattr(posterior, f"{name}_with_gradient")(at)
    np.testing.assert_array_equal(value, getattr(posterior, name)(at))
    for j in (0, 1):
        step = h * np.eye(3)[j]
        numeric = (getattr(posterior, name)(at + step) - getattr(posterior, name)(at - step)) / (2 * h)
        np.testing.assert_allclose(gradient[:, j], numeric, atol=1e-5)
    assert not gradient[:, 2].any()


def test_probability_is_learned_and_calibrated() -> None:
    T = np.random.default_rng(9).random((4000, 2))
    is_feasible = in_the_band(T)
    log_losses, gaps = [], []
    for seed in range(4):
        p = np.exp(fitted(40, seed).log_probability(T))
        log_losses.append(-np.where(is_feasible, np.log(p), np.log1p(-p)).mean())
        sure = p < 0.1
        gaps.append(is_feasible[sure].mean())
    assert np.mean(log_losses) < 0.33  # 0.44 for the share of feasible points everywhere
    assert np.mean(gaps) < 0.1


@pytest.mark.parametrize("n", [1, 2, 12])
def test_infeasible_points_alone_lower_the_probability_around_them_most(n) -> None:
    X = np.vstack([[0.3, 0.3], 0.5 * np.random.default_rng(2).random((n - 1, 2))])
    posterior = ProbitProcess().fit(X, np.zeros(n, dtype=bool), is_ordered=ORDERED)
    near, far = np.exp(posterior.log_probability(np.array([[0.3, 0.3], [1.0, 1.0]])))
    assert 0 < near < far < 0.5
    known, inside, corner = posterior.log_novelty(np.array([[0.3, 0.3], [0.75, 0.75], [1.0, 1.0]]))
    assert known < inside < 0
    assert corner < inside


@pytest.mark.parametrize("seed", [1, 2, 5])
def test_a_search_among_infeasible_points_alone_looks_between_them(seed) -> None:
    X = np.random.default_rng(seed).random((12, 2))
    candidates = np.random.default_rng(9).random((2048, 2))
    for _ in range(30):
        posterior = ProbitProcess().fit(X, np.zeros(len(X), dtype=bool), is_ordered=ORDERED)
        score = posterior.log_probability(candidates) + posterior.log_novelty(candidates)
        best = candidates[score.argmax()]
        assert np.linalg.norm(X - best, axis=1).min() > 0.08
        X = np.vstack([X, best])


def test_feasible_points_alone_raise_it() -> None:
    posterior = ProbitProcess().fit(np.array([[0.3, 0.3]]), np.array([True]), is_ordered=ORDERED)
    near, far = np.exp(posterior.log_probability(np.array([[0.3, 0.3], [1.0, 1.0]])))
    assert 0.5 < far < near < 1


def test_first_infeasible_point_among_feasible_ones_is_avoided() -> None:
    X = np.array([[0.1, 0.1], [0.1, 0.5], [0.3, 0.2], [0.9, 0.9]])
    posterior = ProbitProcess().fit(X, np.array([True, True, True, False]), is_ordered=ORDERED)
    bad, good = np.exp(posterior.log_probability(np.array([[0.9, 0.9], [0.15, 0.3]])))
    assert bad < 0.5 < 0.8 < good


@pytest.mark.parametrize("seed", range(8))
def test_a_single_feasible_point_is_the_tip_of_a_region_and_no_matter_of_chance(seed) -> None:
    middle = np.array([0.3, 0.3])
    X = np.random.default_rng(seed).random((100, 2))
    X = np.vstack([middle, X[np.linalg.norm(X - middle, axis=1) > 0.12][:40]])  # of a disc of 4.5 %
    posterior = ProbitProcess().fit(X, np.arange(41) == 0, is_ordered=ORDERED)
    p = np.exp(posterior.log_probability(np.array([[0.32, 0.32], [0, 0], [0, 1], [1, 0], [1, 1]])))
    assert p[0] > 1.2 * p[1:].max()


def test_a_category_that_was_always_infeasible_is_avoided() -> None:
    X = np.random.default_rng(3).random((24, 3))
    X[:, 2] = np.arange(24) % 3 / 3
    posterior = ProbitProcess().fit(X, X[:, 2] > 0.5, is_ordered=MIXED)
    p = np.exp(posterior.log_probability(np.array([[0.5, 0.5, 0.0], [0.5, 0.5, 2 / 3]])))
    assert p[0] < 0.2
    assert p[1] > 0.7


def test_the_model_of_many_points_rests_on_the_telling_ones() -> None:
    X = np.random.default_rng(4).random((1000, 2))
    is_feasible = in_the_band(X) & (X[:, 0] < 0.35)
    rows = telling_rows(X, is_feasible, KERNEL, MAX_ROWS)
    assert len(rows) == MAX_ROWS == len(set(rows.tolist()))
    assert set(np.flatnonzero(is_feasible)) <= set(rows)
    posterior = ProbitProcess().fit(X, is_feasible, is_ordered=ORDERED)
    assert len(posterior.X) == MAX_ROWS
    p = np.exp(posterior.log_probability(X))
    assert np.mean((p > 0.5) == is_feasible) > 0.98


def test_points_of_one_kind_are_thinned_evenly() -> None:
    X = np.random.default_rng(5).random((1000, 2))
    rows = telling_rows(X, np.zeros(1000, dtype=bool), KERNEL, 11)
    assert len(rows) == 11
    assert len(set(rows.tolist())) == 11


@pytest.mark.parametrize("n", [80, 200])
def test_labels_with_a_reason_are_likelier_than_the_same_at_random(n) -> None:
    rng = np.random.default_rng(6)
    X = rng.random((n, 2))
    labels = in_the_band(X)
    with_reason = ProbitProcess().evidence(X, labels, is_ordered=ORDERED)[0]
    without = ProbitProcess().evidence(X, rng.permutation(labels), is_ordered=ORDERED)[0]
    assert without < 1.5 * with_reason < 0


def test_evidence_of_labels_is_the_negative_of_what_is_minimized() -> None:
    X = np.random.default_rng(7).random((30, 2))
    model, labels = ProbitProcess(), in_the_band(X)
    start = model._mode(HyperPrior.over(ORDERED, {}))
    minimized = Evidence(X, np.where(labels, 1.0, -1.0), KERNEL, model)
    best = model._fit(start, minimized)
    assert model.evidence(X, labels, is_ordered=ORDERED)[0] == pytest.approx(-minimized(best)[0])
    assert minimized(best)[0] < minimized(start)[0]


def test_both_approximations_together_are_the_more_cautious_and_say_less_of_a_corner_that_is_known_to_be_infeasible():
    rng = np.random.default_rng(0)
    X = np.vstack([rng.random((20, 2)), 0.04 * rng.random((30, 2))])
    mode, both = (
        ProbitProcess(approximation=a).fit(X, X.sum(axis=1) > 0.8, is_ordered=ORDERED) for a in APPROXIMATIONS
    )
    T = rng.random((500, 2))
    assert np.all(both.log_probability(T) <= mode.log_probability(T))
    corner = np.array([[0.02, 0.02]])
    assert np.exp(both.log_probability(corner)) < 0.5 * np.exp(mode.log_probability(corner))
    top = np.array([[0.95, 0.95]])
    assert np.exp(both.log_probability(top)) > 0.8


def test_the_moments_keep_a_doubt_of_what_no_evaluation_is_close_to() -> None:
    X = np.vstack([0.3 * np.random.default_rng(0).random((20, 2)), [[0.35, 0.3]]])
    both = ProbitProcess(approximation="both").fit(X, X[:, 0] > 0.34, is_ordered=ORDERED)
    sure = replace(both.by_moments, doubt=0.0)
    far, near = np.array([[1.0, 1.0]]), X[:1]
    assert np.exp(both.by_moments.log_probability(far) - sure.log_probability(far)) > 1.01
    assert both.by_moments.log_probability(near) == pytest.approx(sure.log_probability(near), abs=0.5)


def test_where_nothing_is_feasible_yet_both_are_the_mode() -> None:
    X, labels = np.random.default_rng(0).random((5, 2)), np.zeros(5, dtype=bool)
    mode, both = (ProbitProcess(approximation=a).fit(X, labels, is_ordered=ORDERED) for a in APPROXIMATIONS)
    np.testing.assert_array_equal(mode.log_probability(X), both.log_probability(X))
