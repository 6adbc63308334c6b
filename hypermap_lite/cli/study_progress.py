"""What a study shows on stderr while it goes on: a bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import timedelta
from typing import TYPE_CHECKING, TextIO

from hypermap_lite.study.progress import Failure, Progress, StudyObserver
from hypermap_lite.study.specification import Run

if TYPE_CHECKING:
    from rich.progress import Progress as Bar


@contextmanager
def study_progress(*, is_quiet: bool = False, stream: TextIO | None = None) -> Iterator[StudyObserver]:
    """Show a study on stderr as long as the context lasts: a bar on a terminal, a line per run elsewhere."""
    stream = sys.stderr if stream is None else stream
    if is_quiet:
        yield StudyObserver()
    elif not stream.isatty() or os.environ.get("TERM") == "dumb":
        yield _lines_on(stream)
    else:
        with _bar(stream) as bar:
            yield _bar_observer(bar)


def standing(progress: Progress) -> str:
    """Return where a study stands: ``12 of 100 runs, 540 of 5000 evaluations, about 0:12:30 left``."""
    evaluations = f"{progress.done_evaluations} of {progress.total_evaluations} evaluations"
    return f"{progress.done_runs} of {progress.total_runs} runs, {evaluations}{_time_left(progress)}"


def _time_left(progress: Progress) -> str:
    seconds = progress.seconds_left
    if seconds is None or progress.runs_left == 0:
        return ""
    return f", about {timedelta(seconds=round(seconds))} left"


def _lines_on(stream: TextIO) -> StudyObserver:
    class Lines(StudyObserver):
        """Writes a line at the start and after every run."""

        def on_start(self, progress: Progress) -> None:
            _say(stream, standing(progress))

        def on_run_end(self, run: Run, progress: Progress, failure: Failure | None) -> None:
            what = "finished" if failure is None else f"failed: {failure.headline}"
            _say(stream, f"{run} {what}; {standing(progress)}")

    return Lines()


def _say(stream: TextIO, line: str) -> None:
    with suppress(OSError):  # that nobody can read it is no reason to stop
        stream.write(line + "\n")
        stream.flush()


@contextmanager
def _bar(stream: TextIO) -> Iterator[Bar]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.0f}/{task.total:.0f} evaluations"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[news]}"),
    )
    with Progress(*columns, console=Console(file=stream, highlight=False), transient=True) as bar:
        yield bar


def _bar_observer(bar: Bar) -> StudyObserver:
    task = bar.add_task("starting", total=1, news="")

    class BarObserver(StudyObserver):
        """Moves a bar with every evaluation."""

        def on_start(self, progress: Progress) -> None:
            self.on_progress(progress)

        def on_progress(self, progress: Progress) -> None:
            runs = f"{progress.done_runs}/{progress.total_runs} runs"
            news = f"{_time_left(progress).removeprefix(', ')}  {', '.join(map(str, progress.running))}".strip()
            done, total = progress.done_evaluations, progress.total_evaluations
            bar.update(task, description=runs, completed=done, total=total, news=news)

        def on_run_end(self, run: Run, progress: Progress, failure: Failure | None) -> None:
            if failure is not None:
                bar.console.print(f"{run} failed: {failure.headline}", markup=False, soft_wrap=True)
            self.on_progress(progress)

    return BarObserver()
