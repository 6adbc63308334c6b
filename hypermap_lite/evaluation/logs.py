"""Log files of a trial: their last line, and a limit on their size."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Final

from hypermap_lite.evaluation.evaluator import EvaluationRequest

KEPT_BYTES: Final = 1 << 20
"""How much of a log's beginning, and of its end, is kept and looked at [bytes]."""

ENDINGS: Final = ("stdout.log", "stderr.log")
"""What is kept of a call's output: one file per stream."""


def last_text_line(path: Path) -> str:
    """Return the last line of a file that is not empty, stripped; nothing if there is none.

    Raises
    ------
    ValueError
        If it is longer than `KEPT_BYTES`.
    """
    with path.open("rb") as file:
        start = max(0, file.seek(0, os.SEEK_END) - KEPT_BYTES)
        file.seek(start)
        lines = file.read().splitlines()  # of bytes: not at the separators that JSON allows within a string
    found = next(((i, line) for i, line in reversed([*enumerate(lines)]) if line.strip()), None)
    if found is None:
        return ""
    position, line = found
    if position == 0 and start > 0:
        raise ValueError(f"the last line of {path.name} is longer than {KEPT_BYTES >> 20} MiB")
    return line.decode("utf-8", errors="replace").strip()


def shorten_logs(request: EvaluationRequest) -> None:
    """Limit the size of a call's logs, if there are any."""
    for ending in ENDINGS:
        shorten_log(request.file(ending))


def shorten_log(path: Path) -> None:
    """Cut the middle out of a file that is longer than twice `KEPT_BYTES`, and say there what was cut.

    The file stays the same one, so whoever still adds to its end goes on doing so.
    """
    with contextlib.suppress(OSError), path.open("r+b") as file:
        size = file.seek(0, os.SEEK_END)
        if size <= 2 * KEPT_BYTES + 1024:
            return
        file.seek(size - KEPT_BYTES)
        end = file.read(KEPT_BYTES)
        note = f"\n[... {size - 2 * KEPT_BYTES} bytes of this log were cut out here ...]\n"
        file.seek(KEPT_BYTES)
        file.write(note.encode() + end)
        file.truncate()
