"""The search space: native values on one side, the unit cube on the other."""

from collections.abc import Mapping
from typing import Final

from hypermap_lite.space.categorical import CategoricalParameter
from hypermap_lite.space.constraint import Constraint
from hypermap_lite.space.integer import IntegerParameter
from hypermap_lite.space.ordinal import OrdinalParameter
from hypermap_lite.space.parameter import Parameter
from hypermap_lite.space.permutation import PermutationParameter
from hypermap_lite.space.real import RealParameter
from hypermap_lite.space.search_space import SearchSpace

PARAMETERS: Final[Mapping[str, type[Parameter]]] = {
    "real": RealParameter,
    "integer": IntegerParameter,
    "ordinal": OrdinalParameter,
    "categorical": CategoricalParameter,
    "permutation": PermutationParameter,
}
"""JSON name of each parameter type."""

__all__ = [
    "PARAMETERS",
    "CategoricalParameter",
    "Constraint",
    "IntegerParameter",
    "OrdinalParameter",
    "Parameter",
    "PermutationParameter",
    "RealParameter",
    "SearchSpace",
]
