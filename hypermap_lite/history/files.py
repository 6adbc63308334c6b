"""Writing files so that a crash, a kill or a full disk leaves either the old content or the new one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hypermap_lite.errors import RunFolderError


def write_atomically(path: Path, text: str) -> None:
    """Replace a file's content as a whole: temporary file, fsync, rename, fsync of the folder.

    Raises
    ------
    RunFolderError
        If the disk is full or the folder cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    with explained(path):
        try:
            with temporary.open("wb") as file:
                file.write(encode(text))
                file.flush()
                os.fsync(file.fileno())
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
        sync_folder(path.parent)


def append_durably(path: Path, text: str) -> None:
    """Add text to the end of a file and wait until it is on the disk.

    Raises
    ------
    RunFolderError
        If the disk is full or the file cannot be written.
    """
    with explained(path):
        is_new = not path.exists()
        with path.open("ab", buffering=0) as file:
            remaining = memoryview(encode(text))
            while remaining:
                remaining = remaining[file.write(remaining) :]
            os.fsync(file.fileno())
        if is_new:
            sync_folder(path.parent)


def truncate(path: Path, length: int) -> None:
    """Cut a file to its first `length` bytes and wait until that is on the disk."""
    with explained(path), path.open("r+b") as file:
        file.truncate(length)
        os.fsync(file.fileno())


def make_folder(path: Path) -> None:
    """Create a folder with its parents, each entry on the disk when this returns; existing ones are fine."""
    with explained(path):
        missing = [folder for folder in (path, *path.parents) if not folder.exists()]
        path.mkdir(parents=True, exist_ok=True)
        for folder in missing:
            sync_folder(folder.parent)


def sync_folder(path: Path) -> None:
    """Make the entries of a folder (new and renamed files) survive a power cut."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def encode(text: str) -> bytes:
    """Return text as UTF-8; what UTF-8 cannot hold (half a surrogate pair) is spelt out with a backslash."""
    return text.encode("utf-8", errors="backslashreplace")


@contextmanager
def explained(path: Path) -> Iterator[None]:
    """Turn an operating system error met while writing into a `RunFolderError` that names the file."""
    try:
        yield
    except OSError as error:
        place = error.filename if isinstance(error.filename, str) else path
        raise RunFolderError(
            f"{path}: cannot be written: {error.strerror} ({place})\n"
            "  hint: Free some space or choose another folder with --output-dir, then give the same command again; "
            "everything finished so far is kept."
        ) from error
