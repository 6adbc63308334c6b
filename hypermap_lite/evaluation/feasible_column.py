"""The column in which a black box answers whether a configuration is feasible."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class FeasibleColumn:
    """Its name and its two texts."""

    name: str = "Valid"
    true_value: str = "True"
    false_value: str = "False"

    def read(self, text: str) -> bool:
        """Return the truth value that a text stands for.

        Raises
        ------
        ValueError
            If it is neither of the two.
        """
        if text not in (self.true_value, self.false_value):
            raise ValueError(f"'{self.name}' is {text!r}, neither {self.true_value!r} nor {self.false_value!r}")
        return text == self.true_value
