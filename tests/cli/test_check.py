"""Tests for check.py."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.cli import main
from hypermap_lite.scenario import load_scenario
from tests.scenario.bad_scenarios import BAD, GOOD, Bad

COLUMNS = 80
"""Width of the terminal in which a message must not be long."""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(folder: Path, document: dict[str, Any], name: str = "good.json") -> str:
    (folder / name).write_text(json.dumps(document))
    return name


def lines_on_a_terminal(text: str) -> int:
    return sum(max(1, math.ceil(len(line) / COLUMNS)) for line in text.splitlines())


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD.keys())
def test_a_mistake_is_one_short_message_and_exit_status_2(
    bad: Bad, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "bad.json").write_text(bad.text)
    status = main(["check", "bad.json"])
    output = capsys.readouterr()
    assert status == 2
    assert output.out == ""
    assert [part for part in ("bad.json", *bad.says) if part not in output.err] == [], output.err
    assert "Traceback" not in output.err
    assert lines_on_a_terminal(output.err) <= 8


@pytest.mark.parametrize(
    ("name", "says"),
    [
        pytest.param("god.json", ("god.json: there is no such file", "Did you mean 'good.json'?"), id="missing_file"),
        pytest.param(".", ("this is a folder", "good.json"), id="a_folder"),
        pytest.param("latin.json", ("0xe9", "UTF-8"), id="not_utf_8"),
    ],
)
def test_a_file_that_cannot_be_read_is_exit_status_2(
    name: str, says: tuple[str, ...], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(folder, GOOD)
    (folder / "latin.json").write_bytes('{"description": "é"}'.encode("latin-1"))
    assert main(["check", name]) == 2
    message = capsys.readouterr().err
    assert [part for part in says if part not in message] == [], message


def test_a_mistake_found_by_a_part_names_the_file_that_wrote_it(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(folder, {"input_parameters": {"x": {"parameter_type": "real", "values": [5, 1]}}}, "base.json")
    write(folder, {"extends": "base.json", "objectives": [{"name": "y"}]})
    assert main(["check", "good.json"]) == 2
    assert "base.json: $.input_parameters.x.values: the bounds [5.0, 1.0] are reversed" in capsys.readouterr().err


def test_a_good_scenario_is_summarized(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", write(folder, GOOD)]) == 0
    output = capsys.readouterr().out
    expected = [
        "x     real",
        "-5 to 10",
        "gain  maximize",
        "sobol",
        "noisy_expected_hypervolume_improvement",
        "50 evaluations",
    ]
    assert [part for part in expected if part not in output] == [], output


def test_json_is_the_canonical_scenario(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = write(folder, GOOD)
    assert main(["check", name, "--json"]) == 0
    assert load_scenario(json.loads(capsys.readouterr().out)) == load_scenario(name)


def test_overrides_apply(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = write(folder, GOOD)
    assert main(["check", name, "--set", "budget.evaluations=33", "--set", "objectives.0.goal=maximize"]) == 0
    output = capsys.readouterr().out
    assert "33 evaluations" in output
    assert "cost  maximize" in output


def test_a_run_can_take_the_place_of_the_priors(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "run.csv").write_text("x,n,size,mode,cost,gain\n1,2,32,safe,1,1\n2,2,64,fast,2,2\n")
    assert main(["check", write(folder, GOOD), "--prior-from", "run.csv"]) == 0
    output = capsys.readouterr()
    assert "kde of 2 points, non-dominated rows of run.csv\n              over x, n, size, mode" in output.out
    assert "evaluations 1 to 8: prior_sampling" in output.out
    assert "note:" not in output.err


def test_an_unknown_override_is_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", write(folder, GOOD), "--set", "budget.evals=33"]) == 2
    message = capsys.readouterr().err
    assert "--set budget.evals=33: $.budget.evals: unknown key, given 33" in message
    assert "Did you mean 'evaluations'?" in message


def test_warnings_go_to_stderr_with_exit_status_0(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", write(folder, GOOD), "--json"]) == 0
    output = capsys.readouterr()
    json.loads(output.out)
    assert "warning: $.objectives[0]: 'cost' has no reference_point" in output.err


def test_an_import_error_shows_its_last_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "broken_black_box.py").write_text("import no_such_library_here\n")
    evaluator = {"type": "python", "function": "broken_black_box:evaluate"}
    assert main(["check", write(folder, GOOD | {"evaluator": evaluator})]) == 2
    assert "No module named 'no_such_library_here'" in capsys.readouterr().err


def test_check_imports_no_heavy_library(folder: Path) -> None:
    name = write(folder, GOOD)
    heavy = ("sklearn", "mujoco", "matplotlib", "pandas", "rich")
    code = (
        "import sys; from hypermap_lite.cli import main; status = main(sys.argv[1:]); "
        f"print(status, [name for name in {heavy} if name in sys.modules])"
    )
    command = [sys.executable, "-c", code, "check", name]
    root = str(Path(__file__).parents[2])
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | {"PYTHONPATH": root})
    assert done.stdout.splitlines()[-1] == "0 []"
