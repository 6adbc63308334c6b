"""A permutation parameter: an order of some elements."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from typing import ClassVar, Final

import numpy as np

from hypermap_lite.errors import ScenarioError, nearest
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.typing import FloatArray, IntArray, Rng, Value

MAX_SIZE: Final = 15
"""Elements of the largest permutation: the bins of 15! levels are still told apart by floats."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PermutationParameter(Parameter):
    """All orders of the elements 0, 1, ..., size - 1, as tuples: the element that comes first, second, ...

    Its n! levels are the permutations in lexicographic order, each with a bin of equal width, so that a code names a
    permutation; that close codes begin alike is all they have in common. Models compare permutations by a distance
    instead: the squared Euclidean distance of `embed`, between 0 and 1.
    """

    size: int
    """Number of elements."""

    kernel: str = "spearman"
    """Distance of two permutations: one of `EMBEDDINGS`."""

    is_ordered: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not isinstance(self.size, int) or not 2 <= self.size <= MAX_SIZE:
            problem = f"'{self.name}' is an order of {self.size} elements"
            raise ScenarioError("$.values[0]", problem, allowed=f"an integer from 2 to {MAX_SIZE}")
        if self.kernel not in EMBEDDINGS:
            problem, hint = f"unknown kernel {self.kernel!r}", nearest(str(self.kernel), EMBEDDINGS)
            raise ScenarioError("$.kernel", problem, allowed=", ".join(EMBEDDINGS), hint=hint)
        if isinstance(self.default, list):
            object.__setattr__(self, "default", tuple(self.default))

    @property
    def n_levels(self) -> int:
        """Number of permutations, size!."""
        return math.factorial(self.size)

    def contains(self, value: object) -> bool:
        """Tell whether a value is a permutation of the elements, as a tuple or a list."""
        if not isinstance(value, tuple | list) or not all(type(element) is int for element in value):
            return False
        return sorted(value) == list(range(self.size))

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"the integers from 0 to {self.size - 1} in any order"

    def encode(self, values: Sequence[Value]) -> FloatArray:
        """Return the codes of n permutations, shape (n,)."""
        orders = np.array(values, dtype=np.int64).reshape(len(values), self.size)
        return self.codes_of_levels(ranks_of(orders))

    def decode(self, codes: FloatArray) -> list[Value]:
        """Return the permutations whose bins hold the n codes, each a tuple."""
        return [tuple(order) for order in self.orders(codes).tolist()]

    def orders(self, codes: FloatArray) -> IntArray:
        """Return the permutations whose bins hold the n codes, shape (n, size)."""
        return orders_of(self.level_index(codes), self.size)

    def level_index(self, codes: FloatArray) -> IntArray:
        """Return the lexicographic rank of the permutation of each code, shape (n,)."""
        return np.clip(np.floor(np.asarray(codes) * self.n_levels), 0, self.n_levels - 1).astype(np.int64)

    def codes_of_levels(self, levels: IntArray) -> FloatArray:
        """Return the middles of the bins of some ranks, shape (n,)."""
        return (np.asarray(levels) + 0.5) / self.n_levels

    def bins_of_levels(self, levels: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return lower and upper edges of the bins of some ranks, both shape (n,)."""
        return np.asarray(levels) / self.n_levels, (np.asarray(levels) + 1) / self.n_levels

    def format(self, value: Value) -> str:
        """Return a permutation as text: its elements, separated by blanks."""
        return " ".join(map(str, value)) if isinstance(value, tuple | list) else str(value)

    def parse(self, text: str) -> Value:
        """Return the permutation that a text stands for.

        Raises
        ------
        ValueError
            If it is none of these elements.
        """
        try:
            order = tuple(int(word) for word in text.split())
        except ValueError:
            order = ()
        if not self.contains(order):
            raise ValueError(f"{self.name} is {text!r}, which is not {self.allowed()}")
        return order

    def positions(self, codes: FloatArray) -> FloatArray:
        """Return the place of each element, from 0, in the permutations of n codes, shape (n, size)."""
        return np.argsort(self.orders(codes), axis=1).astype(float)

    def embed(self, codes: FloatArray) -> FloatArray:
        """Return points whose squared distances are the distances of the permutations of n codes, shape (n, k)."""
        return EMBEDDINGS[self.kernel](np.argsort(self.orders(codes), axis=1))

    def neighbours(self, code: float) -> FloatArray:
        """Return the codes of all permutations one swap of two elements, or one move of one, away, shape (k,)."""
        order = self.orders(np.array([code]))[0]
        return self.codes_of_levels(np.unique(ranks_of(order[_exchanges(self.size)])))

    def swap(self, codes: FloatArray, n_swaps: IntArray, rng: Rng) -> FloatArray:
        """Return the codes of n permutations after so many random swaps of two places each, shape (n,)."""
        orders = self.orders(codes)
        for k in range(int(n_swaps.max(initial=0))):
            rows = np.flatnonzero(n_swaps > k)
            i = rng.integers(self.size, size=len(rows))
            j = (i + rng.integers(1, self.size, size=len(rows))) % self.size
            orders[rows, i], orders[rows, j] = orders[rows, j], orders[rows, i]
        return self.codes_of_levels(ranks_of(orders))


@cache
def _exchanges(size: int) -> IntArray:
    """Return the places, in an order, of what stands where after one swap of two elements or move of one, (k, size)."""
    places = np.arange(size)
    swapped, moved = [], []
    for i, j in combinations(range(size), 2):
        other = places.copy()
        other[[i, j]] = places[[j, i]]
        swapped.append(other)
        for start, end in ((i, j), (j, i)):
            moved.append(np.insert(np.delete(places, start), end, start))
    exchanges = np.unique(np.array([*swapped, *moved]), axis=0)
    exchanges.setflags(write=False)  # all who ask share it
    return exchanges


def orders_of(ranks: IntArray, size: int) -> IntArray:
    """Return the permutations of some lexicographic ranks, by their digits in the factorial number system [1]_.

    Returns
    -------
    IntArray
        Shape (n, size): the element that comes first, second, ...

    References
    ----------
    .. [1] Knuth. The Art of Computer Programming, vol. 2, sec. 3.3.2, algorithm P. Addison-Wesley, 1997.
    """
    orders = np.empty((len(ranks), size), dtype=np.int64)
    rest, left = np.array(ranks, dtype=np.int64), np.tile(np.arange(size), (len(ranks), 1))
    for place in range(size):
        digit, rest = np.divmod(rest, math.factorial(size - 1 - place))
        orders[:, place] = np.take_along_axis(left, digit[:, None], axis=1)[:, 0]
        left = left[np.arange(left.shape[1]) != digit[:, None]].reshape(len(ranks), size - 1 - place)
    return orders


def ranks_of(orders: IntArray) -> IntArray:
    """Return the lexicographic ranks of n permutations, shape (n, size) to (n,); the inverse of `orders_of`."""
    size = orders.shape[1]
    ranks = np.zeros(len(orders), dtype=np.int64)
    for place in range(size):
        n_smaller = (orders[:, place + 1 :] < orders[:, place, None]).sum(axis=1)  # Lehmer's code
        ranks += n_smaller * math.factorial(size - 1 - place)
    return ranks


def spearman(positions: IntArray) -> FloatArray:
    """Embed for the sum of squared differences of places, relative to that of reversed orders; shape (n, size)."""
    size = positions.shape[1]
    return positions / math.sqrt(size * (size**2 - 1) / 3)


def kendall(positions: IntArray) -> FloatArray:
    """Embed for the share of pairs of elements that stand in the other order; shape (n, size (size - 1) / 2)."""
    i, j = np.triu_indices(positions.shape[1], 1)
    return np.sign(positions[:, j] - positions[:, i]) / (2 * math.sqrt(len(i)))


def hamming(positions: IntArray) -> FloatArray:
    """Embed for the share of elements that stand at another place; shape (n, size^2)."""
    size = positions.shape[1]
    is_there = positions[:, :, None] == np.arange(size)
    return is_there.reshape(len(positions), size * size) / math.sqrt(2 * size)


EMBEDDINGS: Final[Mapping[str, Callable[[IntArray], FloatArray]]] = {
    "spearman": spearman,
    "kendall": kendall,
    "hamming": hamming,
}
"""JSON name of each distance of permutations, given by the places of the elements [1]_ [2]_.

Each is a squared Euclidean distance d, so exp(-d / l) is positive definite for every l; with ``kendall`` it is the
Mallows kernel [3]_.

.. [1] Deshwal, Belakaria, Doppa, Kim. Bayesian Optimization over Permutation Spaces. AAAI 2022.
.. [2] Hellsten et al. BaCO: A Fast and Portable Bayesian Compiler Optimization Framework. ASPLOS 2023.
.. [3] Jiao, Vert. The Kendall and Mallows Kernels for Permutations. ICML 2015.
"""
