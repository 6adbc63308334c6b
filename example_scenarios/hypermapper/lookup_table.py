"""Make look-up problems: all configurations of an accelerator for a stream of items, with its area and run time.

`python lookup_table.py FOLDER` writes lookup_large.csv (76,800 rows, 4.5 % of them valid) and its scenario
lookup_large.json there; the small table beside this file comes from `python lookup_table.py --small FOLDER`.

A design works on tiles of the stream. A larger tile costs memory, more lanes cost logic and save time, two buffers let
loading and computing overlap, and a pipeline gives a result per cycle where there was one per depth. A design is valid
if it fits the chip and its lanes share a tile evenly.
"""

from __future__ import annotations

import argparse
import csv
import itertools
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ITEMS = 4_000_000
DEPTH = 24
"""Cycles for one item."""

WORDS_PER_CYCLE = 16
LATENCY = 220
"""Cycles before the first word of a tile arrives."""

BLOCK_WORDS = 512
"""Words in one block of memory."""

LOGIC_CAPACITY = 220_000
MEMORY_CAPACITY = 72

COLUMNS = ("tile", "buffers", "lanes", "pipelined", "Logic", "Memory", "Cycles", "Valid")


@dataclass(frozen=True, kw_only=True)
class Table:
    """The levels of a table's parameters, and how its scenario spends the budget."""

    tiles: Sequence[int]
    lanes: Sequence[int]
    design: int
    iterations: int


TABLES = {
    "lookup": Table(tiles=range(600, 9601, 600), lanes=(1, 3, 7, 9, 11, 16, 20, 32), design=40, iterations=60),
    "lookup_large": Table(tiles=range(96, 19201, 96), lanes=range(1, 97), design=1000, iterations=50),
}


def cycles(tile: int, buffers: int, lanes: int, is_pipelined: bool) -> int:
    """Return the run time of a design."""
    load = LATENCY + tile // WORDS_PER_CYCLE
    compute = DEPTH + -(-tile // lanes) * (1 if is_pipelined else DEPTH)
    per_tile = max(load, compute) if buffers == 2 else load + compute
    return -(-ITEMS // tile) * per_tile + load


def logic(tile: int, buffers: int, lanes: int, is_pipelined: bool) -> int:
    """Return the area of a design: every lane costs a little more than the one before, for its wires."""
    per_lane = 5200 if is_pipelined else 2100
    return 31_000 + 4 * tile * buffers + int(per_lane * lanes**1.15)


def memory(tile: int, buffers: int, lanes: int) -> int:
    """Return the blocks of memory: each lane reads from a bank of its own."""
    return 24 + 2 * buffers * lanes * -(-tile // (lanes * BLOCK_WORDS))


def rows(table: Table) -> Iterator[tuple[Any, ...]]:
    """Yield a row per configuration."""
    for tile, buffers, lanes, is_pipelined in itertools.product(table.tiles, (1, 2), table.lanes, (False, True)):
        area, blocks = logic(tile, buffers, lanes, is_pipelined), memory(tile, buffers, lanes)
        is_valid = area <= LOGIC_CAPACITY and blocks <= MEMORY_CAPACITY and tile % lanes == 0
        time = cycles(tile, buffers, lanes, is_pipelined)
        yield tile, buffers, lanes, str(is_pipelined).lower(), area, blocks, time, is_valid


def scenario(name: str, table: Table, file: Path) -> dict[str, Any]:
    """Return the scenario of a table, in HyperMapper's format."""
    return {
        "application_name": f"hypermapper_{name}",
        "optimization_objectives": ["Logic", "Cycles"],
        "optimization_iterations": table.iterations,
        "design_of_experiment": {"doe_type": "random sampling", "number_of_samples": table.design},
        "models": {"model": "random_forest"},
        "feasible_output": {
            "enable_feasible_predictor": True,
            "name": "Valid",
            "true_value": "True",
            "false_value": "False",
        },
        "hypermapper_mode": {"mode": "exhaustive", "exhaustive_search_file": str(file)},
        "input_parameters": {
            "tile": {"parameter_type": "ordinal", "values": list(table.tiles)},
            "buffers": {"parameter_type": "ordinal", "values": [1, 2]},
            "lanes": {"parameter_type": "ordinal", "values": list(table.lanes)},
            "pipelined": {"parameter_type": "categorical", "values": ["false", "true"]},
        },
    }


def write(folder: Path, name: str) -> Path:
    """Write a table and its scenario and return the scenario's file."""
    folder.mkdir(parents=True, exist_ok=True)
    data, file = folder / f"{name}.csv", folder / f"{name}.json"
    with data.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows(TABLES[name]))
    entries = (f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in scenario(name, TABLES[name], data).items())
    file.write_text("{\n" + ",\n".join(entries) + "\n}\n", encoding="utf-8")
    return file


def main() -> None:
    """Write one of the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--small", action="store_true", help="write the table of a few hundred rows")
    arguments = parser.parse_args()
    print(write(arguments.folder, "lookup" if arguments.small else "lookup_large"))


if __name__ == "__main__":
    main()
