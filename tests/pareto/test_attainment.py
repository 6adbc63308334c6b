"""Tests for attainment.py."""

from itertools import pairwise

import numpy as np
import pytest

from hypermap_lite.pareto import attainment_surface, non_dominated

STEEP = np.array([[1.0, 5.0], [2.0, 1.0]])
FLAT = np.array([[1.0, 2.0], [6.0, 1.0]])
SINGLE = np.array([[3.0, 3.0]])


def attaining(fronts, point):
    """Return how many fronts attain a point, by the definition."""
    return sum(bool((front <= point).all(axis=1).any()) for front in fronts)


def random_fronts(seed):
    rng = np.random.default_rng(seed)
    return [rng.integers(0, 6, size=(rng.integers(1, 7), 2)).astype(float) for _ in range(rng.integers(1, 8))]


@pytest.mark.parametrize(
    ("fraction", "surface"),
    [
        pytest.param(0.1, [[1, 2], [2, 1]], id="best"),
        pytest.param(0.5, [[1, 5], [2, 2], [6, 1]], id="median"),
        pytest.param(1.0, [[3, 3]], id="worst"),
    ],
)
def test_surfaces_of_three_fronts_by_hand(fraction, surface):
    assert attainment_surface([STEEP, FLAT, SINGLE], fraction).tolist() == surface


@pytest.mark.parametrize("fraction", [0.01, 0.25, 0.5, 1.0])
def test_surface_of_one_front_is_that_front(fraction):
    assert attainment_surface([STEEP[::-1]], fraction).tolist() == STEEP.tolist()


def test_dominated_and_repeated_points_change_nothing():
    more = np.vstack([STEEP, STEEP, [[7.0, 7.0]]])
    assert attainment_surface([more, FLAT], 1.0).tolist() == attainment_surface([STEEP, FLAT], 1.0).tolist()


def test_fraction_is_rounded_up_to_whole_fronts():
    fronts = [np.array([[i, 0.0]]) for i in range(100)]
    assert [attainment_surface(fronts, f)[0, 0] for f in (0.07, 0.0701, 0.25, 0.75)] == [6, 7, 24, 74]


@pytest.mark.parametrize("seed", range(20))
def test_surface_bounds_what_enough_fronts_attain(seed):
    fronts = random_fronts(seed)
    for n_needed in range(1, len(fronts) + 1):
        surface = attainment_surface(fronts, n_needed / len(fronts))
        for point in np.ndindex(7, 7):
            assert (attaining([surface], point) == 1) == (attaining(fronts, point) >= n_needed)


@pytest.mark.parametrize("seed", range(5))
def test_more_fronts_attain_less(seed):
    fronts = random_fronts(seed)
    surfaces = [attainment_surface(fronts, fraction) for fraction in (0.25, 0.5, 0.75, 1.0)]
    for better, worse in pairwise(surfaces):
        assert all(attaining([better], point) for point in worse)


@pytest.mark.parametrize("seed", range(5))
def test_surface_is_sorted_and_holds_no_dominated_point(seed):
    surface = attainment_surface(random_fronts(seed), 0.5)
    assert non_dominated(surface).all()
    assert (np.diff(surface[:, 0]) > 0).all()


def test_front_without_points_attains_nothing_but_counts():
    fronts = [STEEP, np.full((2, 2), np.nan)]
    assert attainment_surface(fronts, 0.5).tolist() == STEEP.tolist()
    assert attainment_surface(fronts, 1.0).shape == (0, 2)


@pytest.mark.parametrize("fraction", [0.0, -1.0, 1.1, np.nan])
def test_fraction_out_of_range_is_an_error(fraction):
    with pytest.raises(ValueError, match="`fraction` above 0 and at most 1"):
        attainment_surface([STEEP], fraction)


@pytest.mark.parametrize(
    ("fronts", "message"),
    [([], "at least one front"), ([np.zeros((2, 3))], r"two objectives. Got front.shape=\(2, 3\)"), ([[1.0]], "shape")],
)
def test_fronts_of_another_form_are_an_error(fronts, message):
    with pytest.raises(ValueError, match=message):
        attainment_surface(fronts, 0.5)
