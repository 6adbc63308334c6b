"""Tests for streams.py."""

import errno
import io
import os
import subprocess
import sys

import pytest

from hypermap_lite.cli.streams import WatchedStream, robust_streams


class Broken(io.StringIO):
    def write(self, text):
        raise BrokenPipeError(errno.EPIPE, "Broken pipe")

    def flush(self):
        self.write("")


def test_stream_passes_on_what_it_can():
    stream = WatchedStream(inner := io.StringIO())
    print("text", file=stream, flush=True)
    assert inner.getvalue() == "text\n"
    assert not stream.isatty()


def test_lenient_stream_drops_what_nobody_takes():
    stream = WatchedStream(Broken(), is_lenient=True)
    assert stream.write("text") == 4
    print("text", file=stream, flush=True)
    assert isinstance(stream.problem, BrokenPipeError)


def test_streams_take_any_character(monkeypatch):
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw := io.BytesIO(), encoding="ascii"))
    with robust_streams():
        print("1 \u00b1 2", flush=True)
    assert raw.getvalue() == b"1 \\xb1 2\n"


@pytest.mark.parametrize("name", ["stdout", "stderr"])
def test_missing_stream_is_replaced_as_long_as_the_context_lasts(monkeypatch, name):
    monkeypatch.setattr(sys, name, None)
    with robust_streams():
        print("text", file=getattr(sys, name), flush=True)
    assert getattr(sys, name) is None


def test_broken_stdout_fails_once_and_then_leads_nowhere(monkeypatch):
    read, write = os.pipe()
    os.close(read)
    with open(write, "w") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        with robust_streams() as stdout:
            print("text")
            with pytest.raises(BrokenPipeError):
                stdout.flush()
            assert isinstance(stdout.problem, BrokenPipeError)
            print("text", flush=True)


def test_closed_descriptors_are_not_given_to_the_next_file(tmp_path):
    code = (
        "from hypermap_lite.cli.streams import robust_streams\n"
        "with robust_streams(), open('file', 'w') as file: assert file.fileno() > 2"
    )
    command = f"exec '{sys.executable}' -c \"{code}\" 0<&- 1>&- 2>&-"
    root = os.path.dirname(os.path.dirname(os.path.dirname(__file__)))
    done = subprocess.run(["/bin/sh", "-c", command], cwd=tmp_path, env=os.environ | {"PYTHONPATH": root})
    assert done.returncode == 0
