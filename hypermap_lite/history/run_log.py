"""``run.log``: the story of a run in UTC, one line per event, added to by each continuation."""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hypermap_lite.history.files import explained

PACKAGE_LOGGER = "hypermap_lite"


class _UtcFormatter(logging.Formatter):
    converter = staticmethod(time.gmtime)
    default_time_format = "%Y-%m-%dT%H:%M:%S"
    default_msec_format = "%s.%03dZ"


class _RunLogHandler(logging.FileHandler):
    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802 - the base class's name
        """Let the line go: on a full disk the result files raise an error that is worth more."""

    def close(self) -> None:
        with contextlib.suppress(OSError):
            super().close()


@contextmanager
def run_log(path: Path) -> Iterator[None]:
    """Write what the package logs at INFO and above to a file as long as the context lasts.

    Raises
    ------
    RunFolderError
        If the file cannot be opened.
    """
    with explained(path):
        handler = _RunLogHandler(path, encoding="utf-8", errors="backslashreplace")
    handler.setFormatter(_UtcFormatter("%(asctime)s %(levelname)s %(message)s"))
    handler.setLevel(logging.INFO)
    package = logging.getLogger(PACKAGE_LOGGER)
    level = package.level
    if not package.isEnabledFor(logging.INFO):
        package.setLevel(logging.INFO)
    package.addHandler(handler)
    try:
        yield
    finally:
        package.removeHandler(handler)
        package.setLevel(level)
        handler.close()
