"""Tests for signals.py."""

import os
import signal

import pytest

from hypermap_lite.cli.signals import StoppedAtOnce, StopSignals


def test_first_interrupt_is_a_wish_and_the_second_a_command(capfd):
    with StopSignals() as signals:
        assert not signals.is_requested
        os.kill(os.getpid(), signal.SIGINT)
        assert signals.is_requested
        with pytest.raises(StoppedAtOnce) as caught:
            os.kill(os.getpid(), signal.SIGINT)
    assert caught.value.exit_status == 130
    assert "press it again" in capfd.readouterr().err


@pytest.mark.parametrize(("number", "status"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_terminate_and_hang_up_stop_at_once(number, status):
    with pytest.raises(StoppedAtOnce) as caught, StopSignals():
        os.kill(os.getpid(), number)
    assert caught.value.exit_status == status


def test_former_handlers_come_back():
    before = signal.getsignal(signal.SIGINT)
    with StopSignals():
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before


def test_ignored_signal_stays_ignored():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with StopSignals():
            os.kill(os.getpid(), signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_notice_that_cannot_be_written_does_not_spoil_the_wish(monkeypatch):
    def refuse(descriptor, text):
        raise BrokenPipeError

    with StopSignals() as signals:
        monkeypatch.setattr("hypermap_lite.cli.signals.os.write", refuse)
        os.kill(os.getpid(), signal.SIGINT)
        assert signals.is_requested
