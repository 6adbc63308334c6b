"""Tests for placeholders.py."""

import pytest

from hypermap_lite.evaluation.placeholders import fill, placeholders_in, unknown_placeholders
from hypermap_lite.typing import as_argument

VALUES = {"Force": "-3.5", "k-1": "2", "name": "a b"}


@pytest.mark.parametrize(
    ("text", "filled"),
    [
        ("--force={Force}", "--force=-3.5"),
        ("{Force}{k-1}", "-3.52"),
        ("plain", "plain"),
        ("{{Force}}", "{Force}"),
        ('{"a": 1}', '{"a": 1}'),
        ("awk '{ print $1 }'", "awk '{ print $1 }'"),
        ("{print $1}", "{print $1}"),
        ("if(x){{{print}}}", "if(x){{print}}"),
        ("${HOME}x", "${HOME}x"),
        ("{}", "{}"),
    ],
)
def test_only_names_in_braces_are_replaced(text, filled):
    assert fill(text, VALUES) == filled


def test_value_is_quoted_for_a_shell():
    assert fill("echo {name}", VALUES, quote=True) == "echo 'a b'"


def test_placeholder_without_a_value_is_an_error():
    with pytest.raises(KeyError, match="force"):
        fill("{force}", VALUES)


def test_names_are_found_in_order():
    assert list(placeholders_in("{b} {{c}} {a}")) == ["b", "a"]


def test_unknown_names_are_found_with_their_position():
    assert list(unknown_placeholders(["run", "{Force} {seed}", "{sed}"], ["Force"])) == [(2, "sed")]


@pytest.mark.parametrize(("value", "text"), [(0.1, "0.1"), (1e-7, "1e-07"), (3, "3"), ("peg", "peg")])
def test_values_read_as_programs_expect(value, text):
    assert as_argument(value) == text
