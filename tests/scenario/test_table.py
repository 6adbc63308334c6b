"""Tests for table.py."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.table import Table, read_table


def read(folder: Path, content: str | bytes) -> Table:
    file = folder / "a.csv"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    return read_table(file, "a.csv")


@pytest.mark.parametrize(
    "content",
    [
        pytest.param("x,y\n1,2\n3,4\n", id="plain"),
        pytest.param("x,y\r\n1,2\r\n3,4\r\n", id="windows"),
        pytest.param("\ufeffx,y\n1,2\n3,4\n", id="byte-order-mark"),
        pytest.param("x,y\n1,2\n3,4", id="no-last-newline"),
        pytest.param("x, y \n1, 2\n\n3,4\n\n", id="blanks"),
        pytest.param('"x","y"\n"1","2"\n3,4\n', id="quotes"),
    ],
)
def test_what_editors_write_is_read_alike(content: str, tmp_path: Path) -> None:
    table = read(tmp_path, content)
    assert table.header == ("x", "y")
    assert (table.column("x"), table.column("y")) == (["1", "3"], ["2", "4"])


def test_records_are_counted_as_they_stand_in_the_file(tmp_path: Path) -> None:
    assert read(tmp_path, "x\n1\n\n2\n").numbers == (2, 4)


def test_a_line_that_was_cut_off_is_dropped_with_a_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        assert read(tmp_path, "x,y\n1,2\n3").column("x") == ["1"]
    assert "a.csv: the last line was cut off" in caplog.text


@pytest.mark.parametrize(
    ("content", "message"),
    [
        pytest.param("", "a.csv is empty", id="empty"),
        pytest.param("x,y\n1,2,3\n4,5\n", "not a table: record 2 has 3 fields, the header 2", id="lengths"),
        pytest.param("x,x\n1,2\n", "not a table: two columns are called 'x'", id="repeated"),
        pytest.param('x,y\n"1,2\n', "not a table: unexpected end of data", id="open-quotes"),
        pytest.param(b"\x89PNG\r\n\x1a\n", "not a table: byte 0 is not UTF-8", id="picture"),
    ],
)
def test_what_is_no_table_is_refused(content: str | bytes, message: str, tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=message):
        read(tmp_path, content)


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="runs cannot be read: Is a directory"):
        read_table(tmp_path, "runs")
