"""Make the runs of a study that are missing, several at a time, each in a process of its own."""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Final

from hypermap_lite.evaluation.worker_process import THREAD_VARIABLES
from hypermap_lite.history.lock import FolderLock
from hypermap_lite.study.folder import count_rows, is_finished
from hypermap_lite.study.progress import Failure, Progress, StudyObserver
from hypermap_lite.study.specification import Run, Study

BOOT: Final = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
    "from hypermap_lite.study.job import main; sys.exit(main(sys.argv[2]))"
)
"""Program of a job: this process' module path, then `hypermap_lite.study.job`."""

POLL_SECONDS: Final = 0.2
"""How long the wish to stop may go unnoticed [s]."""

FAREWELL_SECONDS: Final = 10.0
"""How long a job that was told to end may take to save what it has [s]."""

SHOWN_ERROR: Final = 2000
"""Characters of a job's last words that are kept."""


class _Job:
    """One run under way."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - closed when the job has ended
        request = json.dumps({"scenario": str(run.variant.scenario), "overrides": run.overrides})
        capped = {name: "1" for name in THREAD_VARIABLES if name not in os.environ}
        self.process = subprocess.Popen(
            [sys.executable, "-c", BOOT, json.dumps(sys.path), request],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=os.environ | capped,  # several run at a time and share the cores
            start_new_session=True,  # Ctrl-C is for the study, which passes it on
        )
        assert self.process.stdout is not None
        self.reports = self.process.stdout
        self.heard = time.perf_counter()
        """When it last reported, by `time.perf_counter` [s]."""
        self._buffer = b""

    def read(self) -> list[int] | None:
        """Return the numbers of finished evaluations it has reported; None once it has closed its stdout."""
        content = os.read(self.reports.fileno(), 65536)
        if not content:
            return None
        *lines, self._buffer = (self._buffer + content).split(b"\n")
        return [json.loads(line)["done"] for line in lines if line.startswith(b'{"done"')]

    def elapsed(self) -> float:
        """Return the time since this was last asked, or since it began [s]."""
        now = time.perf_counter()
        before, self.heard = self.heard, now
        return now - before

    def end(self) -> Failure | None:
        """Wait for its end, and return what went wrong, if anything did."""
        status = self.process.wait()
        self._close()
        self._errors.seek(0)
        message = self._errors.read().decode("utf-8", errors="replace").strip()
        self._errors.close()
        if status == 0:
            return None
        return Failure(run=self.run, exit_status=status, message=message[-SHOWN_ERROR:] or f"it ended with {status}")

    def kill(self, deadline: float) -> None:
        """Wait for the end of one that was told to, and kill it at a deadline, by `time.perf_counter` [s]."""
        try:
            self.process.wait(max(deadline - time.perf_counter(), 0.0))
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._close()
        self._errors.close()

    def _close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.reports.close()


def run_study(
    study: Study,
    *,
    workers: int = 1,
    observer: StudyObserver | None = None,
    should_stop: Callable[[], bool] = lambda: False,
) -> list[Failure]:
    """Make all runs of a study that are missing, and go on with those that stopped.

    Parameters
    ----------
    study
        What to run.
    workers
        Runs at the same time. Does not change any result.
    observer
        Gets word of each step.
    should_stop
        Asked every 0.2 s; once true, the runs under way end after the evaluation they are at.

    Returns
    -------
    list of Failure
        Runs that did not come to their end, in the order in which they gave up; empty if all did or the study was
        stopped.

    Raises
    ------
    ScenarioError
        If a variant cannot be run as written.
    RunFolderError
        If a run folder holds the results of another scenario, or another process works on this study.
    """
    observer = observer or StudyObserver()
    for variant in study.variants:
        variant.validate()
    runs = list(study.runs())
    totals = Counter[str]()
    for run in runs:
        totals[run.variant.name] += run.variant.n_evaluations
    progress = Progress(total_runs=len(runs), total=dict(totals), n_workers=min(workers, len(runs)))
    missing = [run for run in runs if not _note_finished(run, progress)]
    observer.on_start(progress)
    if not missing:
        return []
    with FolderLock(study.folder):
        return _Session(missing, progress, workers, observer, should_stop).work()


def _note_finished(run: Run, progress: Progress) -> bool:
    """Note what a run folder holds, and tell whether the run is finished.

    Raises
    ------
    RunFolderError
        If it holds the results of another scenario.
    """
    run.check_folder()
    n_done = min(count_rows(run.folder), run.variant.n_evaluations)
    if n_done:
        progress.done[run] = n_done
    has_ended = is_finished(run.folder, run.variant.n_evaluations)
    progress.done_runs += has_ended
    return has_ended


class _Session:
    """Works through some runs."""

    def __init__(
        self,
        missing: Sequence[Run],
        progress: Progress,
        workers: int,
        observer: StudyObserver,
        should_stop: Callable[[], bool],
    ) -> None:
        self._waiting = list(reversed(missing))
        self._progress = progress
        self._workers = workers
        self._observer = observer
        self._should_stop = should_stop
        self._is_stopping = False
        self._selector = selectors.DefaultSelector()
        self._jobs: list[_Job] = []
        self._failures: list[Failure] = []

    def work(self) -> list[Failure]:
        """Run all; return those that failed."""
        try:
            self._fill()
            while self._jobs:
                for key, _ in self._selector.select(POLL_SECONDS):
                    self._listen(key.data)
                if not self._is_stopping and self._should_stop():
                    self._interrupt()
                self._fill()
        finally:  # only at StoppedAtOnce or an error of ours is anything left
            deadline = time.perf_counter() + FAREWELL_SECONDS
            _signal(self._jobs, signal.SIGTERM)
            for job in self._jobs:
                job.kill(deadline)
            self._selector.close()
        return self._failures

    def _fill(self) -> None:
        while self._waiting and not self._is_stopping and len(self._jobs) < self._workers:
            job = _Job(self._waiting.pop())
            self._jobs.append(job)
            self._selector.register(job.reports, selectors.EVENT_READ, job)
            self._progress.running.append(job.run)
            self._observer.on_run_start(job.run)

    def _listen(self, job: _Job) -> None:
        reports = job.read()
        if reports is None:
            self._end(job)
            return
        for n_done in reports:
            self._progress.advance(job.run, n_done, job.elapsed())
            self._observer.on_progress(self._progress)

    def _end(self, job: _Job) -> None:
        self._selector.unregister(job.reports)
        self._jobs.remove(job)
        self._progress.running.remove(job.run)
        failure = job.end()
        if failure is not None and self._is_stopping:
            return
        if failure is None:
            self._progress.done_runs += 1
        else:
            self._failures.append(failure)
            self._progress.failed.append(job.run)
        self._observer.on_run_end(job.run, self._progress, failure)

    def _interrupt(self) -> None:
        self._is_stopping = True
        _signal(self._jobs, signal.SIGINT)


def _signal(jobs: Iterable[_Job], number: signal.Signals) -> None:
    for job in jobs:
        job.process.send_signal(number)
