"""The program of a worker process: load the black box once, then answer one request after the other.

It ends, with everything it started, when the pipe it gets its requests from closes: that is how it learns that its
parent has died.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import pickle
import signal
import sys
import threading
from collections.abc import Iterator
from io import TextIOWrapper
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue

from hypermap_lite.evaluation.evaluator import EvaluationRequest, Evaluator, call, last_line
from hypermap_lite.evaluation.outcome import Replicate


def main(requests: int, answers: int) -> None:
    """Serve requests.

    Parameters
    ----------
    requests, answers
        File descriptors: messages from the parent (the pickled evaluator, then requests; None for the end) and to
        it (None once the evaluator is loaded, or a text why it is not; then the finished calls).
    """
    inbox: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_receive, args=(Connection(requests, writable=False), inbox), daemon=True).start()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(line_buffering=True, errors="backslashreplace")
    faulthandler.enable()
    with Connection(answers, readable=False) as outbox:
        evaluator = _load(inbox.get(), outbox)
        while evaluator is not None and (request := pickle.loads(inbox.get())) is not None:
            with captured_output(request):
                _send(outbox, call(evaluator, request))  # before the logs are tidied: it must reach the disk soon


def _send(outbox: Connection, replicate: Replicate) -> None:
    try:
        outbox.send(replicate)
    except BrokenPipeError:
        end_group()


def _receive(source: Connection, inbox: SimpleQueue[bytes]) -> None:
    """Move messages to the inbox; when the parent is gone, kill this process group."""
    while True:
        try:
            inbox.put(source.recv_bytes())
        except (EOFError, OSError):
            end_group()


def end_group() -> None:
    """Kill this process and everything it started: the parent is gone, and nobody waits for an answer."""
    os.killpg(0, signal.SIGKILL)


def _load(content: bytes, outbox: Connection) -> Evaluator | None:
    try:
        evaluator: Evaluator = pickle.loads(content)
    except (Exception, SystemExit) as error:
        outbox.send(last_line(error))
        return None
    outbox.send(None)
    return evaluator


@contextlib.contextmanager
def captured_output(request: EvaluationRequest) -> Iterator[None]:
    """Send what the process and its children print to the trial's log files; empty ones are removed."""
    logs = [request.file("stdout.log"), request.file("stderr.log")]
    try:
        request.directory.mkdir(parents=True, exist_ok=True)
        targets = [os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o644) for log in logs]
    except OSError:  # no place for logs is no reason not to evaluate
        yield
        return
    saved = [os.dup(descriptor) for descriptor in (1, 2)]
    _redirect(targets)
    try:
        yield
    finally:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        _redirect(saved)
        _remove_empty(logs)


def _redirect(sources: list[int]) -> None:
    """Make descriptors 1 and 2 copies of two others, which are closed."""
    for target, source in zip((1, 2), sources, strict=True):
        os.dup2(source, target)
        os.close(source)


def _remove_empty(logs: list[Path]) -> None:
    with contextlib.suppress(OSError):
        for log in logs:
            if log.stat().st_size == 0:
                log.unlink()
        logs[0].parent.rmdir()  # only succeeds if nothing is in it
