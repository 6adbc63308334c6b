"""Fronts one behind the other, and how crowded they are."""

import numpy as np
import pytest

from hypermap_lite.pareto.ranking import crowding_distances, non_dominated_ranks

STAIRS = np.array([[0.0, 3.0], [1.0, 1.0], [3.0, 0.0], [1.0, 3.0], [3.0, 1.0], [4.0, 4.0]])


def test_ranks_count_the_fronts_in_front() -> None:
    assert non_dominated_ranks(STAIRS).tolist() == [0, 0, 0, 1, 1, 2]


def test_copies_share_a_rank_and_what_is_not_finite_comes_last() -> None:
    Y = np.array([[1.0, 1.0], [1.0, 1.0], [np.inf, np.inf], [2.0, 2.0], [np.nan, 0.0]])
    assert non_dominated_ranks(Y).tolist() == [0, 0, 2, 1, 2]
    assert non_dominated_ranks(np.full((3, 2), np.inf)).tolist() == [0, 0, 0]


def test_ranks_of_one_objective_are_those_of_its_values() -> None:
    assert non_dominated_ranks(np.array([[3.0], [1.0], [2.0], [1.0]])).tolist() == [2, 0, 1, 0]


def test_the_ends_of_a_front_are_lonely_and_gaps_are_in_units_of_its_extent() -> None:
    Y = np.array([[0.0, 40.0], [1.0, 30.0], [2.0, 10.0], [4.0, 0.0]])
    distances = crowding_distances(Y, non_dominated_ranks(Y))
    assert distances == pytest.approx([np.inf, 2 / 4 + 30 / 40, 3 / 4 + 30 / 40, np.inf])


def test_nothing_usable_has_no_distance() -> None:
    Y = np.full((2, 2), np.inf)
    assert crowding_distances(Y, non_dominated_ranks(Y)).tolist() == [0, 0]
    assert crowding_distances(np.ones((3, 2)), np.zeros(3, dtype=np.int64)).tolist() == [0, 0, 0]
