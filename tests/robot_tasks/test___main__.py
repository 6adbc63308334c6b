"""Tests for __main__.py."""

import io
import json
import os
import re
import subprocess
import sys

import pytest

from robot_tasks.__main__ import WIDTH, main
from robot_tasks.errors import GraphicsError
from robot_tasks.evaluation import evaluate
from robot_tasks.render import OffScreen, View
from robot_tasks.simulation import Simulation
from robot_tasks.tasks import TASKS
from tests.robot_tasks.conftest import OPERATOR_MEANS

TASK = "obstacle_avoidance"
every_task = pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)


@pytest.fixture
def parameters_file(tmp_path):
    path = tmp_path / "parameters.json"
    path.write_text(json.dumps(OPERATOR_MEANS))
    return str(path)


@pytest.fixture
def _graphics():
    try:
        OffScreen(Simulation.from_scene(TASKS[TASK].scene), View()).close()
    except GraphicsError as error:
        pytest.skip(str(error))


def test_evaluate_prints_one_json_object_as_its_last_line(capsys, parameters_file):
    assert main(["evaluate", TASK, "--parameters", parameters_file, "--seed", "2"]) == 0
    last_line = capsys.readouterr().out.splitlines()[-1]
    assert json.loads(last_line) == evaluate(TASK, OPERATOR_MEANS, 2)


def test_evaluate_reads_standard_input(capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO(json.dumps(OPERATOR_MEANS)))
    assert main(["evaluate", TASK, "--parameters", "-"]) == 0
    assert json.loads(capsys.readouterr().out) == evaluate(TASK, OPERATOR_MEANS)


def test_settings_override_the_file_and_the_last_one_counts(capsys, parameters_file):
    settings = ["--set", "mp2_threshold=1.4", "--set", "mp2_threshold=1.3", "--set", "mp3_threshold=-0.25"]
    assert main(["evaluate", TASK, "--parameters", parameters_file, *settings]) == 0
    numbers = json.loads(capsys.readouterr().out)
    assert numbers == evaluate(TASK, OPERATOR_MEANS | {"mp2_threshold": 1.3, "mp3_threshold": -0.25})


def test_settings_alone_are_enough(capsys):
    settings = [f"--set={name}={value}" for name, value in OPERATOR_MEANS.items()]
    assert main(["evaluate", TASK, *settings, "--as-published-code"]) == 0
    assert json.loads(capsys.readouterr().out) == evaluate(TASK, OPERATOR_MEANS, variant="published_code")


