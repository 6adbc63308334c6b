"""Lines of text to and from the process at the other end of two pipes, each with a deadline."""

from __future__ import annotations

import contextlib
import fcntl
import os
import select
import sys
import time
from collections.abc import Iterator
from typing import Final

from hypermap_lite.errors import ClientError

CHUNK: Final = 512
"""What a pipe that has room takes without making its writer wait: the least POSIX allows for PIPE_BUF [bytes]."""

READ_SIZE: Final = 1 << 16


class Channel:
    """Two file descriptors, spoken through line by line.

    Parameters
    ----------
    inbox, outbox
        Where lines come from and go to; not closed by this object.
    """

    def __init__(self, inbox: int, outbox: int) -> None:
        self._inbox = inbox
        self._outbox = outbox
        self._unread = b""

    def write_line(self, text: str, deadline: float | None = None) -> None:
        """Write a line, at once and whole.

        Raises
        ------
        ClientError
            If nobody reads any more, or not until the deadline (by `time.monotonic` [s]).
        """
        remaining = f"{text}\n".encode()
        try:
            while remaining:
                _wait(self._outbox, select.POLLOUT, deadline)
                remaining = remaining[os.write(self._outbox, remaining[:CHUNK]) :]
        except TimeoutError:
            raise ClientError("the client does not read what it is sent") from None
        except OSError as error:
            raise ClientError(f"the client no longer reads what it is sent ({error.strerror})") from error

    def read_line(self, deadline: float | None = None) -> str | None:
        """Return the next line without its end, or None if there will be none.

        Raises
        ------
        TimeoutError
            If it is not there at the deadline (by `time.monotonic` [s]).
        ClientError
            If the other side stops in the middle of a line: the rest of it may be missing.
        """
        while b"\n" not in self._unread:
            _wait(self._inbox, select.POLLIN, deadline)
            chunk = self._read()
            if not chunk:
                if self._unread.strip():
                    raise ClientError(f"the client stopped in the middle of a line: {_shown(self._unread)}")
                return None
            self._unread += chunk
        line, _, self._unread = self._unread.partition(b"\n")
        return line.decode("utf-8", errors="replace").rstrip("\r")

    def line_too_many(self) -> str:
        """Return what has arrived already although nobody has asked for it; nothing, as a rule."""
        while True:
            try:
                _wait(self._inbox, select.POLLIN, time.monotonic())
            except TimeoutError:
                break
            chunk = self._read()
            if not chunk:
                break
            self._unread += chunk
        line = self._unread.strip().partition(b"\n")[0]
        return line.decode("utf-8", errors="replace")

    def _read(self) -> bytes:
        try:
            return os.read(self._inbox, READ_SIZE)
        except OSError:  # whoever held the other end is gone
            return b""


def _shown(line: bytes) -> str:
    return repr(line.decode("utf-8", errors="replace")[:80])


def _wait(descriptor: int, event: int, deadline: float | None) -> None:
    """Return once a descriptor is ready, or broken; a `TimeoutError` at the deadline."""
    poll = select.poll()
    poll.register(descriptor, event)
    patience = None if deadline is None else max(deadline - time.monotonic(), 0.0) * 1000
    if not poll.poll(patience):
        raise TimeoutError


@contextlib.contextmanager
def standard_channel(*, is_given_back: bool = True) -> Iterator[Channel]:
    """Take stdin and stdout for a channel, and keep everybody else off them.

    As long as the context lasts, whatever is written to stdout, by Python or by a library in C, goes to stderr, and
    stdin is empty.

    Parameters
    ----------
    is_given_back
        Whether the two are as before at the end; else nothing more is ever written to them.
    """
    sys.stdout.flush()
    inbox, outbox = (fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, 3) for descriptor in (0, 1))
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 0)
    try:
        os.dup2(2, 1)
    except OSError:  # stderr is closed
        os.dup2(nowhere, 1)
    os.close(nowhere)
    try:
        yield Channel(inbox, outbox)
    finally:
        with contextlib.suppress(OSError):
            sys.stdout.flush()
        if is_given_back:
            os.dup2(inbox, 0)
            os.dup2(outbox, 1)
        os.close(inbox)
        os.close(outbox)
