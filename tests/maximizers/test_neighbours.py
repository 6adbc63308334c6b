"""One-exchange steps."""

import numpy as np
import pytest

from hypermap_lite.maximizers.neighbours import axis_neighbours, climb, neighbours
from hypermap_lite.space import CategoricalParameter, IntegerParameter, RealParameter, SearchSpace

SPACE = SearchSpace(
    (
        RealParameter(name="r", low=0, high=1),
        IntegerParameter(name="n", low=0, high=99),
        CategoricalParameter(name="c", values=("a", "b", "c")),
    )
)


def test_steps_go_in_both_directions() -> None:
    real, integer = SPACE.parameters[:2]
    around = axis_neighbours(real, 0.5)
    assert (around < 0.5).sum() == (around > 0.5).sum() == 5
    values = integer.decode(axis_neighbours(integer, float(integer.encode([50])[0])))
    assert sorted(values) == [34, 40, 46, 47, 49, 51, 53, 54, 60, 66]


def test_steps_stay_in_the_space() -> None:
    integer = SPACE.parameters[1]
    assert min(integer.decode(axis_neighbours(integer, float(integer.encode([0])[0])))) == 1
    assert axis_neighbours(SPACE.parameters[0], 0.0).min() == 0


def test_all_other_categories_are_neighbours() -> None:
    categorical = SPACE.parameters[2]
    assert categorical.decode(axis_neighbours(categorical, 0.5)) == ["a", "c"]


@pytest.mark.parametrize("log", [False, True])
def test_a_very_large_integer_range_has_few_neighbours_near_and_far(log: bool) -> None:
    parameter = IntegerParameter(name="n", low=1, high=10**9, log=log)
    values = np.array(parameter.decode(axis_neighbours(parameter, float(parameter.encode([50_000])[0]))))
    assert len(values) < 50
    assert {49_999, 50_001} <= set(values)
    assert values.max() > 1e8 if not log else values.max() > 3e5


@pytest.mark.parametrize("log", [False, True])
def test_climbing_finds_one_integer_among_a_billion(log: bool) -> None:
    space = SearchSpace((IntegerParameter(name="n", low=1, high=10**9, log=log),))
    target = space.encode([{"n": 123_456_789}])[0]
    (x,), _ = climb(space, lambda X: -np.abs(X - target).sum(axis=1), np.array([[0.5]]), np.array([True]))
    assert space.decode(x[None])[0]["n"] == 123_456_789


def test_neighbours_differ_along_one_axis() -> None:
    x = SPACE.encode([{"r": 0.5, "n": 50, "c": "b"}])[0]
    around = neighbours(SPACE, x, np.array([False, True, True]))
    assert ((around != x).sum(axis=1) == 1).all()
    assert len(around) == 12


def test_climbing_ends_at_the_top() -> None:
    target = SPACE.encode([{"r": 0.5, "n": 77, "c": "a"}])[0]

    def distance(X: np.ndarray) -> np.ndarray:
        return -np.abs(X - target).sum(axis=1)

    start = SPACE.encode([{"r": 0.5, "n": 3, "c": "c"}])[0]
    (x,), (score,) = climb(SPACE, distance, start[None], np.array([False, True, True]))
    assert x == pytest.approx(target)
    assert score == pytest.approx(0.0)


def test_a_climb_ends_where_its_best_step_gains_no_more_than_the_tolerance() -> None:
    space = SearchSpace((RealParameter(name="x", low=0, high=1),))
    calls = []

    def hill(X: np.ndarray) -> np.ndarray:
        calls.append(len(X))
        return -((X[:, 0] - 0.6180339) ** 2)

    start, axes = np.array([[0.1]]), np.array([True])
    exact, _ = climb(space, hill, start, axes)
    n_exact = len(calls)
    rough, heights = climb(space, hill, start, axes, tolerance=1e-4)
    assert abs(exact[0, 0] - 0.6180339) < 1e-3
    assert abs(rough[0, 0] - 0.6180339) < 2e-2
    assert len(calls) - n_exact < n_exact
    assert heights[0] == hill(rough)[0]
