"""Tests for cli/__init__.py and __main__.py."""

import subprocess
import sys

import pytest

from hypermap_lite import __version__, cli
from hypermap_lite.errors import NoValidEvaluationError, RepeatedFailureError, RunFolderError, ScenarioError, UsageError


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
    assert all(f"    {command} " in text for command in cli.COMMANDS)
    assert all(f"  {status} " in text for status in (0, 1, 2, 3, 4, 130, 143))
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
