"""The Branin function: a smooth valley landscape with three equally deep minima."""

import math
from collections.abc import Mapping


def evaluate(configuration: Mapping[str, float]) -> dict[str, float]:
    """Return the value at one configuration; the smallest possible is 0.397887."""
    x1, x2 = configuration["x1"], configuration["x2"]
    bend = x2 - 5.1 / (4 * math.pi**2) * x1**2 + 5 / math.pi * x1 - 6
    return {"value": bend**2 + 10 * (1 - 1 / (8 * math.pi)) * math.cos(x1) + 10}
