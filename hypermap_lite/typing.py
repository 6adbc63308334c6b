"""Names for the few array and value types that cross module borders."""

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Value: TypeAlias = float | int | str
"""One parameter's value as the user writes it."""

Configuration: TypeAlias = Mapping[str, Value]
"""One point of the search space in the user's values, keyed by parameter name."""

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
BoolArray: TypeAlias = npt.NDArray[np.bool_]
Rng: TypeAlias = np.random.Generator
