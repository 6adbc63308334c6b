"""Ctrl-C and SIGTERM during a run: the first Ctrl-C ends it in order, everything else at once."""

from __future__ import annotations

import contextlib
import os
import signal
from types import FrameType, TracebackType
from typing import Final, Self

AT_ONCE: Final = (signal.SIGTERM, signal.SIGHUP)

NOTICE: Final = b"\nCtrl-C: waiting for the evaluations that are running; press it again to stop at once.\n"


class StoppedAtOnce(BaseException):
    """Raised in the main thread wherever it is; what runs is killed on the way out."""

    def __init__(self, number: int) -> None:
        self.exit_status = 128 + number
        super().__init__(number)


class StopSignals:
    """Context manager that turns signals into a wish to stop, and then into `StoppedAtOnce`."""

    def __init__(self) -> None:
        self.is_requested = False
        """Whether Ctrl-C was pressed once."""
        self._previous: dict[signal.Signals, object] = {}

    def __enter__(self) -> Self:
        """Install the handlers; a signal that is ignored (nohup) stays ignored."""
        handlers = {signal.SIGINT: self._interrupt} | dict.fromkeys(AT_ONCE, self._stop)
        for number, handler in handlers.items():
            if signal.getsignal(number) is not signal.SIG_IGN:
                self._previous[number] = signal.signal(number, handler)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Put the former handlers back."""
        for number, handler in self._previous.items():
            signal.signal(number, handler)  # type: ignore[arg-type]  # whatever it was, it came from there

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if self.is_requested:
            raise StoppedAtOnce(number)
        self.is_requested = True
        with contextlib.suppress(OSError):  # the wish counts though nobody reads the notice
            os.write(2, NOTICE)  # not through a stream, in whose midst we may be

    def _stop(self, number: int, frame: FrameType | None) -> None:
        raise StoppedAtOnce(number)
