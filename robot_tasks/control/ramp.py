"""A vector that moves towards its target at a limited rate."""

from __future__ import annotations

from collections.abc import Sequence


class Ramp:
    """Limit how fast each component of a command may change.

    Parameters
    ----------
    value
        First value; also the first target.
    rate
        Largest change per second, the same number for every component.
    """

    __slots__ = ("is_settled", "rate", "target", "value")

    def __init__(self, value: Sequence[float], *, rate: float) -> None:
        self.value = tuple(value)
        self.target = self.value
        self.rate = rate
        self.is_settled = True

    def aim(self, target: Sequence[float]) -> None:
        """Set a new target of the same length."""
        self.target = target if isinstance(target, tuple) else tuple(target)
        self.is_settled = self.target == self.value

    def advance(self, seconds: float) -> None:
        """Move every component towards its target for a time in [s]."""
        step = self.rate * seconds
        self.value = tuple(v + min(step, max(-step, t - v)) for v, t in zip(self.value, self.target, strict=True))
        self.is_settled = self.value == self.target
