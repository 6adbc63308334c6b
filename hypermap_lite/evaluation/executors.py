"""Where calls of the black box happen: in this process, or in n worker processes that can be killed."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterable, Iterator
from multiprocessing.connection import wait
from types import TracebackType
from typing import ClassVar, Final, Protocol, Self

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.command import describe_status
from hypermap_lite.evaluation.evaluator import EvaluationRequest, Evaluator, answer, call, failure
from hypermap_lite.evaluation.logs import shorten_logs
from hypermap_lite.evaluation.outcome import Outcome, Replicate, State
from hypermap_lite.evaluation.worker_process import Worker, pickled

LONGEST_WAIT: Final = 0.5
"""Time between two looks at whether the workers still live [s]; answers and time limits are met at once."""

GRACE_SECONDS: Final = 2.0
"""Time between SIGTERM and SIGKILL for a call that runs past its time limit [s]."""

GRACE_STEP: Final = 0.02
"""Time between two looks at a call that was told to stop [s]."""

BURIAL_SECONDS: Final = 5.0
"""How long a worker whose pipe has closed may take to end, so that it is known how it ended [s]."""


class Executor(Protocol):
    """Makes calls, in any order, and hands back each as it finishes."""

    is_one_call: ClassVar[bool]
    """Whether all requests of a `run` are one call: then a result that is not taken would be lost."""

    def run(self, evaluator: Evaluator, requests: Iterable[EvaluationRequest]) -> Generator[Replicate, None, None]:
        """Yield the record of each call.

        A request is taken from the iterable only when it can start at once, and when whoever iterates has dealt with
        the record of the call before it in the same place.
        """

    def close(self) -> None:
        """Stop whatever is running and free what is held."""


class InProcessExecutor:
    """Makes one call after the other in this process, without a time limit."""

    is_one_call: ClassVar[bool] = False

    def run(self, evaluator: Evaluator, requests: Iterable[EvaluationRequest]) -> Generator[Replicate, None, None]:
        """Yield the record of each call."""
        for request in requests:
            yield call(evaluator, request)

    def close(self) -> None:
        """Do nothing: nothing is held."""


class ProcessExecutor:
    """Keeps up to n worker processes, which import the black box once and stay.

    A worker that runs past the time limit gets SIGTERM with everything it started, and SIGKILL if that does not help
    within `GRACE_SECONDS`; one that dies is replaced. Either way its call ends with an outcome that says so.

    Parameters
    ----------
    n_workers
        Calls at the same time.
    timeout_seconds
        Time limit of one call [s], importing the black box not counted; None for none.
    """

    is_one_call: ClassVar[bool] = False

    def __init__(self, n_workers: int, timeout_seconds: float | None = None) -> None:
        self.timeout_seconds = timeout_seconds
        self._slots: list[Worker | None] = [None] * n_workers
        self._pickled = b""

    def run(self, evaluator: Evaluator, requests: Iterable[EvaluationRequest]) -> Generator[Replicate, None, None]:
        """Yield the record of each call as it finishes.

        Raises
        ------
        UsageError
            If the evaluator cannot be sent to a worker, or a worker cannot load it.
        """
        self._prepare(evaluator)
        waiting = iter(requests)
        try:
            self._hand_out(waiting)
            while busy := self._busy():
                yield from self._collect(busy)  # first of all, so that what is finished is written before more begins
                self._hand_out(waiting)
        finally:
            for worker in self._busy():
                self._drop(worker)

    def close(self) -> None:
        """End all workers, at once if they are busy."""
        workers = [worker for worker in self._slots if worker is not None]
        for worker in workers:
            worker.dismiss()  # all first, so that they end at the same time
        for worker in workers:
            worker.stop()
        self._slots = [None] * len(self._slots)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _prepare(self, evaluator: Evaluator) -> None:
        content = pickled(evaluator)
        if content != self._pickled:
            self.close()
            self._pickled = content

    def _busy(self) -> list[Worker]:
        return [worker for worker in self._slots if worker is not None and worker.request is not None]

    def _drop(self, worker: Worker) -> None:
        worker.kill()
        self._slots[self._slots.index(worker)] = None

    def _hand_out(self, waiting: Iterator[EvaluationRequest]) -> None:
        for i, worker in enumerate(self._slots):
            if worker is not None and worker.request is not None:
                continue
            request = next(waiting, None)
            if request is None:
                return
            if worker is None or not worker.is_alive():
                if worker is not None:
                    worker.kill()
                worker = self._slots[i] = Worker(self._pickled)
            worker.give(request)

    def _collect(self, busy: list[Worker]) -> Iterator[Replicate]:
        """Wait for something to happen to the busy workers and yield the calls that ended."""
        wait([worker.answers for worker in busy if worker.told_to_stop is None], timeout=self._patience(busy))
        for worker in busy:
            if worker.told_to_stop is not None:
                if worker.is_deserted() or time.perf_counter() - worker.told_to_stop >= GRACE_SECONDS:
                    yield self._end_overdue(worker)
                continue
            is_alive = worker.is_alive()  # asked before the pipe, so that a last answer is not missed
            if worker.has_answer():
                replicate = self._receive(worker)
                if replicate is not None:
                    yield replicate
            elif not is_alive:
                yield self._bury(worker)
            elif worker.is_overdue(self.timeout_seconds):
                worker.terminate()

    def _patience(self, busy: list[Worker]) -> float:
        if self.timeout_seconds is None:
            return LONGEST_WAIT
        if any(worker.told_to_stop is not None for worker in busy):
            return GRACE_STEP
        starts = [worker.started for worker in busy if worker.started is not None]
        remaining = min(starts, default=time.perf_counter()) + self.timeout_seconds - time.perf_counter()
        return min(max(remaining, 0.0), LONGEST_WAIT)

    def _receive(self, worker: Worker) -> Replicate | None:
        """Return the record in a worker's message; None if it only said that it is ready."""
        try:
            message = worker.receive()
        except (EOFError, OSError):
            return self._bury(worker)
        if isinstance(message, str):
            self._drop(worker)
            raise UsageError(f"a worker process could not load the evaluator: {message}")
        return message

    def _end(self, worker: Worker) -> tuple[EvaluationRequest, float]:
        """Kill a busy worker; return what it was at and for how long [s]."""
        request = worker.request
        assert request is not None
        seconds = time.perf_counter() - (worker.started or time.perf_counter())
        self._drop(worker)
        shorten_logs(request)
        return request, seconds

    def _end_overdue(self, worker: Worker) -> Replicate:
        request, seconds = self._end(worker)
        error = f"ran past its time limit of {self.timeout_seconds:g} s and was killed"
        return answer(request, Outcome(state=State.TIMEOUT, error=error), seconds)

    def _bury(self, worker: Worker) -> Replicate:
        """Turn the death of a busy worker into its call's outcome.

        Raises
        ------
        UsageError
            If it died before it had loaded the evaluator, as every other would.
        """
        was_loaded = worker.started is not None
        worker.wait(BURIAL_SECONDS)
        request, seconds = self._end(worker)
        reason = f"the worker process ended: {describe_status(worker.process.returncode)}"
        if not was_loaded:
            raise UsageError(f"{reason}, before it had loaded the evaluator")
        return answer(request, failure(reason), seconds)