def test_list_names_the_tasks(capsys):
    assert main(["list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(TASKS)
    assert "obstacle_avoidance  Carry the tool over an engine to a block behind it." in lines


def test_show_gives_parameters_with_bounds_and_units_objectives_and_terms(capsys):
    assert main(["show", TASK]) == 0
    output = capsys.readouterr().out
    assert "  mp2_threshold   [0.5, 1.5] m " in output
    assert "objective safety (to be maximized), sum over 12 s at 10 Hz of" in output
    assert "50 x goal_distance = GoalDistance(" in output
    assert "      Pay exp(-(d^2 + m) / (2 w^2)) for a tip at distance d from the goal." in output


def test_show_gives_what_is_randomized(capsys):
    assert main(["show", TASK]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "    s1   0.43   1.65  -0.32  -0.56   1.46   1.37  -1.11" in lines
    assert any("'engine'" in line and "sigma=0.02" in line for line in lines)


def test_show_gives_the_tree_at_the_middle_of_the_bounds_and_the_conditions_of_the_skill(capsys):
    assert main(["show", TASK]) == 0
    output = capsys.readouterr().out
    assert "  Skill pass_over_obstacle\n  └─ ParallelFs\n     ├─ Selector\n" in output
    assert "CoordinateAtLeast z, 1 m\n" in output
    assert "    clear_height      float  m  learned   Height from which to cross\n" in output
    assert "  pre-conditions, at the start\n    not at(tool_tip, goal) within 0.05 m\n" in output


def test_show_takes_values_from_a_file_and_settings(capsys, parameters_file):
    assert main(["show", TASK, "--parameters", parameters_file, "--set", "mp3_threshold=0.25"]) == 0
    output = capsys.readouterr().out
    assert "CoordinateAtLeast z, 0.95 m\n" in output
    assert "CoordinateBelow y, 0.25 m\n" in output


@every_task
def test_show_fits_a_terminal_and_tells_what_success_is(capsys, task):
    assert main(["show", task.name]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert any(line.startswith("success: ") for line in lines)


@pytest.mark.usefixtures("_graphics")
@pytest.mark.parametrize("name", ["clip.mp4", "strip.PNG"])
def test_render_writes_a_file_and_prints_its_name_and_the_objectives(capsys, tmp_path, parameters_file, name):
    size = ["--width", "96", "--height", "64", "--fps", "1", "--frames", "1"]
    output = str(tmp_path / name)
    assert main(["render", TASK, "--parameters", parameters_file, "--seed", "2", *size, "--output", output]) == 0
    performance = evaluate(TASK, OPERATOR_MEANS, 2)["performance"]
    (line,) = capsys.readouterr().out.splitlines()
    assert line.startswith(f"{output}: performance {performance:.1f}, safety -")
    assert (tmp_path / name).stat().st_size > 1000


def test_graphics_that_are_not_there_are_one_line_and_exit_code_2(tmp_path, parameters_file):
    command = [sys.executable, "-W", "error", "-m", "robot_tasks", "render", TASK, "--parameters", parameters_file]
    command += ["--output", str(tmp_path / "strip.png")]
    environment = os.environ | {"MUJOCO_GL": "egl", "PYOPENGL_PLATFORM": "osmesa"}  # MuJoCo refuses this combination
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 2
    assert result.stderr.startswith("error: no off-screen OpenGL (egl: ")
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        pytest.param(["--output", "a.gif"], "Give a file that ends in .mp4 for a clip", id="ending"),
        pytest.param(["--output", "a.mp4", "--camera", "top"], "unknown camera 'top'. Known: front", id="camera"),
        pytest.param(["--output", "a.mp4", "--fps", "61"], "fps: got 61.", id="fps"),
        pytest.param(["--output", "a.png", "--frames", "0"], "frames: got 0.", id="frames"),
        pytest.param(["--output", "a.mp4", "--width", "4"], "width: got 4.", id="width"),
        pytest.param(["--output", "a.mp4", "--set", "mp2_threshold"], "--set mp2_threshold: no number", id="setting"),
        pytest.param(["--output", "a.mp4", "--set", "mp2_threshold=x"], "no number after '='", id="no number"),
        pytest.param(["--output", "a.mp4", "--set", "mp=1"], "'mp': not a parameter of this task", id="unknown"),
    ],
)
def test_a_mistake_in_render_is_one_line_and_exit_code_2(capsys, parameters_file, options, message):
    assert main(["render", TASK, "--parameters", parameters_file, *options]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err
    assert len(captured.err.splitlines()) == 1


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
    assert main(["evaluate", TASK, "--parameters", "-"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err


def test_no_values_at_all_are_a_missing_parameter(capsys):
    assert main(["evaluate", TASK]) == 2
    assert "parameter 'mp1_position_y': missing. Give a number in [-0.5, 1.5] m." in capsys.readouterr().err


def test_an_unknown_task_and_a_missing_file_are_error_messages(capsys):
    assert main(["show", "peg"]) == 2
    assert main(["evaluate", TASK, "--parameters", "no/such/file.json"]) == 2
    assert "unknown task 'peg'" in capsys.readouterr().err


def test_help_does_not_wait_for_mujoco():
    code = "import sys, robot_tasks.__main__; print('mujoco' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout == "False\n"


def test_a_negative_seed_is_a_mistake_of_the_command_line(parameters_file, capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["evaluate", TASK, "--parameters", parameters_file, "--seed", "-1"])
    assert "argument --seed: -1 is negative; give 0 or more" in capsys.readouterr().err


def test_without_mujoco_the_error_says_how_to_install_it(monkeypatch, capsys):
    error = ModuleNotFoundError("No module named 'mujoco'", name="mujoco")
    monkeypatch.setattr("robot_tasks.__main__._list", lambda options: (_ for _ in ()).throw(error))
    assert main(["list"]) == 2
    assert "pip install 'hypermap-lite[robot]'" in capsys.readouterr().err


FRONT = """\
mp1_position_y,mp1_position_z,mp2_position_y,mp2_position_z,mp2_threshold,mp3_threshold,performance,trial
0.7,1.1,0.0,1.0,0.95,0.05,2900,4
0.6,1.2,0.0,1.0,0.95,0.05,2800,17
"""


def test_a_row_of_a_front_can_be_run_again(tmp_path, capsys):
    file = tmp_path / "pareto.csv"
    file.write_text(FRONT)
    assert main(["evaluate", TASK, "--parameters", str(file), "--trial", "4", "--seed", "2"]) == 0
    assert json.loads(capsys.readouterr().out) == evaluate(TASK, OPERATOR_MEANS, 2)


@pytest.mark.parametrize(
    ("task", "options", "message"),
    [
        pytest.param(TASK, [], "which row? Give --trial with one of 4, 17.", id="none"),
        pytest.param(TASK, ["--trial", "5"], "no trial 5. Give --trial with one of 4, 17.", id="unknown"),
        pytest.param("peg_insertion", ["--trial", "4"], "no column PathVelocity, .* of this task.", id="other task"),
    ],
)
def test_a_row_that_is_not_there_is_named_with_those_that_are(tmp_path, capsys, task, options, message):
    file = tmp_path / "pareto.csv"
    file.write_text(FRONT)
    assert main(["evaluate", task, "--parameters", str(file), *options]) == 2
    assert re.search(message.replace("?", "[?]"), capsys.readouterr().err)


def test_a_reader_that_has_seen_enough_is_no_error():
    command = f"{sys.executable} -m robot_tasks show peg_insertion | head -n 1"
    result = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert result.stdout.startswith("peg_insertion: ")
    assert result.stderr == ""


def test_ctrl_c_ends_with_130(monkeypatch, capsys):
    def interrupted(options):
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr("robot_tasks.__main__._list", interrupted)
    assert main(["list"]) == 130
    assert capsys.readouterr().err == "stopped\n"


def test_a_seed_is_a_whole_number(capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["evaluate", TASK, "--seed", "1.5"])
    assert "argument --seed: '1.5' is no whole number" in capsys.readouterr().err
