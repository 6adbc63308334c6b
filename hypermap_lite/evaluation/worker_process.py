"""A worker process seen from its parent: started, spoken to over two pipes, ended with all it started."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import pickletools
import signal
import subprocess
import sys
import time
from multiprocessing.connection import Connection
from typing import Final

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.command import THREAD_CAPS
from hypermap_lite.evaluation.evaluator import EvaluationRequest, Evaluator
from hypermap_lite.evaluation.outcome import Replicate
from hypermap_lite.evaluation.sessions import kill_all, members, signal_all
from hypermap_lite.history.lock import held_descriptors

THREAD_VARIABLES: Final = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "NUMEXPR_NUM_THREADS",
)
"""Set to 1 in workers unless the user set them: n workers share the cores, and results must not depend on n."""

FAREWELL_SECONDS: Final = 2.0
"""How long a worker whose pipe has closed, or that is no longer needed, may take to end by itself [s]."""

BOOT: Final = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
    "from hypermap_lite.evaluation.worker import main; main(*map(int, sys.argv[2:]))"
)
"""Program of a worker: the parent's module path, then `hypermap_lite.evaluation.worker`; never the user's script."""


class Worker:
    """One worker process, leader of its own session and process group.

    It holds the locks of run folders that this process holds, so that a folder is free only when all have ended.

    Parameters
    ----------
    evaluator
        The black box, from `pickled`.
    """

    def __init__(self, evaluator: bytes) -> None:
        requests, to_worker = os.pipe()
        from_worker, answers = os.pipe()
        try:
            self.process = _start(requests, answers)
        finally:
            os.close(requests)
            os.close(answers)
        self.answers = Connection(from_worker, writable=False)
        self._requests = Connection(to_worker, readable=False)
        self.request: EvaluationRequest | None = None
        """The call it is at; None while it is idle."""
        self.started: float | None = None
        """When the call began, by `time.perf_counter` [s]; None while the evaluator is being loaded."""
        self.told_to_stop: float | None = None
        """When it was sent SIGTERM, by `time.perf_counter` [s]."""
        self._is_loaded = False
        self._send(evaluator)

    def _send(self, content: bytes) -> None:
        with contextlib.suppress(BrokenPipeError):  # it died; `is_alive` tells
            self._requests.send_bytes(content)

    def give(self, request: EvaluationRequest) -> None:
        """Hand over the next call."""
        self.request = request
        self.started = time.perf_counter() if self._is_loaded else None
        self._send(pickle.dumps(request))

    def has_answer(self) -> bool:
        """Tell whether `receive` would return (or fail) at once."""
        return self.answers.poll()

    def receive(self) -> Replicate | str | None:
        """Return a finished call, None for news without a result, or why the evaluator could not be loaded.

        An answer to another request than the one it is at is no result.

        Raises
        ------
        EOFError, OSError
            If the worker is gone.
        """
        message: Replicate | str | None = self.answers.recv()
        if message is None:
            self._is_loaded = True
            self.started = time.perf_counter()
        elif isinstance(message, Replicate):
            if self.request is None or _call_of(message) != _call_of(self.request):
                return None
            self.request = None
        return message

    def is_overdue(self, limit: float | None) -> bool:
        """Tell whether the present call has run for longer than the limit [s]."""
        return limit is not None and self.started is not None and time.perf_counter() - self.started >= limit

    def is_alive(self) -> bool:
        """Tell whether the process runs; a dead one is left unreaped, so that its group can still be addressed."""
        if self.process.returncode is not None:
            return False
        return os.waitid(os.P_PID, self.process.pid, os.WEXITED | os.WNOWAIT | os.WNOHANG) is None

    def terminate(self) -> None:
        """Ask the process and all it started to end."""
        self.told_to_stop = time.perf_counter()
        signal_all(self.process.pid, signal.SIGTERM)

    def is_deserted(self) -> bool:
        """Tell whether nothing is left of its session but the guardian."""
        return not self.is_alive() and len(members(self.process.pid)) <= 1

    def kill(self) -> None:
        """Kill the process and all it started at once."""
        if self.process.returncode is None:
            with contextlib.suppress(ProcessLookupError, PermissionError):  # macOS: only zombies are left
                os.killpg(self.process.pid, signal.SIGKILL)
            kill_all(self.process.pid)  # not reaped yet: the number is still its own
            self.process.wait()
        self._requests.close()
        self.answers.close()

    def dismiss(self) -> None:
        """Tell an idle worker to end."""
        if self.request is None and self.is_alive():
            self._send(pickle.dumps(None))

    def stop(self) -> None:
        """Let a worker that was dismissed end by itself, then kill what is left of its group."""
        if self.request is None:
            self.wait(FAREWELL_SECONDS)
        self.kill()

    def wait(self, seconds: float) -> None:
        """Wait until the process has ended by itself, but not for longer than some time."""
        deadline = time.perf_counter() + seconds
        while self.is_alive() and time.perf_counter() < deadline:
            time.sleep(0.002)


def _call_of(record: EvaluationRequest | Replicate) -> tuple[int, int]:
    return record.trial, record.replicate


def _start(requests: int, answers: int) -> subprocess.Popen[bytes]:
    capped = [name for name in THREAD_VARIABLES if name not in os.environ]
    environment = os.environ | dict.fromkeys(capped, "1") | {THREAD_CAPS: " ".join(capped)}
    descriptors = (requests, answers, *held_descriptors())
    return subprocess.Popen(
        [sys.executable, "-c", BOOT, json.dumps(sys.path), *map(str, descriptors)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        env=environment,
        pass_fds=descriptors,
        start_new_session=True,
    )


def pickled(evaluator: Evaluator) -> bytes:
    """Return an evaluator as bytes that another process can load.

    Raises
    ------
    UsageError
        If it holds something that only exists in this process: a lambda, a nested function, or one of the script
        that is being run.
    """
    try:
        content = pickle.dumps(evaluator)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise UsageError(_ADVICE.format(problem=error)) from error
    if any(argument == "__main__" for _, argument, _ in pickletools.genops(content)):
        raise UsageError(_ADVICE.format(problem="it is defined in the script that is being run"))
    return content


_ADVICE: Final = (
    "the function cannot be sent to a worker process: {problem}\n"
    "  hint: Move it to the top level of a module of its own and import it, or use one worker and no time limit."
)
