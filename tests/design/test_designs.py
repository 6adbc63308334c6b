"""What holds for every initial design."""

import numpy as np
import pytest

from hypermap_lite.design import DESIGNS
from hypermap_lite.priors import AsJoint, GaussianPrior, ProductPrior
from hypermap_lite.space import CategoricalParameter, IntegerParameter, RealParameter, SearchSpace

MIXED = SearchSpace(
    (
        RealParameter(name="r", low=0, high=1),
        IntegerParameter(name="n", low=0, high=4),
        CategoricalParameter(name="c", values=("a", "b", "c")),
    )
)
FINITE = SearchSpace(MIXED.parameters[1:])
every_design = pytest.mark.parametrize("name", list(DESIGNS))


def points(name: str, space: SearchSpace, n: int, seed: int = 0) -> np.ndarray:
    return DESIGNS[name]().points(space, ProductPrior(space.dimension), n, np.random.default_rng(seed))


@every_design
def test_points_are_legal_and_different(name: str) -> None:
    X = points(name, MIXED, 20)
    assert np.array_equal(MIXED.snap(X), X)
    assert MIXED.unseen(X, ()).all()
    assert 1 <= len(X) <= 20


@every_design
def test_a_finite_space_is_exhausted_without_repeats(name: str) -> None:
    X = points(name, FINITE, 100)
    assert len(X) == 15
    assert FINITE.unseen(X, ()).all()


@every_design
def test_the_same_generator_gives_the_same_points(name: str) -> None:
    assert np.array_equal(points(name, MIXED, 9, seed=3), points(name, MIXED, 9, seed=3))


@pytest.mark.parametrize("name", [n for n in DESIGNS if n != "grid"])
@pytest.mark.parametrize("n", [1, 2, 13])
def test_there_are_as_many_as_asked_for(name: str, n: int) -> None:
    assert points(name, MIXED, n).shape == (n, 3)


def test_a_latin_hypercube_has_one_point_in_every_slice() -> None:
    square = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))
    X = points("latin_hypercube", square, 10)
    assert np.array_equal(np.sort(np.floor(X * 10), axis=0), np.repeat(np.arange(10.0)[:, None], 2, axis=1))


def test_sobol_points_balance_every_half() -> None:
    square = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))
    assert np.array_equal((points("sobol", square, 16) < 0.5).sum(axis=0), [8, 8])


def test_a_grid_is_full_and_includes_the_bounds() -> None:
    square = SearchSpace((RealParameter(name="a", low=0, high=1), RealParameter(name="b", low=0, high=1)))
    X = points("grid", square, 10)
    assert {tuple(x) for x in X} == {(a, b) for a in (0, 0.5, 1) for b in (0, 0.5, 1)}


def test_a_grid_over_a_huge_log_range_is_spread_by_decades() -> None:
    space = SearchSpace((IntegerParameter(name="n", low=1, high=10**8, log=True),))
    values = sorted(c["n"] for c in space.decode(points("grid", space, 3)))
    assert values[0] == 1
    assert 5_000 < values[1] < 20_000
    assert values[2] == 10**8


def test_prior_sampling_draws_from_the_prior() -> None:
    space = SearchSpace((RealParameter(name="a", low=0, high=10),))
    prior = ProductPrior(1, (((0,), AsJoint(GaussianPrior(mean=7, std=0.1).on(space.parameters[0]))),))
    X = DESIGNS["prior_sampling"]().points(space, prior, 200, np.random.default_rng(0))
    assert X.mean() == pytest.approx(0.7, abs=0.01)
