"""Terms of an expression over the parameters' native values, evaluated for many points at once.

A number that is not finite, such as 1/0 or log(-1), is NaN and stays so. A comparison with NaN is neither true nor
false, and logic goes on with these three values as Kleene's does: ``x == 0 or 1/x > 2`` is true at x = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from hypermap_lite.typing import BoolArray, FloatArray

Columns: TypeAlias = Mapping[str, npt.NDArray[Any]]
"""Native values of n points by parameter name: numbers or texts, shape (n,); permutations, shape (n, size)."""

Number: TypeAlias = Callable[[Columns], FloatArray]
"""A term whose value is a number at each of n points, shape (n,) or (); NaN where it has none."""

Text: TypeAlias = Callable[[Columns], npt.NDArray[np.object_]]
"""A term whose value is a text at each of n points."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Where a condition is known to be true, and where it is known to be false; elsewhere it is neither."""

    is_true: BoolArray
    is_false: BoolArray

    def __and__(self, other: Verdict) -> Verdict:
        return Verdict(self.is_true & other.is_true, self.is_false | other.is_false)

    def __or__(self, other: Verdict) -> Verdict:
        return Verdict(self.is_true | other.is_true, self.is_false & other.is_false)

    def __invert__(self) -> Verdict:
        return Verdict(self.is_false, self.is_true)


Condition: TypeAlias = Callable[[Columns], Verdict]
"""A term that is true, false or neither at each of n points."""


@dataclass(frozen=True, slots=True)
class Function:
    """A function of numbers, by its name in expressions."""

    apply: Callable[..., FloatArray]
    least: int = 1
    """Smallest number of arguments."""

    most: int | None = 1
    """Largest number of arguments; None for any."""

    def arguments(self) -> str:
        """Say how many arguments it takes."""
        if self.most is None:
            return f"{self.least} or more numbers"
        least = f"{self.least} or " if self.least < self.most else ""
        return f"{least}{self.most} number{'s' * (self.most > 1)}"


def _minimum(*values: FloatArray) -> FloatArray:
    return np.asarray(reduce(np.minimum, values))


def _maximum(*values: FloatArray) -> FloatArray:
    return np.asarray(reduce(np.maximum, values))


def _round(value: FloatArray, digits: FloatArray | None = None) -> FloatArray:
    scale = 1.0 if digits is None else 10.0 ** np.rint(digits)
    return np.rint(value * scale) / scale


def _power(base: FloatArray, exponent: FloatArray) -> FloatArray:
    """Raise to a power; NumPy says that NaN to the power of 0, and 1 to that of NaN, are 1."""
    return np.where(np.isnan(base) | np.isnan(exponent), np.nan, np.power(base, exponent))


FUNCTIONS: Final[Mapping[str, Function]] = {
    "abs": Function(np.abs),
    "min": Function(_minimum, 2, None),
    "max": Function(_maximum, 2, None),
    "sqrt": Function(np.sqrt),
    "exp": Function(np.exp),
    "log": Function(np.log),
    "log2": Function(np.log2),
    "log10": Function(np.log10),
    "floor": Function(np.floor),
    "ceil": Function(np.ceil),
    "round": Function(_round, 1, 2),
}
"""Functions of an expression; log is the natural logarithm, round goes to the even neighbour as in Python."""

OPERATORS: Final[Mapping[str, Callable[..., FloatArray]]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "//": np.floor_divide,
    "%": np.mod,
    "**": _power,
}
"""Operators between two numbers."""

COMPARISONS: Final[Mapping[str, Callable[..., BoolArray]]] = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "==": np.equal,
    "!=": np.not_equal,
}
"""Comparisons of two numbers; of two texts only the last two."""


def constant(value: float) -> Number:
    """Return a number that is the same everywhere."""
    number = np.float64(value)
    return lambda columns: np.asarray(number)


def variable(name: str) -> Number:
    """Return a parameter's value as a number."""
    return lambda columns: np.asarray(columns[name], dtype=float)


def element_at(name: str, place: int) -> Number:
    """Return the element at a place of a permutation."""
    return lambda columns: np.asarray(columns[name][:, place], dtype=float)


def place_of(name: str, element: int) -> Number:
    """Return the place of an element in a permutation."""
    return lambda columns: np.asarray(np.argmax(columns[name] == element, axis=1), dtype=float)


def applied(function: Callable[..., FloatArray], arguments: Sequence[Number]) -> Number:
    """Return a function's value at some terms; NaN where it is not finite."""

    def evaluate(columns: Columns) -> FloatArray:
        values = [argument(columns) for argument in arguments]
        with np.errstate(all="ignore"):
            result = np.asarray(function(*values))
        return np.where(np.isfinite(result), result, np.nan)

    return evaluate


def compared(comparison: str, left: Number, right: Number) -> Condition:
    """Return the condition that two numbers compare so."""
    compare = COMPARISONS[comparison]

    def evaluate(columns: Columns) -> Verdict:
        a, b = left(columns), right(columns)
        is_known, holds = ~(np.isnan(a) | np.isnan(b)), compare(a, b)
        return Verdict(is_known & holds, is_known & ~holds)

    return evaluate


def texts_equal(left: Text, right: Text) -> Condition:
    """Return the condition that two texts are equal."""

    def evaluate(columns: Columns) -> Verdict:
        equal = np.asarray(left(columns) == right(columns), dtype=bool)
        return Verdict(equal, ~equal)

    return evaluate


def all_of(conditions: Sequence[Condition]) -> Condition:
    """Return the condition that all of some conditions are true."""
    return lambda columns: reduce(Verdict.__and__, [condition(columns) for condition in conditions])


def any_of(conditions: Sequence[Condition]) -> Condition:
    """Return the condition that at least one of some conditions is true."""
    return lambda columns: reduce(Verdict.__or__, [condition(columns) for condition in conditions])


def negated(condition: Condition) -> Condition:
    """Return the condition that another is false."""
    return lambda columns: ~condition(columns)
