"""Tests for reading.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario.reading import parse_json, read_json


def test_a_file_may_start_with_a_byte_order_mark(tmp_path: Path) -> None:
    (tmp_path / "s.json").write_bytes(b'\xef\xbb\xbf{"seed": 1}')
    assert read_json(tmp_path / "s.json") == {"seed": 1}


def test_line_and_column_point_at_the_mistake() -> None:
    with pytest.raises(ScenarioError, match=r"^s\.json:2:11: broken JSON in line 2, column 11"):
        parse_json('{\n  "seed": oops\n}', "s.json")


def test_deep_nesting_is_an_error_and_no_crash() -> None:
    with pytest.raises(ScenarioError, match="nested too deeply"):
        parse_json("[" * 100_000, "s.json")


@pytest.mark.parametrize(
    ("text", "path"),
    [
        pytest.param('{"a": 1, "a": 2}', "$", id="top"),
        pytest.param('{"a": {"b": [{}, {"c": 1, "c": 1}]}}', r"$.a.b[1]", id="inside"),
    ],
)
def test_a_repeated_key_is_placed(text: str, path: str) -> None:
    with pytest.raises(ScenarioError, match="stands twice") as caught:
        parse_json(text, "s.json")
    assert caught.value.path == path


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e400"])
def test_numbers_must_be_finite(number: str) -> None:
    with pytest.raises(ScenarioError, match=r"\$\.a\[0\].*no JSON number"):
        parse_json(f'{{"a": [{number}]}}', "s.json")


def test_a_missing_file_names_one_with_a_close_name(tmp_path: Path) -> None:
    (tmp_path / "branin.json").write_text("{}")
    with pytest.raises(ScenarioError, match=r"no such file\n  hint: Did you mean 'branin\.json'\?"):
        read_json(tmp_path / "brannin.json")


def test_a_folder_names_the_scenarios_in_it(tmp_path: Path) -> None:
    (tmp_path / "branin.json").write_text("{}")
    with pytest.raises(ScenarioError, match=r"this is a folder[\s\S]*branin\.json"):
        read_json(tmp_path)


def test_a_file_that_is_not_utf_8_names_the_byte(tmp_path: Path) -> None:
    (tmp_path / "s.json").write_bytes(b'{"a": "\xe9"}')
    with pytest.raises(ScenarioError, match=r"byte 7 \(0xe9\) is not UTF-8"):
        read_json(tmp_path / "s.json")
