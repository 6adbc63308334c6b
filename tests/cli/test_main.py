"""Tests for cli/__init__.py and __main__.py."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from hypermap_lite import __version__, cli
from hypermap_lite.errors import (
    ClientError,
    NoValidEvaluationError,
    RepeatedFailureError,
    RunFolderError,
    ScenarioError,
    UsageError,
)
from tests.cli.scenarios import write_scenario


@pytest.fixture
def failing_run(monkeypatch):
    """Make `run` raise whatever is put into the list."""
    errors = []

    def execute(args):
        raise errors[0]

    monkeypatch.setattr("hypermap_lite.cli.run.execute", execute)
    return errors


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_names_commands_exit_statuses_and_two_examples(capsys, option):
    with pytest.raises(SystemExit, match="0"):
        cli.main([option])
    text = capsys.readouterr().out
    assert {*cli.COMMANDS} <= {*text.split()}
    assert all(f"  {status} " in text for status in (0, 1, 2, 3, 4, 5, 130, 143))
    assert text.count("  python -m hypermap_lite ") >= 2


def test_no_argument_shows_the_help(capsys):
    with pytest.raises(SystemExit, match="0"):
        cli.main([])
    assert "commands:" in capsys.readouterr().out


def test_version_is_printed(capsys):
    with pytest.raises(SystemExit, match="0"):
        cli.main(["--version"])
    assert capsys.readouterr().out == f"hypermap-lite {__version__}\n"


@pytest.mark.parametrize(
    "arguments", [["a.json"], ["run", "a.json"], ["-q", "a.json"], ["--seed", "3", "a.json"], ["a.json", "--debug"]]
)
def test_first_argument_that_is_no_command_is_a_scenario(monkeypatch, arguments):
    seen = []
    monkeypatch.setattr("hypermap_lite.cli.run.execute", lambda args: seen.append(args) or 0)
    assert cli.main(arguments) == 0
    assert seen[0].scenario == "a.json"
    assert (seen[0].quiet, seen[0].debug) == ("-q" in arguments, "--debug" in arguments)


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (ScenarioError("$.seed", "is wrong"), 2),
        (UsageError("no"), 2),
        (RunFolderError("locked"), 2),
        (NoValidEvaluationError("none"), 3),
        (RepeatedFailureError("again"), 4),
        (ClientError("gone"), 5),
    ],
)
def test_each_error_has_its_exit_status_and_no_traceback(capsys, failing_run, error, status):
    failing_run.append(error)
    assert cli.main(["run", "a.json"]) == status
    assert capsys.readouterr().err == f"error: {error}\n"


def test_unexpected_error_is_reported_as_such(capsys, failing_run):
    failing_run.append(KeyError("x"))
    assert cli.main(["run", "a.json"]) == 1
    error = capsys.readouterr().err
    assert error.startswith("error: unexpected KeyError: 'x'")
    assert "Traceback" not in error


def test_debug_shows_the_traceback(capsys, failing_run):
    failing_run.append(UsageError("no"))
    assert cli.main(["run", "a.json", "--debug"]) == 2
    assert "Traceback" in capsys.readouterr().err


def test_interrupt_has_its_own_exit_status(capsys, failing_run):
    failing_run.append(KeyboardInterrupt())
    assert cli.main(["a.json"]) == 130
    assert capsys.readouterr().err == "error: interrupted\n"


def test_wrong_option_is_a_usage_error(capsys):
    with pytest.raises(SystemExit, match="2"):
        cli.main(["run", "a.json", "--sed", "3"])
    assert "--sed" in capsys.readouterr().err


def test_missing_scenario_is_an_error_without_a_traceback(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "hypermap_lite", str(tmp_path / "none.json")], capture_output=True, text=True
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: ")
    assert "none.json" in done.stderr


def test_heavy_libraries_are_not_imported_for_the_help():
    code = (
        "import sys, hypermap_lite, hypermap_lite.cli\n"
        "heavy = ('numpy', 'scipy', 'sklearn', 'pandas', 'matplotlib', 'rich', 'mujoco')\n"
        "print([name for name in heavy if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def shell(script, folder, **environment):
    """Run a shell script in which HL is the program."""
    script = script.replace("HL", f"'{sys.executable}' -m hypermap_lite")
    variables = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])} | environment
    command = ["/bin/bash", "-c", f"set -o pipefail; {script}"]
    return subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True)


@pytest.mark.parametrize(
    ("script", "status"),
    [
        pytest.param("HL run scenario.json --no-plot 2>&-", 0, id="stderr closed"),
        pytest.param("HL run scenario.json --no-plot >&-", 0, id="stdout closed", marks=pytest.mark.slow),
        pytest.param("HL check none.json 2>&-", 2, id="error with stderr closed", marks=pytest.mark.slow),
        pytest.param("HL check none.json 2>&1 | true", 2, id="error with stderr broken"),
        pytest.param("HL check none.json 2>/dev/full", 2, id="error with stderr full", marks=pytest.mark.slow),
        pytest.param("HL --help | true", 0, id="help with stdout broken"),
        pytest.param("HL check scenario.json | true", 0, id="stdout broken", marks=pytest.mark.slow),
        pytest.param("HL check scenario.json >/dev/full", 1, id="stdout full"),
    ],
)
def test_exit_status_does_not_depend_on_who_reads_messages(tmp_path, script, status):
    write_scenario(tmp_path, budget={"evaluations": 2})
    done = shell(script, tmp_path)
    assert done.returncode == status, done.stderr
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr


def test_terminal_without_plus_minus_gets_its_code(tmp_path):
    write_scenario(tmp_path, evaluator={"replicates": 2}, budget={"evaluations": 2})
    done = shell("HL run scenario.json --no-plot | cat; HL pareto run", tmp_path, PYTHONIOENCODING="ascii")
    assert done.returncode == 0, done.stderr
    assert "unexpected" not in done.stderr


def test_broken_pipe_of_something_else_is_an_unexpected_error(capsys, failing_run):
    failing_run.append(BrokenPipeError("not stdout"))
    assert cli.main(["run", "a.json"]) == 1
    assert "unexpected BrokenPipeError: not stdout" in capsys.readouterr().err


@pytest.mark.parametrize(("word", "guess"), [("plto", "plot"), ("chekc", "check"), ("paretto", "pareto")])
def test_misspelt_command_is_recognized(tmp_path, monkeypatch, capsys, word, guess):
    monkeypatch.chdir(tmp_path)
    assert cli.main([word, "out/one"]) == 2
    expected = f"error: '{word}' is neither a command nor a scenario file\n  hint: Did you mean '{guess}'?\n"
    assert capsys.readouterr().err == expected


def test_file_named_like_a_command_with_a_slip_is_a_scenario(tmp_path, monkeypatch):
    seen = []
    monkeypatch.setattr("hypermap_lite.cli.run.execute", lambda args: seen.append(args.scenario) or 0)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plto").write_text("{}")
    assert cli.main(["plto"]) == cli.main(["plot.json"]) == 0
    assert seen == ["plto", "plot.json"]
