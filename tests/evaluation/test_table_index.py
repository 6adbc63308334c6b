"""Tests for table_index.py."""

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.evaluation.table_index import key_of, keys_of, read_table, same_text, value_of
from hypermap_lite.space import CategoricalParameter, IntegerParameter, OrdinalParameter, RealParameter, SearchSpace

REAL = RealParameter(name="x", low=-1.0, high=1.0)
WHOLE = IntegerParameter(name="n", low=0, high=20)
LISTED = OrdinalParameter(name="o", values=(0.1, 1.0, 2.0))
NAMED = CategoricalParameter(name="c", values=("false", "true", "Red", "red", "1"))


@pytest.mark.parametrize(
    ("parameter", "texts", "value"),
    [
        (REAL, ["0.5", "0.50", "5e-1"], 0.5),
        (WHOLE, ["10", "10.0", "1e1"], 10),
        (LISTED, ["1", "1.0", "1.00"], 1.0),
        (LISTED, ["0.1", "0.10", "1e-1"], 0.1),
        (NAMED, ["false", "False", "FALSE"], "false"),
        (NAMED, ["Red"], "Red"),
        (NAMED, ["1", "1.0"], "1"),
    ],
)
def test_texts_that_mean_the_same_are_the_same_value(parameter, texts, value):
    assert [value_of(parameter, text) for text in texts] == [value] * len(texts)


@pytest.mark.parametrize(
    ("parameter", "text"),
    [(REAL, "1.5"), (REAL, ""), (WHOLE, "1.5"), (WHOLE, "21"), (WHOLE, "inf"), (LISTED, "0.5"), (NAMED, "RED")],
)
def test_other_texts_are_no_value(parameter, text):
    assert value_of(parameter, text) is None


def test_key_of_a_row_is_that_of_the_configuration():
    space = SearchSpace((REAL, WHOLE, LISTED, NAMED))
    columns = [["0.30", "-0.0", "2"], ["3.0", "0", "1"], ["1", "2.0", "2"], ["False", "true", "Red"]]
    first, second, third = keys_of(space, columns)
    assert first == key_of(space, {"x": 0.1 + 0.2, "n": 3, "o": 1.0, "c": "false"})
    assert second == key_of(space, {"x": 0.0, "n": 0, "o": 2, "c": "true"})
    assert third is None
    assert hash(first) != hash(second)


def test_table_is_read_with_its_lines(tmp_path):
    file = tmp_path / "t.csv"
    file.write_text('\ufeffa, b ,"c"\n1,2,3\n\n4,"5\n5",6\n', encoding="utf-8")
    table = read_table(file, ["a", "b"])
    assert table.header == ("a", "b", "c")
    assert (list(table.lines), table.columns(["c", "a"])) == ([2, 5], [["3", "6"], ["1", "4"]])


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("a,b\n1,2,3\n", "line 2: 3 fields, but the header has 2"),
        ("a,c\n1,2\n", "has no column 'b' (it has: a, c)"),
        ("a,b,b\n", "has more than one column 'b'"),
        ("", "has no column 'a' (it has: none)"),
    ],
)
def test_table_that_cannot_serve_is_an_error(tmp_path, content, says):
    (tmp_path / "t.csv").write_text(content)
    with pytest.raises(ScenarioError) as caught:
        read_table(tmp_path / "t.csv", ["a", "b"])
    assert says in str(caught.value)
    assert caught.value.path == "$.file"


def test_missing_table_is_an_error_that_guesses(tmp_path):
    (tmp_path / "table.csv").write_text("a\n")
    with pytest.raises(ScenarioError, match="there is no file") as caught:
        read_table(tmp_path / "tabel.csv", ["a"])
    assert caught.value.hint == "Did you mean 'table.csv'?"


@pytest.mark.parametrize(
    ("one", "other", "same"), [("1", "1.0", True), (" a", "a", True), ("a", "b", False), ("1", "2", False)]
)
def test_texts_are_compared_by_meaning(one, other, same):
    assert same_text(one, other) is same
