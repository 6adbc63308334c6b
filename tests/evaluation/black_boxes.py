"""Functions that behave well or badly, importable by worker processes."""

from __future__ import annotations

import contextlib
import os
import signal
import stat
import subprocess
import sys
import time
from multiprocessing.connection import Connection
from pathlib import Path

from hypermap_lite.evaluation.evaluator import EvaluationRequest, answer
from hypermap_lite.evaluation.outcome import Outcome, State


def sphere(configuration, seed):
    x = configuration["x"]
    return {"f": x**2 + seed * 1e-12, "g": (x - 1) ** 2, "pid": os.getpid()}


def scattering(configuration, seed):
    x, noise = configuration["x"], (seed % 1000) / 1e6
    return {"f": x**2 + noise, "g": (x - 0.5) ** 2 + noise}


def sum_and_difference(configuration):
    return {"f": configuration["x"] + 1, "g": configuration["x"] - 1}


def fork(configuration, trial):
    """Leave a child behind that comes back from here as well, in some way."""
    child = os.fork()
    if child == 0 and trial % 2:
        sys.exit("the child")
    if child:
        os.waitpid(child, 0)
    return {"f": trial, "g": 0.0, "pid": os.getpid()}


def answer_for_another(configuration, trial):
    """Send a record through every pipe there is, as a confused child would, and return."""
    asked = EvaluationRequest(trial=trial + 1, replicate=0, seed=1, configuration={}, directory=Path())
    stray = answer(asked, Outcome(state=State.COMPLETED, values={"f": -1.0, "g": -1.0}), 0.0)
    for descriptor in range(3, 20):
        with contextlib.suppress(OSError):
            if stat.S_ISFIFO(os.fstat(descriptor).st_mode):
                connection = Connection(os.dup(descriptor), readable=False)
                connection.send(stray)
                connection.close()
    return {"f": trial, "g": 0.0}


def interrupt(configuration):
    raise KeyboardInterrupt


def close_everything(configuration):
    os.closerange(3, 4096)
    return {"f": 1.0, "g": 2.0}


def close_stdout(configuration, trial):
    print(f"trial {trial}")
    sys.stdout.close()
    if trial == 1:
        os.close(1)
    if trial == 2:
        sys.stderr = None
    return {"f": 1.0, "g": 2.0}


def talk_much(configuration):
    print("first")
    print("x" * 4_000_000)
    print("last")
    return {"f": 1.0, "g": 2.0}


def talk_much_and_hang(configuration):
    talk_much(configuration)
    hang(configuration)


def stop_when_told(configuration):
    """Note in a file that SIGTERM came, as a program that stops its robot would."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(Path(configuration["target"]).write_text("stopped")))
    time.sleep(60)


def ignore_sigterm(configuration):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    time.sleep(60)


def start_a_busy_child(configuration):
    """Hold the interpreter for good, with a child in a process group of its own."""
    child = subprocess.Popen(["/bin/sleep", "60"], process_group=0)
    Path(configuration["target"]).write_text(f"{os.getpid()} {child.pid}")
    while True:
        sum(range(10**9))


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


def note_that_it_began(configuration, trial):
    """Leave a file in the trial's folder, which is the only one there is to write to."""
    folder = Path(os.readlink("/proc/self/fd/1")).parent
    (folder / "begun").write_text("")
    return {"f": trial, "g": 0.0}


def batch_of_spheres(columns, seed, trial):
    """Take lists, return lists."""
    return {
        "f": [x**2 + s for x, s in zip(columns["x"], seed, strict=True)],
        "g": columns["x"],
        "called with": len(columns["x"]),
        "trial": trial,
    }
