"""Tests for worker.py."""

import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from hypermap_lite.evaluation.worker import captured_output, restored_streams
from tests.evaluation.examples import request

PARENT = """
import sys
from pathlib import Path
from hypermap_lite.evaluation.executors import ProcessExecutor
from tests.evaluation.examples import function, request
target = sys.argv[1]
executor = ProcessExecutor(1)
list(executor.run(function("start_a_late_writer"), [request(Path(target).parent, target=target)]))
"""


def wait_for(condition, seconds=20.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)


def children_of(pid):
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def test_worker_and_what_it_started_die_with_the_parent(tmp_path):
    target = tmp_path / "late"
    command = [sys.executable, "-c", PARENT, str(target)]
    with subprocess.Popen(command, cwd=Path(__file__).parents[2], stderr=subprocess.PIPE) as parent:
        wait_for((tmp_path / "late.started").exists)
        (worker,) = children_of(parent.pid)
        grandchildren = children_of(worker)
        parent.send_signal(signal.SIGKILL)
        said = parent.stderr.read()
    assert grandchildren
    assert said == b""
    wait_for(lambda: not any(is_running(pid) for pid in (worker, *grandchildren)))
    assert not target.exists()


BUSY_PARENT = PARENT.replace("start_a_late_writer", "start_a_busy_child")


def test_worker_that_never_pauses_dies_with_the_parent_and_so_do_its_children(tmp_path):
    target = tmp_path / "pids"
    command = [sys.executable, "-c", BUSY_PARENT, str(target)]
    with subprocess.Popen(command, cwd=Path(__file__).parents[2]) as parent:
        wait_for(lambda: target.exists() and len(target.read_text().split()) == 2)
        pids = [int(pid) for pid in target.read_text().split()]
        parent.send_signal(signal.SIGKILL)
    wait_for(lambda: not any(is_running(pid) for pid in pids), seconds=5)


def is_running(pid):
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


def test_output_is_captured_down_to_the_file_descriptor(tmp_path):
    asked = request(tmp_path)
    with captured_output(asked):
        os.write(1, b"out\n")
        os.write(2, b"err\n")
    assert asked.file("stdout.log").read_text() == "out\n"
    assert asked.file("stderr.log").read_text() == "err\n"


def test_silence_leaves_no_files(tmp_path):
    with captured_output(request(tmp_path)):
        pass
    assert list(tmp_path.iterdir()) == []


def test_folder_that_cannot_be_made_does_not_stop_the_call(tmp_path):
    (tmp_path / "0000").write_text("in the way")
    with captured_output(request(tmp_path)):
        reached = True
    assert reached


def test_streams_that_the_black_box_closes_or_replaces_are_put_back(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "stdout", io.StringIO())
    monkeypatch.setattr(sys, "stderr", before := io.StringIO())
    with restored_streams():
        sys.stdout.close()
        sys.stderr = None
    assert not sys.stdout.closed
    assert sys.stderr is before
