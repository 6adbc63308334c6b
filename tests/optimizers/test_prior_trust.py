"""Tests for prior_trust.py: when the region of a prior is found to mislead."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from hypermap_lite.optimizers.prior_trust import Comparison, Evidence, Gauge, checkpoints, compare, infer_corner
from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.priors import AsJoint, ProductPrior
from hypermap_lite.priors.beliefs import Belief
from hypermap_lite.priors.truncated_gaussian import TruncatedNormal
from hypermap_lite.space import RealParameter, SearchSpace
from hypermap_lite.surrogates.base import Prediction
from hypermap_lite.surrogates.gaussian_process import GaussianProcess
from hypermap_lite.typing import FloatArray

SPACE = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))


def prior_at(a: float, scale: float = 0.05) -> ProductPrior:
    return ProductPrior(2, (((0,), AsJoint(TruncatedNormal(a, scale))), ((1,), AsJoint(TruncatedNormal(0.5, scale)))))


@dataclass(frozen=True)
class Known:
    """A posterior that is certain of a valley at a = 0.2, b = 0.5, but for an error everywhere."""

    std: float = 0.0

    def predict(self, X: FloatArray) -> Prediction:
        value = (X[:, 0] - 0.2) ** 2 + (X[:, 1] - 0.5) ** 2
        return Prediction(mean=value[:, None], std=np.full((len(X), 1), self.std))


def evidence_around(a: float, *, posterior: Known, elsewhere: bool = True) -> Evidence:
    """Return evidence from ten draws of a prior and, if wanted, ten uniform ones."""
    rng = np.random.default_rng(5)
    X = prior_at(a).sample(10, rng)
    X = np.vstack([X, rng.random((10, 2))]) if elsewhere else X
    return Evidence(posterior=posterior, X=X, X_all=X)


def compared(evidence: Evidence, a: float) -> Comparison:
    return compare(evidence, Belief(prior=prior_at(a)), SPACE, np.random.default_rng(0))


def test_a_prior_on_a_slope_that_leads_away_fails() -> None:
    comparison = compared(evidence_around(0.9, posterior=Known(std=0.001)), 0.9)
    assert comparison.given_inside == 0 < comparison.given_outside
    assert comparison.promised_inside == 0 < comparison.promised_anywhere
    assert comparison.has_failed


def test_a_prior_on_the_valley_does_not_fail_however_well_it_is_explored() -> None:
    comparison = compared(evidence_around(0.2, posterior=Known()), 0.2)
    assert comparison.given_inside > 0 == comparison.given_outside
    assert not comparison.has_failed


def test_a_prior_whose_region_is_unknown_does_not_fail_before_it_is() -> None:
    doubtful = compared(evidence_around(0.9, posterior=Known(std=1.0)), 0.9)
    assert doubtful.given_inside < doubtful.given_outside
    assert not doubtful.has_failed


def test_nothing_is_decided_without_evaluations_on_both_sides() -> None:
    only_inside = compared(evidence_around(0.9, posterior=Known(std=0.001), elsewhere=False), 0.9)
    assert only_inside.n_outside <= 1
    assert not replace(only_inside, n_outside=0).has_failed
    assert not replace(compared(evidence_around(0.9, posterior=Known()), 0.9), n_inside=0).has_failed


def test_evaluations_without_a_value_count_as_having_given_nothing() -> None:
    evidence = evidence_around(0.9, posterior=Known())
    crashed = replace(evidence, X_all=np.vstack([evidence.X, prior_at(0.9).mode()[None]]))
    assert compared(crashed, 0.9).n_inside == compared(evidence, 0.9).n_inside + 1


def test_a_promise_is_worth_what_is_likely_to_be_feasible() -> None:
    evidence = evidence_around(0.9, posterior=Known(std=1.0))
    infeasible = replace(evidence, log_probability=lambda X: np.where(X[:, 0] > 0.5, -np.inf, 0.0))
    comparison = compared(infeasible, 0.9)
    assert comparison.promised_inside == 0.0
    assert comparison.promised_anywhere > 0
    assert comparison.has_failed


@pytest.mark.parametrize(
    ("given", "promised", "fails"),
    [
        pytest.param((0.0, 1.0), (0.4, 1.0), True, id="less of both"),
        pytest.param((0.0, 1.0), (0.6, 1.0), False, id="it may yet give"),
        pytest.param((0.6, 1.0), (0.0, 1.0), False, id="it has given"),
        pytest.param((0.0, 0.0), (0.4, 1.0), False, id="a plateau, and hope"),
        pytest.param((0.0, 0.0), (0.001, 1.0), True, id="a plateau, and no hope"),
        pytest.param((0.0, 0.0), (0.0, 0.0), False, id="nothing to be had anywhere"),
    ],
)
def test_a_prior_fails_if_it_has_given_less_and_promises_less(
    given: tuple[float, float], promised: tuple[float, float], fails: bool
) -> None:
    comparison = Comparison(
        n_inside=5,
        n_outside=5,
        given_inside=given[0],
        given_outside=given[1],
        promised_inside=promised[0],
        promised_anywhere=promised[1],
    )
    assert comparison.has_failed == fails


def test_what_is_given_counts_per_evaluation() -> None:
    same = Comparison(
        n_inside=9, n_outside=1, given_inside=1.0, given_outside=0.5, promised_inside=0.0, promised_anywhere=1.0
    )
    assert same.has_failed
    assert not replace(same, n_outside=9).has_failed


def test_a_fitted_process_tells_a_wrong_prior_from_a_right_one_for_two_objectives() -> None:
    rng = np.random.default_rng(2)
    for a, fails in ((0.9, True), (0.3, False)):
        X = np.vstack([prior_at(a).sample(9, rng), rng.random((6, 2))])
        Y = np.column_stack([(X[:, 0] - 0.2) ** 2 + X[:, 1] ** 2, (X[:, 0] - 0.4) ** 2 + (X[:, 1] - 1) ** 2])
        posterior = GaussianProcess().fit(X, Y, is_ordered=np.ones(2, dtype=bool), rng=rng)
        evidence = Evidence(posterior=posterior, X=X, X_all=X)
        assert compared(evidence, a).has_failed == fails


@pytest.mark.parametrize(("objective", "fails"), [(None, False), (0, False), (1, True)])
def test_a_prior_on_the_best_of_one_objective_is_measured_by_that_one(objective: int | None, fails: bool) -> None:
    rng = np.random.default_rng(2)
    X = np.vstack([prior_at(0.2).sample(6, rng), rng.random((12, 2))])
    Y = np.column_stack([(X[:, 0] - 0.2) ** 2 + (X[:, 1] - 0.5) ** 2, (X[:, 0] - 0.9) ** 2 + (X[:, 1] - 0.5) ** 2])
    posterior = GaussianProcess().fit(X, Y, is_ordered=np.ones(2, dtype=bool), rng=rng)
    belief = Belief(prior=prior_at(0.2), objective=objective)
    evidence = Evidence(posterior=posterior, X=X, X_all=X, reference_point=np.array([2.0, 2.0]))
    assert compare(evidence, belief, SPACE, np.random.default_rng(0)).has_failed == fails


def test_checks_come_at_growing_intervals() -> None:
    assert list(checkpoints(8, 40)) == [8, 10, 12, 14, 16, 18, 21, 25, 30, 36]
    assert len(list(checkpoints(14, 200))) < 20
    assert list(checkpoints(8, 7)) == []


def test_reach_is_the_hypervolume_but_for_a_constant() -> None:
    rng = np.random.default_rng(0)
    Y, corner = rng.random((8, 2)), np.ones(2)
    gauge = Gauge(corner=corner, scale=np.ones(2), directions=Gauge.of(Y, corner, rng).directions)
    many = replace(gauge, directions=np.vstack([Gauge.of(Y, corner, rng).directions for _ in range(200)]))
    assert many.reach(Y).mean() * np.pi / 4 == pytest.approx(hypervolume(Y, corner), rel=0.02)


def test_reach_of_one_objective_is_the_distance_from_the_worst() -> None:
    Y = np.array([[3.0], [1.0], [2.0]])
    gauge = Gauge.of(Y, None, np.random.default_rng(0))
    assert gauge(Y)[:, 0] == pytest.approx([0.0, 1.0, 0.5])
    assert gauge.reach(Y[:0]) == pytest.approx([0.0])


def test_the_inferred_corner_lies_a_little_beyond_the_front() -> None:
    Y = np.array([[0.0, 1.0], [1.0, 0.0], [5.0, 5.0]])
    assert infer_corner(Y) == pytest.approx([1.1, 1.1])


def test_points_that_are_all_the_same_are_no_trouble() -> None:
    gauge = Gauge.of(np.zeros((3, 2)), None, np.random.default_rng(0))
    assert np.isfinite(gauge(np.array([[-1.0, 0.5]]))).all()
