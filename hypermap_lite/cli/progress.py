"""What a run shows on stderr while it goes on: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, TextIO

from hypermap_lite.evaluation.observer import SAID_BY_COMMAND, RunObserver

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress

    from hypermap_lite.evaluation.outcome import Evaluation, Replicate

PACKAGE_LOGGER = "hypermap_lite"


@contextmanager
def progress(
    *, is_quiet: bool = False, is_verbose: bool = False, stream: TextIO | None = None
) -> Iterator[RunObserver]:
    """Show a run on stderr as long as the context lasts.

    On a terminal a bar is drawn and only warnings are written above it; elsewhere each evaluation has its line.

    Parameters
    ----------
    is_quiet
        Show warnings and errors only.
    is_verbose
        Show the whole log.
    stream
        Where to write; stderr by default.
    """
    stream = sys.stderr if stream is None else stream
    has_bar = not is_quiet and stream.isatty() and os.environ.get("TERM") != "dumb"
    level = logging.DEBUG if is_verbose else logging.WARNING if is_quiet or has_bar else logging.INFO
    if not has_bar:
        with _logging_to(logging.StreamHandler(stream), level):
            yield RunObserver()
        return
    from rich.console import Console

    console = Console(file=stream, highlight=False)
    with _bar(console) as bar, _logging_to(_AboveBar(console), level):
        yield BarObserver(bar)


class BarObserver(RunObserver):
    """Moves a bar with every call of the black box that ends."""

    def __init__(self, bar: Progress) -> None:
        self._bar = bar
        self._task = bar.add_task("starting", total=1, visible=False, news="")
        self._per_configuration = 1.0

    def on_start(self, *, done: int, total: int) -> None:
        """Show how much there is to do, and how much is done already."""
        self._bar.update(self._task, total=total, completed=done, visible=True)

    def on_suggestions(self, trials: Sequence[int], n_calls: int) -> None:
        """Name the configurations under way."""
        several = f"trials {trials[0]}-{trials[-1]}" if len(trials) > 1 else f"trial {trials[0]}"
        self._per_configuration = len(trials) / max(n_calls, 1)
        self._bar.update(self._task, description=several)

    def on_replicate(self, replicate: Replicate) -> None:
        """Advance by one call."""
        self._bar.advance(self._task, self._per_configuration)

    def on_evaluation(self, evaluation: Evaluation, front: str) -> None:
        """Set the bar to the configurations that are done, and tell of news."""
        self._bar.update(self._task, completed=evaluation.trial + 1)
        if front:
            values = ", ".join(f"{name} {value:.4g}" for name, value in evaluation.values.items())
            self._bar.update(self._task, news=f"{front} at trial {evaluation.trial}: {values}")


def _bar(console: Console) -> Progress:
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.0f}/{task.total:.0f}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[news]}"),
        console=console,
        transient=True,
    )


class _AboveBar(logging.Handler):
    """Writes log lines so that they do not break the bar."""

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console = console

    def emit(self, record: logging.LogRecord) -> None:
        """Write one line."""
        self._console.print(self.format(record), markup=False, soft_wrap=True)


class _Formatter(logging.Formatter):
    """Marks warnings and errors, and leaves the rest as it is."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line for a record."""
        text = super().format(record)
        return text if record.levelno < logging.WARNING else f"{record.levelname.lower()}: {text}"


@contextmanager
def _logging_to(handler: logging.Handler, level: int) -> Iterator[None]:
    package = logging.getLogger(PACKAGE_LOGGER)
    before = package.level
    handler.setLevel(level)
    handler.setFormatter(_Formatter())
    handler.addFilter(lambda record: not SAID_BY_COMMAND.keys() <= record.__dict__.keys())
    package.addHandler(handler)
    package.setLevel(level)
    try:
        yield
    finally:
        package.removeHandler(handler)
        package.setLevel(before)
