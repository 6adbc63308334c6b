"""All processes of a session: what a worker started, and what that started, however deep and in whatever group.

A session is left only by a process that asks for one of its own (a daemon); such a one is out of reach.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final

LONGEST_KILL: Final = 2.0
"""Time after which processes that do not even die of SIGKILL (stuck in a system call) are left alone [s]."""


def members(session: int) -> list[int]:
    """Return the process ids in a session, without those that have ended and wait to be reaped."""
    return [pid for pid, state in _processes() if state != "Z" and _is_in(pid, session)]


def _is_in(pid: int, session: int) -> bool:
    try:
        return os.getsid(pid) == session
    except OSError:  # it is gone
        return False


def _processes() -> Iterator[tuple[int, str]]:
    """Yield process id and state of every process there is."""
    if Path("/proc/self/stat").exists():
        for name in os.listdir("/proc"):
            with contextlib.suppress(OSError):
                if name.isdigit():
                    yield int(name), Path("/proc", name, "stat").read_bytes().rpartition(b")")[2].split()[0].decode()
        return
    listing = subprocess.run(["ps", "-A", "-o", "pid=,stat="], capture_output=True, text=True, check=False).stdout
    for line in listing.splitlines():
        pid, state = line.split()[:2]
        yield int(pid), state[0]


def signal_all(session: int, number: signal.Signals) -> None:
    """Send a signal to every process of a session but this one."""
    for pid in members(session):
        if pid != os.getpid():
            with contextlib.suppress(OSError):
                os.kill(pid, number)


def kill_all(session: int) -> None:
    """Kill every process of a session but this one, those that they start meanwhile included."""
    deadline = time.monotonic() + LONGEST_KILL
    while set(members(session)) - {os.getpid()} and time.monotonic() < deadline:
        signal_all(session, signal.SIGKILL)
        time.sleep(0.001)


def start_guardian(pipe: int, *unused: int) -> None:
    """Start a process that kills this session, and itself, once nobody can write to a pipe any more.

    It is no child of this process, which may wait for its own as it likes. Being a process, it is not held up by
    whatever this one does, such as computing for hours without letting another thread have its turn.

    Parameters
    ----------
    pipe
        The end that is read here; nothing is read from it.
    unused
        Descriptors that it must not keep open.
    """
    child = os.fork()
    if child:
        os.waitpid(child, 0)
        return
    try:
        if os.fork() == 0:
            for descriptor in unused:
                os.close(descriptor)
            _guard(pipe)
    finally:
        os._exit(0)


def _guard(pipe: int) -> None:
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    os.setpgid(0, 0)
    poll = select.poll()
    poll.register(pipe, 0)  # no data, only the end of it
    poll.poll()
    kill_all(os.getsid(0))
