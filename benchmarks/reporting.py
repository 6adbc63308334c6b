"""Result tables of the benchmarks: a CSV that grows row by row, and a page that sums it up."""

from __future__ import annotations

import csv
import os
import platform
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any


class ResultTable:
    """Rows on disk, one per case; a case that has its row is not measured again."""

    def __init__(self, path: Path, columns: Sequence[str], key: Sequence[str]) -> None:
        self.path = path
        self.columns = tuple(columns)
        self.key = tuple(key)
        path.parent.mkdir(parents=True, exist_ok=True)
        self.rows: list[dict[str, Any]] = []
        if path.exists():
            with path.open(newline="") as file:
                self.rows = list(csv.DictReader(file))
        else:
            self._append(dict(zip(self.columns, self.columns, strict=True)))

    def _append(self, row: Mapping[str, Any]) -> None:
        with self.path.open("a", newline="") as file:
            csv.DictWriter(file, self.columns, lineterminator="\n").writerow(row)

    def has(self, case: Mapping[str, Any]) -> bool:
        """Tell whether a case has its row."""
        wanted = [_text(case[name]) for name in self.key]
        return any([_text(row[name]) for name in self.key] == wanted for row in self.rows)

    def forget(self, column: str, values: Sequence[str]) -> None:
        """Delete the rows that have one of these values in a column."""
        self.rows = [row for row in self.rows if row[column] not in values]
        with self.path.open("w", newline="") as file:
            writer = csv.DictWriter(file, self.columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows(self.rows)

    def fill(self, case: Mapping[str, Any], measure: Callable[..., Mapping[str, Any]]) -> None:
        """Measure a case, unless it has its row."""
        if self.has(case):
            return
        row = {name: _text(value) for name, value in measure(*case.values()).items()}
        self._append(row)
        self.rows.append(dict(row))

    def write_page(
        self, path: Path, *, title: str, command: str, text: str, header: Sequence[str], rows: Sequence[Sequence[str]]
    ) -> None:
        """Write the summary as Markdown."""
        lines = [f"# {title}", "", f"    {command}", "", text, "", *markdown_table(header, rows)]
        path.write_text("\n".join(lines) + "\n")


def _text(value: Any) -> str:
    """Return a value as it stands in the table."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def markdown_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a Markdown table."""
    return [
        "| " + " | ".join(header) + " |",
        "|" + "---|" * len(header),
        *["| " + " | ".join(row) + " |" for row in rows],
    ]


def machine() -> str:
    """Say what the figures were measured on."""
    versions = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "scikit-learn"))
    return f"Python {platform.python_version()}, {versions}; {platform.machine()}, {os.cpu_count()} cores."
