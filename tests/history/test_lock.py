"""Tests for lock.py."""

import errno
import os
import signal
import subprocess
import sys

import pytest

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history import lock
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


WORKER = """
import os, sys
from pathlib import Path
from hypermap_lite.history.lock import FolderLock, held_descriptors
with FolderLock(Path(sys.argv[1])):
    if os.fork():
        os.kill(os.getpid(), 9)
    print("orphan", flush=True)
    sys.stdin.read()
    os._exit(0)
"""


@pytest.fixture
def orphan(tmp_path):
    """Start a worker that outlives the process whose lock it inherited, until its stdin closes."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", WORKER, str(tmp_path)], **pipes) as process:
        assert process.stdout.readline() == b"orphan\n"
        process.wait()
        yield process


def test_folder_is_taken_as_long_as_a_worker_of_a_killed_run_lives(tmp_path, orphan, monkeypatch):
    monkeypatch.setattr(lock, "LONGEST_WAIT", 0.05)
    with pytest.raises(RunFolderError, match="Wait for it and its workers"), FolderLock(tmp_path):
        pass


def test_worker_of_a_killed_run_that_is_about_to_end_is_waited_for(tmp_path, orphan, monkeypatch):
    monkeypatch.setattr(lock.time, "sleep", lambda seconds: orphan.stdin.closed or orphan.stdin.close())
    monkeypatch.setattr(lock, "LONGEST_WAIT", 20.0)
    with FolderLock(tmp_path):
        assert lock.held_descriptors()
    assert lock.held_descriptors() == ()


def test_release_counts_for_those_who_inherited_the_lock(tmp_path):
    with FolderLock(tmp_path):
        (descriptor,) = (os.dup(held) for held in lock.held_descriptors())
    with FolderLock(tmp_path):
        os.close(descriptor)
