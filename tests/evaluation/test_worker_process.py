"""Tests for worker_process.py."""

import pickle
import subprocess
import sys

import pytest

from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.command import Command
from hypermap_lite.evaluation.worker_process import Worker, pickled
from tests.evaluation.examples import function, request


def test_worker_reports_that_it_is_loaded_and_then_its_call(tmp_path):
    worker = Worker(pickled(function("sphere")))
    worker.give(request(tmp_path))
    assert worker.started is None
    assert worker.receive() is None
    assert worker.started is not None
    assert worker.receive().outcome.values["g"] == 0.25
    assert worker.request is None
    worker.dismiss()
    worker.stop()
    assert worker.process.returncode == 0


def test_killed_worker_is_not_alive():
    worker = Worker(pickled(function("hang")))
    assert worker.is_alive()
    worker.kill()
    worker.kill()
    assert not worker.is_alive()


def test_time_limit_does_not_count_the_loading(tmp_path):
    worker = Worker(pickled(function("hang")))
    worker.give(request(tmp_path))
    assert not worker.is_overdue(0.0)
    assert worker.receive() is None
    assert worker.is_overdue(0.0)
    assert not worker.is_overdue(None)
    worker.kill()


def test_arithmetic_libraries_use_one_thread_in_workers_and_the_users_choice_stands(tmp_path, monkeypatch):
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("MKL_NUM_THREADS", "3")
    code = "import os, json; print(json.dumps({k[:3]: int(os.environ.get(k, 0)) for k in %r}))"
    names = ["OMP_NUM_THREADS", "MKL_NUM_THREADS"]
    program = Command(command=["{python}", "-c", code % names], objectives=("OMP", "MKL"))
    for evaluator, threads in ((program, {"OMP": 0, "MKL": 3}), (function("threads"), {"f": 1, "g": 3})):
        worker = Worker(pickled(evaluator))
        worker.give(request(tmp_path))
        assert worker.receive() is None
        assert worker.receive().outcome.values == threads
        worker.kill()


def test_function_of_the_running_script_is_refused(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "from hypermap_lite.errors import UsageError\n"
        "from hypermap_lite.evaluation.python_function import PythonFunction\n"
        "from hypermap_lite.evaluation.worker_process import pickled\n"
        "def f(configuration): return 1.0\n"
        "try: pickled(PythonFunction(function=f, objectives=('f',)))\n"
        "except UsageError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    assert "it is defined in the script that is being run" in done.stdout


def test_evaluator_that_holds_something_local_is_refused():
    with pytest.raises(UsageError, match="cannot be sent to a worker process"):
        pickled(lambda request: None)


def test_pickled_evaluator_is_the_same_evaluator():
    assert pickle.loads(pickled(function("sphere"))) == function("sphere")
