"""The clients of HyperMapper's client-server protocol, against a scripted optimizer and against ours.

The script is what HyperMapper 2.2.13 wrote for a design of three and two further suggestions, numbers shortened.
"""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
CLIENTS = ROOT / "example_scenarios" / "clients"
SCENARIO = ROOT / "example_scenarios" / "hypermapper" / "chakong_haimes_client_server.json"
OPTIMIZER = Path(__file__).with_name("scripted_optimizer.py")
EVALUATORS = json.loads((ROOT / "scenario_schemas" / "evaluator.schema.json").read_text(encoding="utf-8"))

HEADER = "x1,x2"
DESIGN = ["Request 3", HEADER, "0,0", "-4.25,13.5", "7.193004587740901,7.417406885347656"]
END = "End of HyperMapper"
SCRIPT = [*DESIGN, 4, "Request 1", HEADER, "2,1", 2, "Request 1", HEADER, "-1e-05,20", 2, END]
EXPECTED = [
    ("0", "0", 7, -1, "False"),
    ("-4.25", "13.5", 197.3125, -194.5, "True"),
    ("7.193004587740901", "7.417406885347656", 70.15040778, 23.55393016, "True"),
    ("2", "1", 2, 18, "False"),
    ("-1e-05", "20", 367.00004, -361.00009, "False"),
]

ours = pytest.mark.skipif(
    '"client_server"' not in json.dumps(EVALUATORS), reason="the optimizer has no client-server evaluator"
)


@pytest.fixture(scope="module")
def cpp_client(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    compiler = shutil.which("g++")
    if compiler is None:
        pytest.skip("no g++ to build the client with")
    program = tmp_path_factory.mktemp("client") / "hypermapper_client"
    source = str(CLIENTS / "hypermapper_client.cpp")
    subprocess.run([compiler, "-std=c++17", "-Wall", "-Wextra", "-Werror", source, "-o", str(program)], check=True)
    return [str(program)]


@pytest.fixture(params=["python", "cpp"])
def client(request: pytest.FixtureRequest) -> list[str]:
    if request.param == "cpp":
        return list(request.getfixturevalue("cpp_client"))
    return [sys.executable, str(CLIENTS / "hypermapper_client.py")]


def start(client: list[str], *arguments: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    variables = {"PYTHONPATH": str(ROOT), **{k: v for k, v in os.environ.items() if k != "HYPERMAPPER_HOME"}}
    return subprocess.run(
        [*client, *arguments], cwd=cwd, env={**variables, **environment}, capture_output=True, text=True, timeout=120
    )


def play(client: list[str], script: list[str | int], folder: Path) -> subprocess.CompletedProcess[str]:
    (folder / "script.json").write_text(json.dumps(script))
    command = [sys.executable, str(OPTIMIZER), str(folder / "script.json"), str(folder / "answers.txt")]
    return start(client, *command, "scenario.json", cwd=folder)


def test_a_client_answers_every_request_and_stops_at_the_end(client: list[str], tmp_path: Path) -> None:
    result = play(client, list(SCRIPT), tmp_path)
    assert (result.returncode, result.stdout) == (0, "5 configurations evaluated\n")
    lines = (tmp_path / "answers.txt").read_text().splitlines()
    header = "x1,x2,f1,f2,Valid"
    assert [i for i, line in enumerate(lines) if line == header] == [0, 4, 6]
    rows = [line.split(",") for line in lines if line != header]
    for (x1, x2, f1, f2, valid), (*inputs, g1, g2, is_valid) in zip(EXPECTED, rows, strict=True):
        assert (inputs, is_valid) == ([x1, x2], valid)
        assert (float(g1), float(g2)) == pytest.approx((f1, f2))


def test_a_client_goes_by_the_names_in_the_header(client: list[str], tmp_path: Path) -> None:
    assert play(client, ["Request 1", "x2,x1", "1,2", 2, END], tmp_path).returncode == 0
    assert (tmp_path / "answers.txt").read_text().splitlines()[1].startswith("2,1,2")


def test_a_client_passes_over_what_is_not_the_protocol(client: list[str], tmp_path: Path) -> None:
    before = ["a warning about the environment"]
    after = ["Best point found:", "x1,x2,f1,f2", "0,0,7,-1", ""]
    result = play(client, [*before, *DESIGN, 4, *after, END], tmp_path)
    assert (result.returncode, result.stdout) == (0, "3 configurations evaluated\n")


@pytest.mark.parametrize(
    ("script", "problem"),
    [
        ([*DESIGN, 4], "the optimizer stopped without 'End of HyperMapper'"),
        (DESIGN[:4], "the optimizer stopped before it had written row 3 of 3"),
        (DESIGN[:1], "the optimizer stopped before it had written the names of the parameters"),
        ([], "the optimizer stopped without 'End of HyperMapper'"),
    ],
    ids=["no end", "no row", "no header", "nothing"],
)
def test_an_optimizer_that_stops_early_is_an_error(
    client: list[str], script: list[str | int], problem: str, tmp_path: Path
) -> None:
    result = play(client, script, tmp_path)
    assert (result.returncode, result.stdout) == (1, "")
    assert problem in result.stderr
    assert "Traceback" not in result.stderr


def test_an_optimizer_that_does_not_start_is_an_error(client: list[str], tmp_path: Path) -> None:
    result = start(client, "no_such_optimizer", "scenario.json", cwd=tmp_path)
    assert result.returncode == 1
    assert "No such file" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_client_starts_the_optimizer_in_hypermapper_home(client: list[str], tmp_path: Path) -> None:
    (tmp_path / "hypermapper").mkdir()
    program = f"import sys; assert sys.argv[1] == 'scenario.json'; print('{END}')"
    (tmp_path / "hypermapper" / "optimizer.py").write_text(program)
    result = start(client, "scenario.json", cwd=tmp_path, HYPERMAPPER_HOME=str(tmp_path))
    assert (result.returncode, result.stdout, result.stderr) == (0, "0 configurations evaluated\n", "")


@ours
def test_our_optimizer_serves_a_client(client: list[str], tmp_path: Path) -> None:
    document = shortened(json.loads(SCENARIO.read_text(encoding="utf-8")))
    (tmp_path / "scenario.json").write_text(json.dumps(document))
    result = start(client, sys.executable, "-m", "hypermap_lite", "scenario.json", cwd=tmp_path)
    assert (result.returncode, result.stdout) == (0, "9 configurations evaluated\n"), result.stderr
    with next(tmp_path.rglob("history.csv")).open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 9
    for row in rows:
        x1, x2 = float(row["x1"]), float(row["x2"])
        assert float(row["f1"]) == pytest.approx(2 + (x1 - 2) ** 2 + (x2 - 1) ** 2)
        assert row["Valid"] == str(x1**2 + x2**2 <= 225 and x1 - 3 * x2 + 10 <= 0)


def shortened(document: dict[str, Any]) -> dict[str, Any]:
    design = {**document["design_of_experiment"], "number_of_samples": 6}
    return {**document, "design_of_experiment": design, "optimization_iterations": 3}
