"""Scrambled Sobol points are SciPy's, and normal draws are normal."""

import numpy as np
import pytest
from scipy.stats import qmc

from hypermap_lite.quasi_random import MAX_DIMENSION, quasi_normal, sobol_points

SHAPES = [(1, 1), (1, 3), (2, 1), (8, 1), (20, 12), (32, 60), (32, 64), (32, 65), (64, 130), (1000, 6), (2048, 2)]


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize(("n", "dimension"), SHAPES)
def test_points_and_what_is_left_of_the_generator_are_those_of_scipy(n: int, dimension: int, seed: int) -> None:
    ours, theirs = np.random.default_rng(seed), np.random.default_rng(seed)
    for _ in range(2):
        expected = qmc.Sobol(dimension, scramble=True, rng=theirs).random_base2(max(n - 1, 0).bit_length())[:n]
        assert np.array_equal(sobol_points(n, dimension, ours), expected)
    assert ours.random() == theirs.random()


def test_no_points_are_an_empty_array() -> None:
    assert sobol_points(0, 3, np.random.default_rng(0)).shape == (0, 3)


def test_largest_dimension_is_that_of_scipy() -> None:
    assert MAX_DIMENSION == qmc.Sobol.MAXDIM


def test_normal_draws_are_standard_normal_beyond_the_dimensions_of_sobol() -> None:
    draws = quasi_normal(64, 21_300, np.random.default_rng(0))
    assert draws.shape == (64, 21_300)
    assert draws[:, -50:].std() == pytest.approx(1.0, abs=0.05)
    assert draws[:, :50].mean(axis=0) == pytest.approx(np.zeros(50), abs=0.06)
