"""A categorical parameter: one of several names without an order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from hypermap_lite.space.listed import ListedParameter, check_levels
from hypermap_lite.typing import Value


@dataclass(frozen=True, slots=True, kw_only=True)
class CategoricalParameter(ListedParameter):
    """One of a list of names, in the order given."""

    values: tuple[str, ...]
    is_ordered: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_levels(self.name, self.values)

    @property
    def levels(self) -> Sequence[Value]:
        """The names as given."""
        return self.values

    def allowed(self) -> str:
        """Say which values are legal."""
        return f"one of {', '.join(map(repr, self.values))}"
