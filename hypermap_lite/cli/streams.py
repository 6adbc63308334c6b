"""Standard streams that may be closed, may break, or cannot show every character."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import Any, cast


class WatchedStream:
    """Writes to a stream and remembers if that fails; everything else is the stream's own.

    Parameters
    ----------
    stream
        Where to write. Once that has failed, it leads nowhere.
    is_lenient
        Say nothing of it: a message that nobody can read is no reason to end otherwise than one would.
    """

    def __init__(self, stream: Any, *, is_lenient: bool = False) -> None:
        self._stream = stream
        self._is_lenient = is_lenient
        self.problem: OSError | None = None
        """Why the first write that failed did so."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write text."""
        with self._watched():
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Write what has been kept back."""
        with self._watched():
            self._stream.flush()

    @contextlib.contextmanager
    def _watched(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            self.problem = self.problem or error
            _discard(self._stream)
            if not self._is_lenient:
                raise


@contextlib.contextmanager
def robust_streams() -> Iterator[WatchedStream]:
    """Make stdout and stderr take any character, replace those that are closed, and let stderr break unnoticed.

    Yields
    ------
    WatchedStream
        What stdout is meanwhile.
    """
    _open_missing_descriptors()
    with contextlib.ExitStack() as stack:
        for name in ("stdout", "stderr"):
            stream = getattr(sys, name)
            if stream is None:  # Python found it closed
                stream = stack.enter_context(open(os.devnull, "w", encoding="utf-8"))
                stack.callback(setattr, sys, name, None)
                setattr(sys, name, stream)
            if hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="backslashreplace")
        stdout = WatchedStream(sys.stdout)
        stack.enter_context(contextlib.redirect_stdout(cast(Any, stdout)))
        stack.enter_context(contextlib.redirect_stderr(cast(Any, WatchedStream(sys.stderr, is_lenient=True))))
        yield stdout


def _open_missing_descriptors() -> None:
    """Let closed descriptors 0 to 2 lead nowhere, lest the next file that is opened gets one of these numbers."""
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # it takes the lowest free number, this one


def _discard(stream: Any) -> None:
    """Let a broken stream lead nowhere, with all that it still holds, so that the interpreter ends in peace."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
