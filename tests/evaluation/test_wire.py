"""Tests for wire.py."""

import pytest

from hypermap_lite.errors import ClientError
from hypermap_lite.evaluation.wire import ReplyFormat, fields_of, request_lines
from hypermap_lite.objectives import FeasibleOutput
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace

SPACE = SearchSpace(
    (
        RealParameter(name="x", low=-5.0, high=10.0),
        IntegerParameter(name="n", low=0, high=9),
        OrdinalParameter(name="o", values=(0.1, 1.0, 2.5)),
        CategoricalParameter(name="c", values=("red", "true")),
    )
)
FORM = ReplyFormat(parameters=("x", "n"), objectives=("f",), feasible=FeasibleOutput())


def test_values_are_written_exactly():
    configurations = [{"x": 0.1 + 0.2, "n": 3, "o": 1.0, "c": "true"}, {"x": -5.0, "n": 0, "o": 0.1, "c": "red"}]
    assert list(request_lines(SPACE, configurations)) == [
        "Request 2",
        "x,n,o,c",
        "0.30000000000000004,3,1,true",
        "-5.0,0,0.1,red",
    ]


def test_fields_have_no_outer_blanks():
    assert fields_of(' a, b ,"c,d"') == ["a", "b", "c,d"]


@pytest.mark.parametrize("header", [["x", "n", "f", "Valid"], ["Valid", "time", "f", "n", "", "x", "time"]])
def test_header_may_have_any_order_and_more_columns(header):
    FORM.check_header(header)


@pytest.mark.parametrize(
    ("header", "says"),
    [
        (["x", "n", "Valid"], "has no column 'f'"),
        (["n", "f", "Valid"], "has no column 'x'"),
        (["x", "n", "f", "valid"], "has no column 'Valid'. Did you mean 'valid'?"),
        (["x", "n", "f", "x", "Valid"], "has the column 'x' twice"),
    ],
)
def test_header_without_a_column_is_an_error_that_shows_both(header, says):
    with pytest.raises(ClientError) as caught:
        FORM.check_header(header)
    assert says in str(caught.value)
    assert f"header: {','.join(header)}" in str(caught.value)
    assert "needed: x,n,f,Valid" in str(caught.value)


def test_row_becomes_an_outcome():
    found = FORM.outcome({"x": "1", "n": "2", "f": "3", "Valid": "True", "time": "4", "": "5"})
    assert (found.values, found.metrics) == ({"f": 3.0}, {"time": 4.0})


@pytest.mark.parametrize(
    ("change", "says"),
    [({"f": "?"}, "in the client's reply, 'f' is '?', not a number"), ({"Valid": "yes"}, "'Valid' is 'yes', neither")],
)
def test_row_that_cannot_be_read_is_an_error(change, says):
    with pytest.raises(ClientError, match="in the client's reply") as caught:
        FORM.outcome({"x": "1", "n": "2", "f": "3", "Valid": "True"} | change)
    assert says in str(caught.value).replace('"', "")
