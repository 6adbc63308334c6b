"""Parameter values in files that others wrote: numbers of another type, or rounded."""

from __future__ import annotations

import math
from typing import Final

from hypermap_lite.history.csv_format import parse_value
from hypermap_lite.space import IntegerParameter, Parameter, RealParameter
from hypermap_lite.typing import Value

ROUNDING: Final = 1e-9
"""How far beyond a bound or from a level, as a share of the range, a value may lie from rounding alone."""


def parse_foreign_value(parameter: Parameter, text: str) -> Value:
    """Return the legal value that a text means, also if it writes a whole number as 1.0 or an end of the range rounded.

    Raises
    ------
    ValueError
        If the parameter has no such value.
    """
    try:
        return parse_value(parameter, text)
    except ValueError:
        value = _nearest(parameter, text)
    if value is None:
        shown = text if isinstance(parameter, RealParameter | IntegerParameter) else repr(text)
        raise ValueError(f"{parameter.name} is {shown}, which is not {parameter.allowed()}")
    return value


def _nearest(parameter: Parameter, text: str) -> Value | None:
    """Return the value that a number is but for rounding; None if there is none, or the text is no number."""
    try:
        number = float(text)
    except ValueError:
        return None
    if isinstance(parameter, RealParameter | IntegerParameter):
        if not math.isfinite(number):
            return None
        is_whole = isinstance(parameter, IntegerParameter)
        inside = min(max(number, parameter.low), parameter.high)
        value = round(inside) if is_whole else float(inside)
        slack = max(ROUNDING * (parameter.high - parameter.low), ROUNDING if is_whole else 0.0)
        return value if abs(number - value) <= slack else None
    levels = [level for level in getattr(parameter, "values", ()) if isinstance(level, int | float)]
    slack = ROUNDING * (max(levels) - min(levels)) if levels else 0.0
    return next((level for level in levels if abs(number - level) <= slack), None)
