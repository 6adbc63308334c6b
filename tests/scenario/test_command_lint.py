"""Tests for command_lint.py."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.command_lint import lint_command
from tests.scenario.bad_scenarios import GOOD


def warnings(*command: str, **options: Any) -> list[str]:
    document = GOOD | {"evaluator": {"type": "command", "command": list(command), **options}}
    return [text for _, text in lint_command(load_scenario(document))]


ALL = ("{x}", "{n}", "{size}", "{mode}")


@pytest.mark.parametrize(
    "arguments",
    [
        pytest.param(ALL, id="a_placeholder_each"),
        pytest.param(("{params_json}",), id="json"),
        pytest.param(("--file={params_file}",), id="file"),
        pytest.param(("-c", "cat $HYPERMAP_PARAMS_FILE"), id="environment"),
    ],
)
def test_a_command_that_passes_every_parameter_on_is_fine(arguments: tuple[str, ...]) -> None:
    assert warnings("echo", *arguments) == []


def test_an_evaluator_without_a_command_is_fine() -> None:
    assert list(lint_command(load_scenario(GOOD))) == []
    assert list(lint_command(load_scenario(GOOD | {"evaluator": {"type": "python", "function": "a:b"}}))) == []


def test_parameters_that_are_not_passed_on_are_named_with_the_way_out() -> None:
    (warning,) = warnings("echo", "{x}", "{mode}")
    assert warning.startswith("no placeholder passes on 'n', 'size'; ")
    assert "HYPERMAP_PARAMS_FILE" in warning


@pytest.mark.parametrize("written", ["{x:.3f}", "{x }", "{ x}", "{x!r}"])
def test_what_looks_like_a_placeholder_and_is_none_is_shown(written: str) -> None:
    (warning,) = warnings("echo", f"--x={written}", *ALL[1:])
    assert warning.startswith("no placeholder passes on 'x'; ")
    assert f"'{written}' is passed on as it stands" in warning


@pytest.mark.parametrize(
    ("content", "says"),
    [
        pytest.param(b"import sys\n", "has no '#!' in its first line", id="no_interpreter"),
        pytest.param(b"", "has no '#!' in its first line", id="empty"),
        pytest.param(b"#!/bin/sh\r\necho\r\n", "ends like on Windows", id="windows"),
        pytest.param(b"#! /no/such/python3 -u\n", "there is no such interpreter", id="unknown_interpreter"),
    ],
)
def test_a_script_that_cannot_be_started_is_named(tmp_path: Path, content: bytes, says: str) -> None:
    script = tmp_path / "simulate"
    script.write_bytes(content)
    (warning,) = warnings(str(script), *ALL)
    assert says in warning
    assert warnings(str(script), *ALL, shell=True) == []


@pytest.mark.parametrize("program", ["sh", sys.executable, "{python}", "./nothing_here"])
def test_a_program_that_can_be_started_or_is_missing_is_not_named(program: str) -> None:
    assert warnings(program, *ALL) == []


def test_a_script_with_an_interpreter_is_fine(tmp_path: Path) -> None:
    (tmp_path / "simulate").write_text("#!/bin/sh\necho\n")
    assert warnings(str(tmp_path / "simulate"), *ALL) == []
