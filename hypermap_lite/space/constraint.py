"""A known constraint between parameters: a condition, written as an expression, that every configuration meets."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hypermap_lite.space.expressions import Columns, Condition
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.reading import ExpressionReader
from hypermap_lite.typing import BoolArray


@dataclass(frozen=True, slots=True)
class Constraint:
    """A condition over the native values of some parameters, such as ``x1**2 + x2**2 <= 225``.

    Arithmetic is that of floating-point numbers. Where an expression has no finite value, as in a division by zero, a
    comparison with it is not met.

    Raises
    ------
    ScenarioError
        If the text is no condition over the parameters.
    """

    text: str
    parameters: tuple[Parameter, ...] = field(repr=False, compare=False)
    """All that it may speak of."""

    names: frozenset[str] = field(init=False, repr=False, compare=False)
    """Names of the parameters it speaks of."""

    _condition: Condition = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        reader = ExpressionReader(self.text, self.parameters)
        object.__setattr__(self, "_condition", reader.condition())
        object.__setattr__(self, "names", frozenset(reader.names))

    def __reduce__(self) -> tuple[type[Constraint], tuple[str, tuple[Parameter, ...]]]:
        """Pickle the text, which is read again."""
        return Constraint, (self.text, self.parameters)

    def holds(self, columns: Columns, n: int) -> BoolArray:
        """Tell at which of n points, given by their values of `names`, it is met, shape (n,)."""
        return np.broadcast_to(self._condition(columns).is_true, (n,))
