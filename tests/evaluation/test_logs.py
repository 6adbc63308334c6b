"""Tests for logs.py."""

import pytest

from hypermap_lite.evaluation.logs import KEPT_BYTES, last_text_line, shorten_log, shorten_logs
from tests.evaluation.examples import request


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ("", ""),
        ("\n \n", ""),
        ("a\nb\n\n", "b"),
        ("a\r\nb \r\n", "b"),
        ("10 %\r90 %\rdone\n", "done"),
        ("a\u2028b\x1cc\x85d", "a\u2028b\x1cc\x85d"),
    ],
)
def test_last_line_ends_at_line_ends_only(tmp_path, content, line):
    (tmp_path / "log").write_bytes(content.encode())
    assert last_text_line(tmp_path / "log") == line


def test_line_of_more_than_a_mebibyte_is_refused(tmp_path):
    log = tmp_path / "log"
    log.write_text("x\n" + "y" * (KEPT_BYTES - 2) + "\n")
    assert len(last_text_line(log)) == KEPT_BYTES - 2
    log.write_text("y" * KEPT_BYTES + "\n")
    with pytest.raises(ValueError, match="last line of log is longer than 1 MiB"):
        last_text_line(log)


def test_long_log_keeps_its_ends_and_says_what_is_missing(tmp_path):
    log = tmp_path / "log"
    log.write_text("a" * KEPT_BYTES + "b" * 5000 + "c" * KEPT_BYTES)
    with log.open("a") as writer:
        shorten_log(log)
        writer.write("later")
    text = log.read_text()
    assert (
        text == "a" * KEPT_BYTES + "\n[... 5000 bytes of this log were cut out here ...]\n" + "c" * KEPT_BYTES + "later"
    )


def test_short_and_missing_logs_are_left_alone(tmp_path):
    asked = request(tmp_path)
    asked.directory.mkdir()
    asked.file("stdout.log").write_text("a" * 2 * KEPT_BYTES)
    shorten_logs(asked)
    assert asked.file("stdout.log").stat().st_size == 2 * KEPT_BYTES
    assert not asked.file("stderr.log").exists()
