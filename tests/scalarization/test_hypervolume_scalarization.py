"""The scalarization behind hypervolume improvement for many objectives."""

import math

import numpy as np
import pytest

from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.scalarization.hypervolume import HypervolumeScalarization, random_direction


@pytest.mark.parametrize("m", [2, 4])
def test_its_mean_over_directions_is_the_hypervolume(m: int) -> None:
    Y = np.random.default_rng(0).random((6, m)) ** 2
    corner = np.full(m, 1.1)
    scalarization, rng = HypervolumeScalarization(corner=corner), np.random.default_rng(1)
    best = [-scalarization(Y, random_direction(m, rng)).min() for _ in range(20_000)]
    constant = math.pi ** (m / 2) / (2**m * math.gamma(m / 2 + 1))
    assert constant * np.mean(best) == pytest.approx(hypervolume(Y, corner), rel=0.03)


def test_beyond_the_reference_point_less_is_better_still() -> None:
    scalarization = HypervolumeScalarization(corner=np.ones(2))
    values = scalarization(np.array([[3.0, 0.0], [2.0, 0.0], [0.9, 0.0]]), np.full(2, math.sqrt(0.5)))
    assert (np.diff(values) < 0).all()


def test_its_gradient_agrees_with_finite_differences() -> None:
    scalarization, rng = HypervolumeScalarization(corner=np.ones(4)), np.random.default_rng(2)
    Y, weights = 1.5 * rng.random((20, 4)), random_direction(4, rng)
    for k, e in enumerate(1e-6 * np.eye(4)):
        numeric = (scalarization(Y + e, weights) - scalarization(Y - e, weights)) / 2e-6
        assert scalarization.gradient(Y, weights)[:, k] == pytest.approx(numeric, rel=1e-5, abs=1e-7)


def test_directions_have_length_one_and_no_side() -> None:
    directions = np.array([random_direction(3, np.random.default_rng(i)) for i in range(3000)])
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0)
    assert (directions > 0).all()
    assert directions.mean(axis=0) == pytest.approx(0.5, abs=0.02)  # of a uniform direction in three dimensions
