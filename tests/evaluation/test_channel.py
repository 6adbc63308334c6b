"""Tests for channel.py."""

import os
import subprocess
import sys
import time

import pytest

from hypermap_lite.errors import ClientError
from hypermap_lite.evaluation.channel import Channel


@pytest.fixture
def ends():
    """Yield a channel and the descriptors at the other end: to write to it, and to read from it."""
    inbox, to_channel = os.pipe()
    from_channel, outbox = os.pipe()
    open_ones = {"to": to_channel, "from": from_channel, "inbox": inbox, "outbox": outbox}
    yield Channel(inbox, outbox), open_ones
    for descriptor in open_ones.values():
        os.close(descriptor)


def soon():
    return time.monotonic() + 0.05


def test_lines_come_one_by_one_whatever_way_they_are_cut(ends):
    channel, other = ends
    os.write(other["to"], b"a,b\r\n1,")
    assert channel.read_line() == "a,b"
    os.write(other["to"], b"2\n\n3,4\n")
    assert [channel.read_line(), channel.read_line(), channel.read_line()] == ["1,2", "", "3,4"]


def test_end_of_input_is_no_line(ends):
    channel, other = ends
    os.write(other["to"], b"1,2\n")
    os.close(other["to"])
    other["to"] = os.dup(0)
    assert [channel.read_line(), channel.read_line(), channel.read_line()] == ["1,2", None, None]


def test_torn_line_is_an_error(ends):
    channel, other = ends
    os.write(other["to"], b"1,2.")
    os.close(other["to"])
    other["to"] = os.dup(0)
    with pytest.raises(ClientError, match=r"stopped in the middle of a line: '1,2\.'"):
        channel.read_line()


def test_line_that_does_not_come_is_waited_for_no_longer_than_until_the_deadline(ends):
    channel, other = ends
    os.write(other["to"], b"half")
    with pytest.raises(TimeoutError):
        channel.read_line(soon())
    os.write(other["to"], b" done\n")
    assert channel.read_line(soon()) == "half done"


def test_lines_are_written_whole_and_at_once(ends):
    channel, other = ends
    channel.write_line("x" * 3000)
    assert os.read(other["from"], 10_000) == b"x" * 3000 + b"\n"


def test_nobody_who_reads_is_an_error(ends):
    channel, other = ends
    os.close(other["from"])
    other["from"] = os.dup(0)
    with pytest.raises(ClientError, match="no longer reads what it is sent"):
        channel.write_line("Request 1")


def test_reader_that_is_stuck_is_an_error_at_the_deadline(ends):
    channel, _ = ends
    with pytest.raises(ClientError, match="does not read what it is sent"):
        channel.write_line("x" * 10**6, soon())


def test_what_has_come_too_early_is_seen(ends):
    channel, other = ends
    assert channel.line_too_many() == ""
    os.write(other["to"], b"\n1,2\n3,4\n")
    assert channel.line_too_many() == "1,2"


PROGRAM = """
import os, subprocess, sys, warnings
from hypermap_lite.evaluation.channel import standard_channel
print("before")
with standard_channel(is_given_back=GIVEN_BACK) as channel:
    print("printed")
    os.write(1, b"written\\n")
    subprocess.run(["cat"])
    subprocess.run(["echo", "by a child"])
    warnings.warn("careful")
    channel.write_line("heard " + channel.read_line())
print("after")
"""


@pytest.mark.parametrize(
    ("given_back", "out"), [(True, "before\nheard hello\nafter\n"), (False, "before\nheard hello\n")]
)
def test_standard_channel_keeps_everybody_else_off_stdin_and_stdout(given_back, out):
    code = PROGRAM.replace("GIVEN_BACK", str(given_back))
    done = subprocess.run([sys.executable, "-c", code], input="hello\n", capture_output=True, text=True, check=True)
    assert done.stdout == out
    assert [word in done.stderr for word in ("printed", "written", "by a child", "careful")] == [True] * 4
    assert ("after" in done.stderr) is not given_back


def test_standard_channel_works_without_stderr():
    code = PROGRAM.replace("GIVEN_BACK", "True")
    done = subprocess.run(
        ["sh", "-c", f"exec {sys.executable} -c '{code}' 2>&-"], input="hello\n", stdout=subprocess.PIPE, text=True
    )
    assert done.stdout == "before\nheard hello\nafter\n"
