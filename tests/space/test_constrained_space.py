"""A space with constraints."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.space import Constraint, IntegerParameter, RealParameter, SearchSpace
from hypermap_lite.space.walk import spread, walk
from tests.constrained import SPACES, space_of

every_space = pytest.mark.parametrize("name", SPACES)


@every_space
def test_draws_are_allowed(name: str) -> None:
    space = space_of(name)
    X = space.sample_uniform(3, np.random.default_rng(0))
    assert len(X) == 3
    assert all(space.contains(configuration) for configuration in space.decode(X))


@given(st.sampled_from(list(SPACES)), st.integers(0, 2**32))
def test_a_point_is_allowed_if_its_configuration_is(name: str, seed: int) -> None:
    space = space_of(name)
    X = np.random.default_rng(seed).random((9, space.dimension))
    contained = [space.contains(configuration) for configuration in space.decode(X)]
    assert space.is_allowed(X).tolist() == contained
    assert space.is_allowed(space.snap(X)).tolist() == contained


def test_draws_are_those_of_the_sampler_that_are_allowed() -> None:
    space = space_of("half")
    rng = np.random.default_rng(1)
    X = space.draw(4000, lambda k: rng.beta(2, 1, size=(k, 2)))
    # of the density 4 a b on a + b <= 1 the mean is int 4 a^2 b / int 4 a b = (1/15) / (1/6)
    assert X.mean(axis=0) == pytest.approx([0.4, 0.4], abs=0.01)


def test_without_constraints_a_sampler_is_called_once() -> None:
    space = SearchSpace((RealParameter(name="a", low=0, high=1),))
    assert space.draw(3, lambda k: np.full((k, 1), 0.25)).tolist() == [[0.25]] * 3
    assert space.keep_allowed(np.zeros((2, 1))).shape == (2, 1)
    assert space.is_allowed(np.zeros((2, 1))).all()


@pytest.mark.parametrize(("name", "count"), [("sum", 37 - 2 * 6), ("single", 1), ("half", math.inf)])
def test_allowed_configurations_are_counted(name: str, count: float) -> None:
    space = space_of(name)
    everything = [(k, m, 9 - k - m) for k in range(6) for m in range(6) if 0 <= 9 - k - m <= 5]
    expected = len(everything) if name == "sum" else count
    assert space.n_configurations == expected


def test_a_finite_space_lists_what_is_allowed_in_order() -> None:
    configurations = space_of("sum").decode(space_of("sum").enumerate())
    expected = [(k, m, 9 - k - m) for k in range(6) for m in range(6) if 0 <= 9 - k - m <= 5]
    assert [tuple(configuration.values()) for configuration in configurations] == expected


def test_a_finite_space_that_is_too_large_to_list_is_counted_without_constraints() -> None:
    parameters = tuple(IntegerParameter(name=name, low=0, high=9999) for name in "ab")
    space = SearchSpace(parameters, (Constraint("a < b", parameters),))
    assert space.n_configurations == 10**8
    assert len(space.known_point) == 1


def test_a_space_without_allowed_points_has_none() -> None:
    parameters = (IntegerParameter(name="a", low=0, high=9),)
    space = SearchSpace(parameters, (Constraint("a > 9", parameters),))
    assert space.n_configurations == 0
    assert space.enumerate().shape == (0, 1)
    assert space.known_point.shape == (0, 1)
    assert walk(space, space.known_point, 3, np.random.default_rng(0)).shape == (0, 1)


def test_an_allowed_default_is_a_known_point_where_draws_find_none() -> None:
    parameters = (
        RealParameter(name="a", low=0, high=1, default=0.5),
        RealParameter(name="b", low=0, high=1, default=0.5),
    )
    space = SearchSpace(parameters, (Constraint("a == b and a == 0.5", parameters),))
    assert space.known_point.tolist() == [[0.5, 0.5]]


def test_violated_constraints_are_named_by_their_number() -> None:
    space = space_of("mixed")
    assert space.violated({"a": 1.0, "n": 11, "o": 1.0, "c": "x"}) == [0, 1, 2]
    assert space.violated({"a": 0.1, "n": 8, "o": 1.0, "c": "x"}) == []


@every_space
def test_a_walk_finds_different_allowed_points_and_repeats_itself(name: str) -> None:
    space = space_of(name)
    a, b = (spread(space, 20, np.random.default_rng(3)) for _ in range(2))
    assert np.array_equal(a, b)
    assert len(a) == min(20, space.n_configurations)
    assert space.is_allowed(a).all()
    assert space.unseen(a, ()).all()


def test_the_share_of_allowed_points_is_estimated() -> None:
    assert space_of("half").share_allowed() == pytest.approx(0.5, abs=0.02)


def test_it_can_be_pickled() -> None:
    space = pickle.loads(pickle.dumps(space_of("mixed")))
    assert space == space_of("mixed")
    assert space != SearchSpace(space.parameters)
