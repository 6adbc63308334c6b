"""Search spaces with constraints: loose and tight, real, mixed and finite."""

from __future__ import annotations

from typing import Any

from hypermap_lite.assembly import build_space
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.space import SearchSpace

REAL = {name: {"parameter_type": "real", "values": [0, 1]} for name in "ab"}
MIXED = {
    "a": {"parameter_type": "real", "values": [1e-3, 1], "scale": "log"},
    "n": {"parameter_type": "integer", "values": [0, 50]},
    "o": {"parameter_type": "ordinal", "values": [1, 2, 4]},
    "c": {"parameter_type": "categorical", "values": ["x", "y", "z"]},
}
FINITE = {name: {"parameter_type": "integer", "values": [0, 5]} for name in "klm"}

SPACES: dict[str, tuple[dict[str, Any], list[str]]] = {
    "half": (REAL, ["a + b <= 1"]),
    "ring": (REAL, ["0.16 <= (a - 0.5)**2 + (b - 0.5)**2 <= 0.17"]),
    "tiny": (REAL, ["a < 0.005", "b > 0.995"]),
    "hair": (REAL, ["abs(a - b) < 0.0001"]),
    "mixed": (MIXED, ["c != 'x' or n < 10", "n * a <= 5", "n % 2 == 0 or o == 4"]),
    "mixed equality": (MIXED, ["n == 12 * o", "a < 0.5"]),
    "sum": (FINITE, ["k + l + m == 9"]),
    "single": (FINITE, ["k * l * m == 125"]),
}
"""Parameters and constraints by name."""


def space_of(name: str) -> SearchSpace:
    """Return one of the spaces."""
    parameters, constraints = SPACES[name]
    scenario = {"input_parameters": parameters, "constraints": constraints, "objectives": [{"name": "y"}]}
    return build_space(load_scenario(scenario))
