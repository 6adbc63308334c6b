"""One writer per run folder: an advisory lock that the kernel drops when its holder dies."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import logging
import os
import time
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.files import explained, make_folder

logger = logging.getLogger(__name__)

LOCK_FILE = ".lock"

LONGEST_WAIT: Final = 2.0
"""How long the workers of a run that was killed may take to end [s]."""

_held: set[int] = set()


def held_descriptors() -> tuple[int, ...]:
    """Return the descriptors of all locks this process holds; who inherits one shares the lock."""
    return tuple(sorted(_held))


class FolderLock:
    """Context manager that holds the lock of a folder, created if missing.

    The lock belongs to the open file, not to the file's existence: after a SIGKILL nothing has to be cleaned up.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / LOCK_FILE
        self._descriptor: int | None = None

    def __enter__(self) -> Self:
        """Take the lock.

        Raises
        ------
        RunFolderError
            If another process holds it (its process id is named), or the folder cannot be written.
        """
        make_folder(self.path.parent)
        with explained(self.path):
            descriptor = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            self._lock(descriptor)
            os.ftruncate(descriptor, 0)
            os.pwrite(descriptor, f"{os.getpid()}\n".encode(), 0)
        except BaseException:
            os.close(descriptor)
            raise
        self._descriptor = descriptor
        _held.add(descriptor)
        return self

    def _lock(self, descriptor: int) -> None:
        deadline = time.monotonic() + LONGEST_WAIT
        try:
            while not _is_taken(descriptor):
                holder = os.pread(descriptor, 32, 0).decode(errors="replace").strip() or "unknown"
                if _is_running(holder) or time.monotonic() > deadline:
                    raise RunFolderError(
                        f"{self.path.parent}: another process (pid {holder}) is writing this run folder\n"
                        "  hint: Wait for it and its workers, stop them, or choose another folder with --output-dir."
                    )
                time.sleep(0.01)  # it was killed, and its workers are about to end
        except OSError as error:
            if error.errno not in (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP):
                raise
            logger.warning("%s: this file system has no locks; do not start a second run here", self.path.parent)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Release the lock."""
        if self._descriptor is not None:
            _held.discard(self._descriptor)
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(self._descriptor, fcntl.LOCK_UN)  # for all who inherited it
            os.close(self._descriptor)
            self._descriptor = None


def _is_taken(descriptor: int) -> bool:
    """Try to take the lock."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _is_running(pid: str) -> bool:
    """Tell whether a process may be there; one that is not known counts as being there."""
    try:
        os.kill(int(pid), 0)
    except ProcessLookupError:
        return False
    except (OSError, ValueError):
        return True
    return True
