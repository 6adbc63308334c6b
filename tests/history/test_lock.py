"""Tests for lock.py."""

import errno
import os
import signal
import subprocess
import sys

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.lock import FolderLock

HOLDER = """
import sys
from pathlib import Path
from hypermap_lite.history.lock import FolderLock
with FolderLock(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_second_lock_is_refused_and_names_the_holder(tmp_path):
    with (
        FolderLock(tmp_path),
        pytest.raises(RunFolderError, match=rf"another process \(pid {os.getpid()}\) is writing"),
        FolderLock(tmp_path),
    ):
        pass


def test_lock_can_be_taken_again_after_release(tmp_path):
    for _ in range(2):
        with FolderLock(tmp_path / "new"):
            assert (tmp_path / "new" / ".lock").read_text() == f"{os.getpid()}\n"


def test_lock_of_a_killed_process_is_free(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as holder:
        assert holder.stdout.readline() == b"held\n"
        with pytest.raises(RunFolderError, match=f"pid {holder.pid}"), FolderLock(tmp_path):
            pass
        holder.send_signal(signal.SIGKILL)
        holder.wait()
        with FolderLock(tmp_path):
            pass


def test_file_system_without_locks_is_only_warned_of(tmp_path, monkeypatch, caplog):
    def refuse(descriptor, operation):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    with FolderLock(tmp_path):
        assert "no locks" in caplog.text
