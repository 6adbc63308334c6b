"""The space as a whole."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace
from tests.strategies import spaces

SMALL = SearchSpace((IntegerParameter(name="n", low=1, high=3), CategoricalParameter(name="c", values=("a", "b"))))


@given(spaces(), st.integers(0, 2**32))
def test_configurations_encode_and_decode_exactly(space: SearchSpace, seed: int) -> None:
    configurations = space.decode(space.sample_uniform(7, np.random.default_rng(seed)))
    assert all(space.contains(c) for c in configurations)
    assert space.decode(space.encode(configurations)) == configurations


@given(spaces(), st.integers(0, 2**32))
def test_snapping_twice_changes_nothing(space: SearchSpace, seed: int) -> None:
    X = space.sample_uniform(7, np.random.default_rng(seed))
    assert np.array_equal(space.snap(X), X)


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize(("low", "high"), [(0.05, 2), (0.25, 1.3), (2, 15), (1e-5, 0.7), (288.5, 303.25), (1e3, 1e7)])
def test_a_point_and_its_configuration_have_the_same_key(low: float, high: float, log: bool) -> None:
    space = SearchSpace((RealParameter(name="x", low=low, high=high, log=log),))
    X = np.random.default_rng(0).integers(0, 2**30, (20_000, 1)) / 2**30
    X[:2] = [[0.0], [1 - 1e-16]]
    told = space.encode(space.decode(X))
    assert space.keys(X) == space.keys(told)
    assert not space.unseen(X, space.keys(told)).any()
    names = np.frombuffer(b"".join(space.keys(X)))
    assert np.abs(names - X[:, 0]).max() < 1e-10


def test_a_finite_space_counts_and_lists_its_configurations() -> None:
    assert SMALL.n_configurations == 6
    configurations = SMALL.decode(SMALL.enumerate())
    assert configurations[:3] == [{"n": 1, "c": "a"}, {"n": 1, "c": "b"}, {"n": 2, "c": "a"}]
    assert len({tuple(c.items()) for c in configurations}) == 6


def test_a_real_parameter_makes_the_space_infinite() -> None:
    assert SearchSpace((RealParameter(name="r", low=0, high=1),)).n_configurations == math.inf


def test_unseen_drops_known_points_and_repeats() -> None:
    X = SMALL.encode([{"n": 1, "c": "a"}, {"n": 2, "c": "a"}, {"n": 2, "c": "a"}, {"n": 3, "c": "b"}])
    assert SMALL.unseen(X, SMALL.keys(X[:1])).tolist() == [False, True, False, True]


def test_no_configuration_encodes_to_an_empty_array() -> None:
    space = SearchSpace(
        (*SMALL.parameters, OrdinalParameter(name="o", values=(1.0, 2.0)), RealParameter(name="r", low=0, high=1))
    )
    assert space.encode([]).shape == (0, 4)
    assert space.decode(np.empty((0, 4))) == []


def test_the_default_needs_every_parameter() -> None:
    full = SearchSpace((IntegerParameter(name="n", low=1, high=3, default=2),))
    partial = SearchSpace((*full.parameters, RealParameter(name="r", low=0, high=1)))
    assert full.default == {"n": 2}
    assert partial.default is None


def test_contains_wants_exactly_the_parameters() -> None:
    assert SMALL.contains({"n": 1, "c": "b"})
    assert not SMALL.contains({"n": 1})
    assert not SMALL.contains({"n": 1, "c": "b", "d": 0})
    assert not SMALL.contains({"n": 4, "c": "b"})


def test_neighbouring_integers_of_a_huge_range_are_different_points() -> None:
    for log in (False, True):
        space = SearchSpace((IntegerParameter(name="n", low=1, high=10**12, log=log),))
        a, b = space.keys(space.encode([{"n": 999_999_999_998}, {"n": 999_999_999_999}]))
        assert a != b


@given(spaces(), st.integers(0, 2**32), st.integers(0, 40))
def test_unseen_compares_every_pair_of_keys(space: SearchSpace, seed: int, n_seen: int) -> None:
    rng = np.random.default_rng(seed)
    X = np.round(space.sample_uniform(40, rng), 1)
    seen = space.keys(X[rng.integers(0, 40, n_seen)])
    known, expected = set(seen), []
    for key in space.keys(X):
        expected.append(key not in known)
        known.add(key)
    assert space.unseen(X, seen).tolist() == expected
