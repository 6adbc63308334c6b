"""Names for the few array and value types that cross module borders."""

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Level: TypeAlias = float | int | str
"""A number or a name, such as a bound or a level of a parameter."""

Value: TypeAlias = Level | tuple[int, ...]
"""One parameter's value as the user writes it; a permutation as a tuple."""

Configuration: TypeAlias = Mapping[str, Value]
"""One point of the search space in the user's values, keyed by parameter name."""

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
BoolArray: TypeAlias = npt.NDArray[np.bool_]
Rng: TypeAlias = np.random.Generator


def as_argument(value: Value) -> str:
    """Return a parameter's value as a program reads it: floats by their shortest exact text, ``0 2 1`` for an order."""
    if isinstance(value, tuple):
        return " ".join(map(str, value))
    return repr(float(value)) if isinstance(value, float) else str(value)
