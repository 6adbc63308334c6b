"""Problems in closed form to compare searches on."""

from __future__ import annotations

import math
from typing import Any

from hypermap_lite.typing import Configuration

BRANIN: dict[str, Any] = {
    "input_parameters": {
        "x1": {"parameter_type": "real", "values": [-5, 10]},
        "x2": {"parameter_type": "real", "values": [0, 15]},
    },
    "objectives": [{"name": "y"}],
}

MIXED: dict[str, Any] = {
    "input_parameters": {
        "r": {"parameter_type": "real", "values": [0, 1]},
        "n": {"parameter_type": "integer", "values": [1, 1000], "scale": "log"},
        "o": {"parameter_type": "ordinal", "values": [1, 2, 4, 8, 16, 32]},
        "c": {"parameter_type": "categorical", "values": ["red", "green", "blue", "black"]},
    },
    "objectives": [{"name": "y"}],
}

ORDERED: dict[str, Any] = {
    "input_parameters": {name: entry for name, entry in MIXED["input_parameters"].items() if name != "c"},
    "objectives": [{"name": "y"}],
}


def branin(c: Configuration) -> dict[str, float]:
    """Return Branin's function, whose least value is 0.397887."""
    x1, x2 = float(c["x1"]), float(c["x2"])
    bowl = (x2 - 5.1 * x1**2 / (4 * math.pi**2) + 5 * x1 / math.pi - 6) ** 2
    return {"y": bowl + 10 * (1 - 1 / (8 * math.pi)) * math.cos(x1) + 10}


def mixed(c: Configuration) -> dict[str, float]:
    """Return a function whose least value is 0, at r 0.3, n 40, o 8 and, where there are categories, blue."""
    cost = {"red": 0.6, "green": 0.3, "blue": 0.0, "black": 1.0}[str(c.get("c", "blue"))]
    level = (math.log2(float(c["o"])) - 3) / 5
    return {"y": cost + 4 * (float(c["r"]) - 0.3) ** 2 + (math.log10(float(c["n"]) / 40)) ** 2 + level**2}
