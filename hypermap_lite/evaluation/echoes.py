"""Which of the configurations asked for a row of a reply belongs to, by the parameters it repeats."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

from hypermap_lite.history.csv_format import format_value
from hypermap_lite.space import IntegerParameter, RealParameter
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.search_space import SearchSpace
from hypermap_lite.typing import Configuration, Value

TOLERANCE: Final = 1e-5
"""How far a repeated number may be off, relative to itself or, on a linear axis, to the range: six digits will do."""


def find_request(
    space: SearchSpace, waiting: Mapping[int, Configuration], row: Mapping[str, str], position: int
) -> int | None:
    """Return which of the waiting configurations a row answers, or None if it is none of them.

    Exact repetitions go first, then the row's own position, then the nearest configuration.

    Parameters
    ----------
    space
        The search space.
    waiting
        Configurations without a row yet, by their position in the request.
    row
        Texts by column.
    position
        Position of the row in the reply.
    """
    if position in waiting and distance(space, waiting[position], row) == 0.0:
        return position
    distances = {i: distance(space, configuration, row) for i, configuration in waiting.items()}
    exact = [i for i, d in distances.items() if d == 0.0]
    near = [i for i, d in distances.items() if d <= TOLERANCE]
    if not exact and position in near:
        return position
    return min(near, key=lambda i: distances[i], default=None)


def distance(space: SearchSpace, configuration: Configuration, row: Mapping[str, str]) -> float:
    """Return the largest distance of a repeated value from the one asked for; infinity if they cannot be the same."""
    return max(_distance(p, configuration[p.name], row[p.name]) for p in space.parameters)


def _distance(parameter: Parameter, value: Value, text: str) -> float:
    if text == format_value(parameter, value).strip():
        return 0.0
    if isinstance(value, str) or not isinstance(value, int | float):
        return math.inf
    try:
        difference = abs(float(text) - value)
    except ValueError:
        return math.inf
    if difference == 0.0:
        return 0.0
    scale = max(abs(value), _range(parameter))
    return difference / scale if math.isfinite(difference) and scale else math.inf


def _range(parameter: Parameter) -> float:
    """Return the range of a parameter on a linear axis, 0 for any other."""
    if isinstance(parameter, RealParameter | IntegerParameter) and not parameter.log:
        return float(parameter.high) - float(parameter.low)
    return 0.0


def differences(space: SearchSpace, configuration: Configuration, row: Mapping[str, str]) -> Sequence[str]:
    """Return, in words, each parameter in which a row is not the configuration asked for."""
    return [
        f"{p.name} is {row[p.name]}, asked for {format_value(p, configuration[p.name])}"
        for p in space.parameters
        if _distance(p, configuration[p.name], row[p.name]) > TOLERANCE
    ]
