"""Which evaluations may be failures."""

import numpy as np
import pytest

from hypermap_lite.surrogates.failures import Failures, candidates

SUCCESSES = np.array([1.2, 1.5, 1.9, 2.4, 1.7, 2.1])
FAILURES = np.full(8, 6.0)
MODES = np.r_[SUCCESSES, FAILURES]


def test_the_limit_lies_between_two_modes() -> None:
    (found,) = candidates(MODES[:, None], None)
    assert (found.objective, found.limit) == (0, pytest.approx(4.2))
    assert np.array_equal(found.among(MODES[:, None]), MODES == 6)


@pytest.mark.parametrize("factor", [1e-140, 1e-9, 1e9, 1e140])
def test_it_is_the_same_in_all_units(factor: float) -> None:
    (found,) = candidates(factor * MODES[:, None], None)
    assert found.limit == pytest.approx(4.2 * factor)


def test_most_normal_and_uniform_values_have_one_mode() -> None:
    rng = np.random.default_rng(0)
    for draw in (rng.normal, rng.random):
        found = [[*candidates(draw(size=(40, 1)), None)] for _ in range(30)]
        assert sum(not failures for failures in found) > 15


@pytest.mark.parametrize("y", [np.r_[SUCCESSES, 6.0, 6.1], np.r_[1.2, 1.5, FAILURES]])
def test_two_values_are_no_kind(y: np.ndarray) -> None:
    assert all(3 <= failures.among(y[:, None]).sum() <= len(y) - 3 for failures in candidates(y[:, None], None))


@pytest.mark.parametrize("y", [np.full(12, 3.0), np.r_[np.zeros(6), np.full(6, 5e-324)]])
def test_equal_values_have_none(y: np.ndarray) -> None:
    assert not [*candidates(y[:, None], None)]


def test_what_the_front_needs_is_no_failure() -> None:
    """The failures of the first objective take no effort at all, or more than anybody would spend."""
    corner = np.array([7.0, 3.0])
    for effort, expected in ((0.0, []), (5.0, [Failures(objective=0, limit=4.2)])):
        Y = np.column_stack([MODES, np.r_[np.linspace(2, 1, 6), np.full(8, effort)]])
        found = [failures for failures in candidates(Y, corner) if failures.objective == 0]
        assert [(f.objective, round(f.limit, 9)) for f in found] == [(f.objective, f.limit) for f in expected]


def test_it_is_of_another_kind_for_those_who_ask() -> None:
    corner = np.array([7.0, 3.0])
    for effort, are_needed in ((0.0, True), (5.0, False)):
        Y = np.column_stack([MODES, np.r_[np.linspace(2, 1, 6), np.full(8, effort)]])
        found = [failures for failures in candidates(Y, corner, or_needed=True) if failures.objective == 0]
        assert [failures.are_needed for failures in found] == [are_needed]
        assert np.array_equal(found[0].among(Y), MODES == 6)


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_what_only_costs_less_where_it_fails_is_a_failure(order: list[int]) -> None:
    """Beyond the reference point the front needs nothing, so the successes are not one of two kinds by their effort."""
    corner = np.array([5.0, 4.0])[order]
    Y = np.column_stack([MODES, np.r_[np.linspace(2, 1, 6), np.linspace(0.2, 0.4, 8)]])[:, order]
    (found,) = candidates(Y, corner, or_needed=True)
    assert not found.are_needed
    assert np.array_equal(found.among(Y), MODES == 6)


def test_with_one_objective_none_is_needed() -> None:
    assert not any(failures.are_needed for failures in candidates(MODES[:, None], None, or_needed=True))


def test_without_hypervolume_nothing_is_known_to_be_needless() -> None:
    Y = np.column_stack([MODES, np.r_[np.linspace(2, 1, 6), np.full(8, 5.0)]])
    for or_needed in (False, True):
        assert not [*candidates(Y, np.array([1.0, 0.5]), or_needed=or_needed)]
