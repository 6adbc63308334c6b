"""Tables for people."""

from __future__ import annotations

from collections.abc import Sequence


def align(rows: Sequence[Sequence[str]]) -> str:
    """Return rows of cells as text with right-aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)


def show(value: object) -> str:
    """Return a value with four significant digits if it is a float, any other as it is."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)
