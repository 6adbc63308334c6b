"""The program of a worker process: load the black box once, then answer one request after the other.

A guardian beside it kills it, with everything it started, when the pipe it gets its requests from closes, that is, when
its parent has died: at once, whatever the black box is at.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import pickle
import sys
from collections.abc import Iterator
from io import TextIOWrapper
from multiprocessing.connection import Connection
from pathlib import Path
from typing import IO, Any

from hypermap_lite.evaluation.evaluator import (
    EvaluationRequest,
    Evaluator,
    call,
    forked_children_end_here,
    last_line,
)
from hypermap_lite.evaluation.logs import ENDINGS, shorten_logs
from hypermap_lite.evaluation.sessions import start_guardian


def main(requests: int, answers: int, *kept: int) -> None:
    """Serve requests.

    Parameters
    ----------
    requests, answers
        File descriptors: messages from the parent (the pickled evaluator, then requests; None for the end) and to
        it (None once the evaluator is loaded, or a text why it is not; then the finished calls).
    kept
        Other descriptors to hold until the end.
    """
    for descriptor in (requests, answers, *kept):
        os.set_inheritable(descriptor, False)  # they are no business of programs that the black box starts
    start_guardian(requests, answers)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(line_buffering=True, errors="backslashreplace")
    faulthandler.enable()
    with (
        Connection(requests, writable=False) as inbox,
        Connection(answers, readable=False) as outbox,
        contextlib.suppress(EOFError, BrokenPipeError),  # the parent is gone, and nobody waits for an answer
    ):
        _serve(inbox, outbox)


def _serve(inbox: Connection, outbox: Connection) -> None:
    evaluator = _load(inbox.recv_bytes(), outbox)
    while evaluator is not None and (request := inbox.recv()) is not None:
        with captured_output(request):
            # before the logs are tidied: it must reach the disk soon
            outbox.send(call(evaluator, request, caught=(BaseException,)))


def _load(content: bytes, outbox: Connection) -> Evaluator | None:
    try:
        with forked_children_end_here():
            evaluator: Evaluator = pickle.loads(content)
    except BaseException as error:
        outbox.send(last_line(error))
        return None
    outbox.send(None)
    return evaluator


@contextlib.contextmanager
def captured_output(request: EvaluationRequest) -> Iterator[None]:
    """Send what the process and its children print to the trial's log files; empty ones are removed.

    Streams that are closed or replaced meanwhile are put back.
    """
    logs = [request.file(ending) for ending in ENDINGS]
    _open_missing()
    try:
        request.directory.mkdir(parents=True, exist_ok=True)
        targets = [os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o644) for log in logs]
    except OSError:  # no place for logs is no reason not to evaluate
        with restored_streams():
            yield
        return
    saved = [os.dup(descriptor) for descriptor in (1, 2)]
    _redirect(targets)
    try:
        with restored_streams():
            yield
    finally:
        _redirect(saved)
        shorten_logs(request)
        _remove_empty(logs)


@contextlib.contextmanager
def restored_streams() -> Iterator[None]:
    """Flush stdout and stderr at the end, and put back what they were; a closed one is opened anew."""
    before: dict[str, Any] = {name: getattr(sys, name) for name in ("stdout", "stderr")}
    try:
        yield
    finally:
        _open_missing()
        for descriptor, (name, stream) in enumerate(before.items(), start=1):
            with contextlib.suppress(Exception):  # the black box may have put anything there
                getattr(sys, name).flush()
            setattr(sys, name, _reopened(descriptor) if stream is None or stream.closed else stream)


def _reopened(descriptor: int) -> IO[str]:
    return open(descriptor, "w", buffering=1, encoding="utf-8", errors="backslashreplace", closefd=False)


def _open_missing() -> None:
    """Give descriptors 0 to 2 a place to lead to if they have been closed, lest a file of ours takes the number."""
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # it takes the lowest free number, this one


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
