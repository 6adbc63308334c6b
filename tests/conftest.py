"""What all tests need of their surroundings."""

import signal
from collections.abc import Iterator

import pytest
import scipy.linalg  # noqa: F401 - so that its threads are among those that are limited
from hypothesis import settings
from threadpoolctl import threadpool_limits

settings.register_profile("patient", deadline=None)  # a busy machine is no failure
settings.load_profile("patient")


@pytest.fixture(scope="session", autouse=True)
def one_thread() -> Iterator[None]:
    """Let linear algebra use one thread, as in suggestions: those of two test processes would wait for each other."""
    with threadpool_limits(1):
        yield


@pytest.fixture(scope="session", autouse=True)
def default_signals() -> Iterator[None]:
    """Let signals act, here and in child processes, though the tests run in the background or under nohup."""
    before = {
        signal.SIGHUP: signal.signal(signal.SIGHUP, signal.SIG_DFL),
        signal.SIGINT: signal.signal(signal.SIGINT, signal.default_int_handler),
    }
    yield
    for number, handler in before.items():
        signal.signal(number, handler)
