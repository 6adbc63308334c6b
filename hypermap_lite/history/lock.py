"""One writer per run folder: an advisory lock that the kernel drops when its holder dies."""

from __future__ import annotations

import errno
import fcntl
import logging
import os
from pathlib import Path
from types import TracebackType
from typing import Self

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.files import explained, make_folder

logger = logging.getLogger(__name__)

LOCK_FILE = ".lock"


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
        return self

    def _lock(self, descriptor: int) -> None:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            holder = os.pread(descriptor, 32, 0).decode(errors="replace").strip() or "unknown"
            raise RunFolderError(
                f"{self.path.parent}: another process (pid {holder}) is writing this run folder\n"
                "  hint: Wait for it, stop it, or choose another folder with --output-dir."
            ) from error
        except OSError as error:
            if error.errno not in (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP):
                raise
            logger.warning("%s: this file system has no locks; do not start a second run here", self.path.parent)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Release the lock."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None
