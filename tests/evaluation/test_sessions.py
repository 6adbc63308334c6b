"""Tests for sessions.py."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from hypermap_lite.evaluation.sessions import kill_all, members, signal_all
from tests.evaluation.test_worker import is_running, wait_for

TREE = "set -m; sleep 60 & (sleep 60 & echo $! ; wait) & echo $!; wait"
"""With job control, so each child gets a process group of its own."""

GUARDED = """
import os, sys
from hypermap_lite.evaluation.sessions import start_guardian
start_guardian(int(sys.argv[1]))
try:
    os.wait()
except ChildProcessError:
    print("no child", flush=True)
while True:  # no other thread has its turn
    sum(range(10**9))
"""


def start_tree():
    tree = subprocess.Popen(["/bin/bash", "-c", TREE], start_new_session=True, stdout=subprocess.PIPE)
    tree.stdout.readline()
    wait_for(lambda: len(members(tree.pid)) >= 4)
    return tree


def test_members_are_all_processes_of_the_session_and_no_other():
    with start_tree() as tree:
        pids = members(tree.pid)
        assert tree.pid in pids
        assert os.getpid() not in pids
        assert len({os.getpgid(pid) for pid in pids}) > 1
        kill_all(tree.pid)
    assert not any(is_running(pid) for pid in pids)


def test_killed_session_has_no_members_though_it_is_not_reaped():
    with start_tree() as tree:
        kill_all(tree.pid)
        assert members(tree.pid) == []
        assert tree.poll() == -signal.SIGKILL


def test_signal_reaches_every_member(tmp_path):
    with start_tree() as tree:
        signal_all(tree.pid, signal.SIGTERM)
        wait_for(lambda: not members(tree.pid) or signal_all(tree.pid, signal.SIGTERM))


def test_guardian_kills_a_process_that_never_pauses_once_the_pipe_closes():
    read, write = os.pipe()
    root = Path(__file__).parents[2]
    command = [sys.executable, "-c", GUARDED, str(read)]
    with subprocess.Popen(
        command, cwd=root, pass_fds=(read,), start_new_session=True, stdout=subprocess.PIPE
    ) as guarded:
        assert guarded.stdout.readline() == b"no child\n"
        assert len(members(guarded.pid)) == 2
        os.close(write)
        assert guarded.wait(20) == -signal.SIGKILL
    os.close(read)
