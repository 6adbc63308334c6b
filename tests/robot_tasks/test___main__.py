"""Tests for __main__.py."""

import io
import json

import pytest

from robot_tasks import obstacle_avoidance
from robot_tasks.__main__ import main
from tests.robot_tasks.conftest import OPERATOR_MEANS


@pytest.fixture
def parameters_file(tmp_path):
    path = tmp_path / "parameters.json"
    path.write_text(json.dumps(OPERATOR_MEANS))
    return str(path)


def test_evaluate_prints_one_json_object_as_its_last_line(capsys, parameters_file):
    assert main(["evaluate", "obstacle_avoidance", "--parameters", parameters_file, "--seed", "2"]) == 0
    last_line = capsys.readouterr().out.splitlines()[-1]
    assert json.loads(last_line) == obstacle_avoidance(OPERATOR_MEANS, seed=2)


def test_evaluate_reads_standard_input(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO(json.dumps(OPERATOR_MEANS)))
    assert main(["evaluate", "obstacle_avoidance", "--parameters", "-"]) == 0
    assert json.loads(capsys.readouterr().out) == obstacle_avoidance(OPERATOR_MEANS)


def test_list_names_the_tasks(capsys):
    assert main(["list"]) == 0
    assert capsys.readouterr().out.startswith("obstacle_avoidance  Carry the tool")


def test_show_gives_parameters_with_bounds_and_units_objectives_and_terms(capsys):
    assert main(["show", "obstacle_avoidance"]) == 0
    output = capsys.readouterr().out
    assert "mp2_threshold    [0.5, 1.5] m" in output
    assert "objective safety" in output
    assert "50 x goal_distance = GoalDistance(" in output


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param("{", "not JSON", id="broken JSON"),
        pytest.param("[1]", "got a list. Give an object", id="no object"),
        pytest.param("{}", "parameter 'mp1_position_y': missing", id="missing parameter"),
    ],
)
def test_bad_input_is_an_error_message_and_exit_code_2(capsys, monkeypatch, text, message):
    monkeypatch.setattr("sys.stdin", io.StringIO(text))
    assert main(["evaluate", "obstacle_avoidance", "--parameters", "-"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err


def test_an_unknown_task_and_a_missing_file_are_error_messages(capsys):
    assert main(["show", "peg"]) == 2
    assert main(["evaluate", "obstacle_avoidance", "--parameters", "no/such/file.json"]) == 2
    assert "unknown task 'peg'" in capsys.readouterr().err
