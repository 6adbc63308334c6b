"""Tests for hypermapper.py and hypermapper_home.py: what clients of HyperMapper start."""

from __future__ import annotations

import shutil
import sys

import pytest

from hypermap_lite.cli import hypermapper, main
from tests.cli.clients import converse, environment, history, write_scenario
from tests.cli.scenarios import write_scenario as write_python_scenario


def test_every_call_is_a_run_of_its_own_and_the_former_is_kept(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("HYPERMAPPER_HOME", raising=False)
    scenario = write_python_scenario(tmp_path, budget={"evaluations": 3})
    assert [hypermapper.main([str(scenario)]) for _ in range(3)] == [0, 0, 0]
    out, err = capsys.readouterr()
    assert out.count("demo: 3 evaluations: 3 completed") == 3
    assert err.count("note: the former run folder is now") == 2
    assert [len(history(tmp_path / name)) for name in ("run", "run.bak-1", "run.bak-2")] == [3, 3, 3]
    assert not (tmp_path / "run" / "pareto.png").exists()
    assert main(["run", str(scenario), "-q", "--no-plot"]) == 0
    assert not (tmp_path / "run.bak-3").exists()


@pytest.mark.parametrize("arguments", [[], ["a.json", "b.json"], ["--fast"]])
def test_wrong_call_shows_the_usage(arguments, capsys):
    assert hypermapper.main(arguments) == 2
    assert capsys.readouterr().err.startswith("usage: hypermapper SCENARIO")


def test_help_is_no_error(capsys):
    assert hypermapper.main(["--help"]) == 0
    assert "begins a new run" in capsys.readouterr().out


def test_error_has_its_status(tmp_path, monkeypatch):
    monkeypatch.delenv("HYPERMAPPER_HOME", raising=False)
    assert hypermapper.main([str(tmp_path / "missing.json")]) == 2


def test_home_moves_to_pwd_and_holds_scenarios_not_found_from_here(tmp_path, monkeypatch):
    for name in ("home", "here", "pwd"):
        (tmp_path / name).mkdir()
    (tmp_path / "home" / "s.json").write_text("{}")
    monkeypatch.setenv("HYPERMAPPER_HOME", str(tmp_path / "home"))
    monkeypatch.setenv("PWD", str(tmp_path / "pwd"))
    monkeypatch.chdir(tmp_path / "here")
    assert hypermapper.find_scenario("s.json") == tmp_path / "home" / "s.json"
    (tmp_path / "here" / "s.json").write_text("{}")
    assert hypermapper.find_scenario("s.json") == tmp_path / "here" / "s.json"
    hypermapper.change_directory()
    assert hypermapper.Path.cwd() == tmp_path / "pwd"


def test_without_home_the_working_directory_stays(tmp_path, monkeypatch):
    monkeypatch.delenv("HYPERMAPPER_HOME", raising=False)
    monkeypatch.setenv("PWD", "/")
    monkeypatch.chdir(tmp_path)
    hypermapper.change_directory()
    assert hypermapper.Path.cwd() == tmp_path


@pytest.fixture
def home(tmp_path, capsys):
    assert main(["hypermapper-home", str(tmp_path / "home")]) == 0
    assert f"export HYPERMAPPER_HOME={tmp_path / 'home'}" in capsys.readouterr().out
    return tmp_path / "home"


@pytest.mark.parametrize("place", ["hypermapper/optimizer.py", "bin/hypermapper"])
def test_unchanged_client_talks_to_this_installation_whatever_its_python_is(tmp_path, home, place):
    other = next((p for p in ("/usr/bin/python3", shutil.which("python3")) if p and shutil.which(p)), sys.executable)
    command = [str(home / place)] if place.startswith("bin") else [other, str(home / place)]
    scenario = write_scenario(tmp_path)
    env = environment(HYPERMAPPER_HOME=str(home), PWD=str(tmp_path))
    del env["PYTHONPATH"]
    said = converse(scenario, command=command, options=(), env=env)
    assert said.status == 0, said.stderr
    assert said.heard.startswith(b"Request 4\nx,n,o,c\n0.0,3,1,green\n")
    assert said.heard.endswith(b"End of HyperMapper\n")
    assert "trial 0" not in said.stderr


def test_home_is_written_again_but_not_over_another_program(tmp_path, home, capsys):
    assert main(["hypermapper-home", str(home)]) == 0
    (home / "scripts" / "hypermapper.py").write_text("print('mine')\n")
    assert main(["hypermapper-home", str(home)]) == 2
    assert "belongs to another program" in capsys.readouterr().err
    assert (home / "scripts" / "hypermapper.py").read_text() == "print('mine')\n"


def test_home_that_cannot_be_written_is_an_error(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["hypermapper-home", str(tmp_path / "file" / "home")]) == 2
    assert "cannot be written" in capsys.readouterr().err
