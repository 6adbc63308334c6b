"""The cost of a tin can, in closed form."""

import math
from collections.abc import Mapping
from typing import Any

PRICES = {"steel": 1.4, "aluminium": 2.3}
"""Of a material [cent / cm^3]."""


def evaluate(configuration: Mapping[str, Any]) -> dict[str, float]:
    """Return the cost of one can [cent], and its volume [cm^3]."""
    radius, height = configuration["radius"], configuration["height"]
    thickness = configuration["wall-thickness"] / 10
    surface = 2 * math.pi * radius * (radius + height)
    joints = 0.02 * (4 * math.pi * radius + height)
    cost = PRICES[configuration["material"]] * surface * thickness + joints
    return {"cost": cost, "volume": math.pi * radius**2 * height}
