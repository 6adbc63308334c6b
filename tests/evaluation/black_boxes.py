"""Functions that behave well or badly, importable by worker processes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path


def sphere(configuration, seed):
    x = configuration["x"]
    return {"f": x**2 + seed * 1e-12, "g": (x - 1) ** 2, "pid": os.getpid()}


def crash(configuration):
    raise RuntimeError("no\nsuch   luck")


def crash_sometimes(configuration, trial):
    if trial in (0, 3):
        raise ValueError(f"trial {trial}")
    return {"f": configuration["x"], "g": -configuration["x"]}


def segfault(configuration):
    os.kill(os.getpid(), signal.SIGSEGV)


def exit_at_once(configuration):
    os._exit(3)


def exit_politely(configuration):
    sys.exit("enough")


def chatty(configuration):
    print("on stdout")
    print("on stderr", file=sys.stderr)
    subprocess.run(["/bin/sh", "-c", "echo from a child"], check=True)
    return {"f": 1.0, "g": 2.0}


def hang(configuration):
    time.sleep(60)


def start_a_late_writer(configuration):
    """Start a child that would write a file 0.6 s from now, and hang."""
    target = configuration["target"]
    subprocess.Popen(["/bin/sh", "-c", f"sleep 0.6; echo late > {target}"])
    Path(f"{target}.started").write_text("")
    time.sleep(60)


def wait_for_others(configuration, trial):
    """Return once as many calls as `configuration["together"]` are under way at the same time."""
    folder = Path(configuration["folder"])
    (folder / f"started_{trial}").write_text("")
    deadline = time.monotonic() + 20
    while len(list(folder.glob("started_*"))) < configuration["together"]:
        if time.monotonic() > deadline:
            raise TimeoutError("nobody else came")
        time.sleep(0.005)
    return {"f": 1.0, "g": 2.0}


class RefusesToLoad:
    """Pickles, but does not unpickle."""

    def __reduce__(self):
        return _refuse, ()

    def __call__(self, request):
        raise AssertionError


def _refuse():
    raise ImportError("no such library")


class DiesWhileLoading:
    def __reduce__(self):
        return os._exit, (5,)

    def __call__(self, request):
        raise AssertionError


NOT_CALLABLE = 3


def threads(configuration):
    return {"f": int(os.environ["OMP_NUM_THREADS"]), "g": int(os.environ["MKL_NUM_THREADS"])}
