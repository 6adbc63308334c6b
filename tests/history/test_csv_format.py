"""Tests for csv_format.py."""

import logging
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypermap_lite.errors import RunFolderError
from hypermap_lite.history.csv_format import (
    complete_length,
    format_number,
    format_record,
    format_value,
    parse_rows,
    parse_value,
    read_records,
)
from tests.history.examples import SPACE

FORCE, TURNS, GAIN, TOOL = SPACE.parameters


@given(st.lists(st.lists(st.text(), min_size=2, max_size=4), max_size=4))
def test_records_of_any_text_read_back_exactly(tmp_path_factory, records):
    path = tmp_path_factory.getbasetemp() / "records.csv"
    path.write_bytes("".join(map(format_record, records)).encode())
    assert read_records(path) == records


@given(st.floats(allow_nan=False))
def test_numbers_read_back_to_the_last_bit(value):
    assert float(format_number(value)) == value
    assert math.copysign(1, float(format_number(value))) == math.copysign(1, value)


def test_none_and_nan_are_empty_fields():
    assert (format_number(None), format_number(math.nan)) == ("", "")


@given(st.floats(min_value=-20, max_value=1e6))
def test_real_values_read_back_to_the_last_bit(value):
    assert parse_value(FORCE, format_value(FORCE, value)) == value


@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        pytest.param(TURNS, 2000, id="integer"),
        pytest.param(TURNS, -3, id="negative integer"),
        pytest.param(GAIN, 1e-7, id="level with exponent"),
        pytest.param(GAIN, 2, id="whole level"),
        *(pytest.param(TOOL, name, id=repr(name)) for name in TOOL.values),
    ],
)
def test_discrete_values_read_back_with_their_type(parameter, value):
    back = parse_value(parameter, format_value(parameter, value))
    assert back == value
    assert type(back) is type(value)


def test_equal_values_have_one_text():
    assert format_value(FORCE, 1) == format_value(FORCE, 1.0) == format_value(FORCE, np.float64(1)) == "1.0"
    assert format_value(TURNS, 3) == format_value(TURNS, 3.0) == "3"


@pytest.mark.parametrize(
    ("parameter", "text"),
    [(FORCE, "1e7"), (FORCE, "nan"), (FORCE, "x"), (TURNS, "2.5"), (GAIN, "0.6"), (GAIN, "x"), (TOOL, "hammer")],
)
def test_value_the_parameter_does_not_have_is_refused(parameter, text):
    with pytest.raises(ValueError, match=r"which is not|could not convert|invalid literal"):
        parse_value(parameter, text)


@given(st.lists(st.lists(st.text(alphabet='a,"\n\rü', max_size=4), min_size=2, max_size=3), min_size=1), st.data())
def test_file_cut_at_any_byte_keeps_every_record_before_the_cut(records, data):
    encoded = [format_record(record).encode() for record in records]
    cut = data.draw(st.integers(0, sum(map(len, encoded))))
    whole = 0
    for line in encoded:
        if whole + len(line) > cut:
            break
        whole += len(line)
    assert complete_length(b"".join(encoded)[:cut]) == whole


def test_torn_last_line_is_dropped_with_a_warning(tmp_path, caplog):
    path = tmp_path / "history.csv"
    path.write_text('a,b\n1,2\n3,"4')
    with caplog.at_level(logging.WARNING):
        assert read_records(path) == [["a", "b"], ["1", "2"]]
    assert "was cut off and is dropped" in caplog.text


def test_absent_file_has_no_records(tmp_path):
    assert read_records(tmp_path / "none.csv") == []


def test_file_saved_by_a_spreadsheet_is_read(tmp_path):
    path = tmp_path / "history.csv"
    path.write_bytes("\ufeffa,b\r\n1,2\r\n".encode())
    assert read_records(path) == [["a", "b"], ["1", "2"]]


@pytest.mark.parametrize("record", [["1"], ["1", "x"]], ids=["too short", "not a number"])
def test_damaged_record_is_an_error_that_names_it(tmp_path, record):
    path = tmp_path / "history.csv"
    with pytest.raises(RunFolderError, match=r"history.csv: record 3 cannot be read: .*\n.*hint: Undo"):
        parse_rows(path, [["a", "b"], ["1", "2"], record], lambda fields: [float(f) for f in fields])
