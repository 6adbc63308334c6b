"""Permutation parameters."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.errors import ScenarioError
from hypermap_lite.space import Constraint, PermutationParameter
from hypermap_lite.space.permutation import EMBEDDINGS, orders_of, ranks_of

THREE = PermutationParameter(name="order", size=3)

sizes = st.integers(2, 15)


def distance(kernel: str, a: tuple[int, ...], b: tuple[int, ...]) -> float:
    parameter = PermutationParameter(name="order", size=len(a), kernel=kernel)
    first, second = parameter.embed(parameter.encode([a, b]))
    return float(((first - second) ** 2).sum())


@given(sizes.flatmap(lambda n: st.lists(st.permutations(range(n)), min_size=1, max_size=6)))
def test_orders_encode_and_decode_exactly(orders: list[list[int]]) -> None:
    parameter = PermutationParameter(name="order", size=len(orders[0]))
    values = [tuple(order) for order in orders]
    assert parameter.decode(parameter.encode(values)) == values
    assert [parameter.parse(parameter.format(value)) for value in values] == values


@given(sizes, st.lists(st.floats(0, 1), min_size=1, max_size=9))
def test_every_code_is_one_of_a_permutation(n: int, codes: list[float]) -> None:
    parameter = PermutationParameter(name="order", size=n)
    values = parameter.decode(np.array(codes))
    assert all(parameter.contains(value) for value in values)
    assert np.array_equal(parameter.snap(np.array(codes)), parameter.encode(values))
    assert np.array_equal(parameter.level_index(parameter.encode(values)), ranks_of(np.array(values)))


def test_no_codes_are_those_of_no_permutations() -> None:
    assert THREE.decode(np.empty(0)) == []
    assert THREE.snap(np.empty(0)).shape == (0,)


def test_ranks_are_lexicographic() -> None:
    everything = np.array(list(permutations(range(5))))
    assert np.array_equal(ranks_of(everything), np.arange(120))
    assert np.array_equal(orders_of(np.arange(120), 5), everything)
    assert THREE.decode(np.linspace(0.01, 0.99, 6)) == list(permutations(range(3)))


def test_the_last_of_the_largest_permutations_is_told_from_the_one_before() -> None:
    parameter = PermutationParameter(name="order", size=15)
    last = tuple(range(14, -1, -1))
    before = (*last[:-2], last[-1], last[-2])
    assert parameter.decode(parameter.encode([last, before])) == [last, before]
    assert parameter.decode(np.array([1.0, 0.0])) == [last, tuple(range(15))]


@pytest.mark.parametrize("value", [(0, 1), (0, 1, 1), (0, 1, 3), (0, 1, True), (0.0, 1, 2), "0 1 2", 3, None])
def test_illegal_values_are_not_contained(value: object) -> None:
    assert not THREE.contains(value)


def test_tuples_and_lists_are_contained() -> None:
    assert THREE.contains((2, 0, 1))
    assert THREE.contains([2, 0, 1])
    assert THREE.encode([[2, 0, 1]]).tolist() == THREE.encode([(2, 0, 1)]).tolist()


@pytest.mark.parametrize("text", ["0 1", "0 1 2 2", "a b c", "0,1,2", ""])
def test_other_texts_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="which is not the integers from 0 to 2 in any order"):
        THREE.parse(text)


@pytest.mark.parametrize(("size", "kernel"), [(1, "kendall"), (16, "kendall"), (3, "spaerman")])
def test_illegal_options_are_refused(size: int, kernel: str) -> None:
    with pytest.raises(ScenarioError, match=r"elements|Did you mean 'spearman'"):
        PermutationParameter(name="order", size=size, kernel=kernel)


@pytest.mark.parametrize(
    ("kernel", "a", "b", "expected"),
    [
        # places of the elements of (1, 0, 2) are (1, 0, 2): squares 1 + 1, at most 8
        pytest.param("spearman", (0, 1, 2), (1, 0, 2), 2 / 8, id="spearman"),
        # places of the elements of (2, 0, 1) are (1, 2, 0): squares 1 + 1 + 4
        pytest.param("spearman", (0, 1, 2), (2, 0, 1), 6 / 8, id="spearman of a rotation"),
        pytest.param("spearman", (0, 1, 2, 3), (3, 2, 1, 0), 1.0, id="spearman of the reverse"),
        pytest.param("kendall", (0, 1, 2), (1, 0, 2), 1 / 3, id="kendall"),
        pytest.param("kendall", (0, 1, 2), (2, 0, 1), 2 / 3, id="kendall of a rotation"),
        pytest.param("kendall", (0, 1, 2, 3), (3, 2, 1, 0), 1.0, id="kendall of the reverse"),
        pytest.param("hamming", (0, 1, 2), (1, 0, 2), 2 / 3, id="hamming"),
        pytest.param("hamming", (0, 1, 2), (2, 0, 1), 1.0, id="hamming of a rotation"),
        pytest.param("hamming", (0, 1, 2), (0, 1, 2), 0.0, id="hamming of itself"),
    ],
)
def test_distances_are_those_counted_by_hand(kernel: str, a: tuple, b: tuple, expected: float) -> None:
    assert distance(kernel, a, b) == pytest.approx(expected)


@pytest.mark.parametrize("kernel", EMBEDDINGS)
@pytest.mark.parametrize("lengthscale", [0.05, 0.5, 5.0])
def test_every_kernel_is_positive_definite(kernel: str, lengthscale: float) -> None:
    parameter = PermutationParameter(name="order", size=4, kernel=kernel)
    points = parameter.embed(parameter.level_codes())
    distances = ((points[:, None] - points) ** 2).sum(axis=2)
    assert distances.max() == pytest.approx(1.0)
    assert np.linalg.eigvalsh(np.exp(-distances / lengthscale)).min() > -1e-10


def test_positions_are_the_places_of_the_elements() -> None:
    assert THREE.positions(THREE.encode([(2, 0, 1)])).tolist() == [[1, 2, 0]]


def test_neighbours_are_swaps_and_moves() -> None:
    parameter = PermutationParameter(name="order", size=4)
    (code,) = parameter.encode([(0, 1, 2, 3)])
    found = set(parameter.decode(parameter.neighbours(code)))
    swaps = {(1, 0, 2, 3), (2, 1, 0, 3), (3, 1, 2, 0), (0, 2, 1, 3), (0, 3, 2, 1), (0, 1, 3, 2)}
    moves = {(1, 2, 0, 3), (1, 2, 3, 0), (2, 0, 1, 3), (3, 0, 1, 2), (0, 2, 3, 1), (0, 3, 1, 2)}
    assert found == swaps | moves
    assert len(parameter.neighbours(code)) == 12


def test_random_swaps_change_as_many_places_as_they_may() -> None:
    parameter = PermutationParameter(name="order", size=8)
    codes = np.full(300, parameter.encode([tuple(range(8))])[0])
    swapped = parameter.orders(parameter.swap(codes, np.repeat([0, 1, 2], 100), np.random.default_rng(0)))
    n_moved = (swapped != np.arange(8)).sum(axis=1)
    assert (n_moved[:100] == 0).all()
    assert (n_moved[100:200] == 2).all()
    assert set(n_moved[200:]) <= {0, 3, 4}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("order[0] == 2", [False, True]),
        ("position(order, 2) < position(order, 0)", [False, True]),
        ("order[0] + order[1] == 1 and position(order, 2) == 2", [True, False]),
    ],
)
def test_constraints_speak_of_elements_and_places(text: str, expected: list[bool]) -> None:
    columns = {"order": np.array([(1, 0, 2), (2, 0, 1)], dtype=float)}
    assert Constraint(text, (THREE,)).holds(columns, 2).tolist() == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("order < 3", r"'order' is a permutation, not a number\n  allowed: order\[0\]"),
        ("order[3] == 0", "'3' is no place and no element of 'order'\n  allowed: 0 to 2"),
        ("order[-1] == 0", "'-1' is no place"),
        ("position(order, 5) == 0", "'5' is no place"),
        ("position(order) == 0", "there is no function 'position'"),
        ("other[0] == 0", "'other' is no permutation"),
    ],
)
def test_other_uses_of_a_permutation_are_refused(text: str, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        Constraint(text, (THREE,))
