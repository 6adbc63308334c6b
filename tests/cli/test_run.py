"""Tests for run.py of the command line."""

import csv
import json
import resource
import signal
import subprocess
import sys
import time

import pytest

from hypermap_lite.cli import main
from tests.cli.scenarios import write_scenario
from tests.slow import slow_after

K = {"parameter_type": "integer", "values": [0, 9]}


def run(path, *options):
    return main(["run", str(path), "--no-plot", *options])


def history(folder):
    return rows_of(folder / "history.csv")


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_results_go_to_stdout_and_the_story_to_stderr(tmp_path, capsys):
    assert run(write_scenario(tmp_path)) == 0
    out, err = capsys.readouterr()
    assert out.startswith("demo: 8 evaluations: 8 completed; the run ended because the budget")
    assert "f (minimize)" in out
    assert "hypervolume" in out
    assert "inferred reference point" in out
    assert str(tmp_path / "run" / "history.csv") in out
    assert err.count("\ntrial ") + err.startswith("trial ") == 8


def test_files_written_besides_the_run_folder_are_named(tmp_path, capsys):
    files = {"samples_file": "samples.csv", "pareto_file": "front.csv"}
    files = {key: str(tmp_path / name) for key, name in files.items()}
    assert run(write_scenario(tmp_path, output={"directory": str(tmp_path / "run"), **files})) == 0
    out = capsys.readouterr().out
    assert str(tmp_path / "samples.csv") in out
    assert str(tmp_path / "front.csv") in out


def test_a_note_is_said_once_and_logged(tmp_path, capsys):
    document = {
        "optimization_objectives": ["f"],
        "input_parameters": {"x": {"parameter_type": "real", "values": [0, 1]}},
        "number_of_cpus": 2,
        "optimization_iterations": 0,
        "run_directory": str(tmp_path),
        "evaluator": {"type": "command", "command": ["echo", '{"f": 1}']},
    }
    path = tmp_path / "theirs.json"
    path.write_text(json.dumps(document))
    assert run(path) == 0
    assert capsys.readouterr().err.count("number_of_cpus") == 1
    assert "INFO number_of_cpus" in (tmp_path / "application_run" / "run.log").read_text()


def test_picture_is_drawn_at_the_end(tmp_path, capsys):
    assert main([str(write_scenario(tmp_path, budget={"evaluations": 4})), "-q"]) == 0
    assert (tmp_path / "run" / "pareto.png").stat().st_size > 1000
    assert "pareto.png" in capsys.readouterr().out


def test_one_objective_ends_with_its_best_configuration_and_its_course(tmp_path, capsys):
    path = write_scenario(tmp_path, objectives=[{"name": "f"}], budget={"evaluations": 4})
    assert main([str(path), "-q"]) == 0
    out = capsys.readouterr().out
    table = out.split("\n\n")[1].splitlines()
    assert len(table) == 2
    assert table[1].split()[0] == min(history(tmp_path / "run"), key=lambda row: float(row["f"]))["trial"]
    assert (tmp_path / "run" / "objectives.png").exists()


def test_missing_matplotlib_is_only_a_note(tmp_path, capsys, monkeypatch):
    for name in [name for name in sys.modules if name.split(".")[0] == "matplotlib" or ".plotting." in name]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main([str(write_scenario(tmp_path, budget={"evaluations": 2})), "-q"]) == 0
    assert "note: no picture: " in capsys.readouterr().err


def test_quiet_run_says_nothing_on_stderr(tmp_path, capsys):
    assert run(write_scenario(tmp_path), "-q") == 0
    assert capsys.readouterr().err == ""


def test_options_change_the_scenario(tmp_path):
    folder = tmp_path / "elsewhere"
    options = ["--seed", "5", "--workers", "2", "--output-dir", str(folder), "--set", "budget.evaluations=3"]
    assert run(write_scenario(tmp_path), *options, "--set", "description=a: b") == 0
    recorded = json.loads((folder / "scenario.json").read_text())
    assert (recorded["seed"], recorded["evaluator"]["workers"], recorded["description"]) == (5, 2, "a: b")
    assert len(history(folder)) == 3


def test_second_run_goes_on_and_a_finished_one_only_reports(tmp_path, capsys):
    path = write_scenario(tmp_path)
    assert run(path, "--set", "budget.evaluations=3") == 0
    assert run(path) == 0
    assert run(path) == 0
    assert len((tmp_path / "begun").read_text().splitlines()) == 8
    assert len(history(tmp_path / "run")) == 8


def test_other_scenario_in_the_folder_is_refused_with_the_difference(tmp_path, capsys):
    path = write_scenario(tmp_path)
    assert run(path) == 0
    assert run(path, "--seed", "9") == 2
    assert "$.seed: 0 there, 9 now" in capsys.readouterr().err


def test_fresh_start_keeps_the_old_folder_aside(tmp_path, capsys):
    path = write_scenario(tmp_path, budget={"evaluations": 2})
    assert run(path) == 0
    assert run(path, "--seed", "9", "--fresh") == 0
    assert (tmp_path / "run.bak-1" / "history.csv").exists()
    assert "is now" in capsys.readouterr().err


def test_fresh_start_keeps_the_old_folder_in_place_when_the_scenario_cannot_be_run(tmp_path, capsys):
    assert run(write_scenario(tmp_path, budget={"evaluations": 2})) == 0
    assert run(write_scenario(tmp_path, evaluator={"type": "python", "function": "nowhere:f"}), "--fresh") == 2
    assert (tmp_path / "run" / "history.csv").exists()
    assert not (tmp_path / "run.bak-1").exists()


def test_fresh_start_leaves_what_is_no_run_folder_alone(tmp_path, capsys):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.tex").write_text("")
    assert run(write_scenario(tmp_path), "--fresh", "--output-dir", str(tmp_path / "thesis")) == 2
    assert "is not a run folder" in capsys.readouterr().err


def test_fresh_start_leaves_the_working_folder_and_that_of_the_scenario_alone(tmp_path, capsys, monkeypatch):
    path = write_scenario(tmp_path)
    assert run(path, "--fresh", "--output-dir", str(tmp_path)) == 2
    monkeypatch.chdir(tmp_path)
    assert run(path, "--fresh", "--output-dir", ".") == 2
    assert capsys.readouterr().err.count("cannot be set aside") == 2
    assert path.exists()


def test_fresh_start_takes_the_record_of_the_run_for_its_scenario(tmp_path):
    path = write_scenario(tmp_path, budget={"evaluations": 2})
    assert run(path) == 0
    assert run(tmp_path / "run" / "scenario.json", "--fresh") == 0
    assert (tmp_path / "run.bak-1" / "history.csv").exists()


@pytest.mark.parametrize("budgets", [(4, 9), (9, 7)], ids=["raised", "lowered"])
def test_budget_may_change_across_the_size_of_the_derived_design(tmp_path, budgets):
    path = write_scenario(tmp_path, design_of_experiment={"number_of_samples": None})
    for n in budgets:
        assert run(path, "--set", f"budget.evaluations={n}") == 0
    assert run(path, "--set", "budget.evaluations=3") == 0
    rows = history(tmp_path / "run")
    assert [row["phase"] for row in rows] == ["design"] * 6 + ["random"] * (max(budgets) - 6)


def test_hints_of_a_run_that_keeps_failing_can_be_followed(tmp_path, capsys):
    path = write_scenario(tmp_path, function="crash")
    assert run(path) == 4
    error = capsys.readouterr().err
    assert "--retry-failed" in error
    assert "set evaluator.max_consecutive_failures to more" in error
    assert run(path, "--set", "evaluator.max_consecutive_failures=7") == 4
    assert len(history(tmp_path / "run")) == 7


def test_failed_trials_are_tried_again_with_the_same_seeds(tmp_path, capsys):
    path = write_scenario(tmp_path, function="crash_unless_mended", evaluator={"replicates": 2})
    assert run(path) == 4
    before = calls(tmp_path / "run")
    (tmp_path / "mended").write_text("")
    assert run(path, "--retry-failed") == 0
    assert "8 evaluations: 8 completed" in capsys.readouterr().out
    after = calls(tmp_path / "run")
    assert [row["seed"] for row in after[: len(before)]] == [row["seed"] for row in before]
    assert {row["state"] for row in after} == {"completed"}
    assert len((tmp_path / "run" / "history.csv.bak-1").read_text().splitlines()) == 6
    fresh = tmp_path / "fresh"
    assert run(path, "--output-dir", str(fresh)) == 0
    assert [(row["x"], row["f"]) for row in history(fresh)] == [(r["x"], r["f"]) for r in history(tmp_path / "run")]


def calls(folder):
    with (folder / "evaluations.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_name_that_ends_like_a_table_is_a_folder_all_the_same(tmp_path, capsys):
    folder = tmp_path / "a.csv"
    options = ["--output-dir", str(folder), "--set", "budget.evaluations=2", "-q"]
    assert main([str(write_scenario(tmp_path)), *options]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert str(folder / "pareto.png") in out


def test_huge_values_end_with_a_note_and_status_0(tmp_path, capsys):
    assert main([str(write_scenario(tmp_path, function="huge")), "-q"]) == 0
    out, err = capsys.readouterr()
    assert "hypervolume not available" in out
    assert err.startswith("note: no picture: ")


def test_summary_and_picture_that_fail_are_only_notes(tmp_path, capsys, monkeypatch):
    def fail(*_):
        raise ZeroDivisionError("oh")

    monkeypatch.setattr("hypermap_lite.cli.run._print_front", fail)
    monkeypatch.setattr("hypermap_lite.cli.run._draw", fail)
    assert main([str(write_scenario(tmp_path, budget={"evaluations": 2})), "-q"]) == 0
    out, err = capsys.readouterr()
    assert err == "note: no summary: ZeroDivisionError: oh\nnote: no picture: ZeroDivisionError: oh\n"
    assert "history.csv" in out


def test_failing_first_trial_does_not_stop_the_run(tmp_path, capsys):
    assert run(write_scenario(tmp_path, function="crash_first")) == 0
    assert "8 evaluations: 7 completed, 1 failed" in capsys.readouterr().out
    assert history(tmp_path / "run")[0]["error"] == "RuntimeError: cold start"


def test_evaluator_that_keeps_failing_ends_with_status_4(tmp_path, capsys):
    assert run(write_scenario(tmp_path, function="crash")) == 4
    assert "last 5 configurations gave no usable result: RuntimeError: no such luck" in capsys.readouterr().err
    assert len(history(tmp_path / "run")) == 5


def test_run_without_a_result_ends_with_status_3(tmp_path, capsys):
    assert run(write_scenario(tmp_path, function="crash", budget={"evaluations": 2})) == 3
    assert "none of the 2 evaluations gave a usable result" in capsys.readouterr().err


def test_folder_that_cannot_be_made_ends_with_status_2(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert run(write_scenario(tmp_path), "--output-dir", str(tmp_path / "file" / "run")) == 2
    assert "cannot be written: Not a directory" in capsys.readouterr().err


@pytest.mark.slow
def test_full_disk_ends_with_status_2_and_the_next_run_goes_on(tmp_path):
    path = write_scenario(tmp_path, budget={"evaluations": 60, "batch_size": 2})
    done = subprocess.run(
        [sys.executable, "-m", "hypermap_lite", "run", str(path), "--no-plot", "-q"],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000)),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 2
    assert "cannot be written: File too large" in done.stderr
    assert "hint: Free some space" in done.stderr
    assert "Traceback" not in done.stderr
    assert run(path) == 0
    assert len(history(tmp_path / "run")) == 60
    assert len((tmp_path / "begun").read_text().splitlines()) <= 61


def test_evaluator_that_does_not_import_is_named_with_its_place(tmp_path, capsys):
    path = write_scenario(tmp_path, evaluator={"type": "python", "function": "nowhere:f"})
    assert run(path) == 2
    error = capsys.readouterr().err
    assert "$.evaluator.function: importing 'nowhere' failed: ModuleNotFoundError" in error
    assert "scenario.json" in error


def test_front_of_another_run_replaces_the_priors(tmp_path, capsys, monkeypatch):
    path = write_scenario(tmp_path, input_parameters={"k": {**K, "prior": {"type": "beta", "shape": "decay"}}})
    assert run(path) == 0
    capsys.readouterr()
    monkeypatch.chdir(tmp_path)
    options = ["--prior-from", "run", "--output-dir", "second"]
    assert run(path, *options) == 0
    assert "note: --prior-from run takes the place of the prior of k\n" in capsys.readouterr().err
    recorded = json.loads((tmp_path / "second" / "scenario.json").read_text())
    front = rows_of(tmp_path / "run" / "pareto.csv")
    (prior,) = recorded["priors"]
    assert prior["points"]["x"] == [float(row["x"]) for row in front]
    assert prior["points"]["k"] == [int(row["k"]) for row in front]
    assert recorded["input_parameters"]["k"]["prior"] is None
    assert recorded["design_of_experiment"]["type"] == "prior_sampling"


def test_run_with_the_prior_of_another_goes_on_with_the_points_it_began_with(tmp_path, capsys):
    path, first = write_scenario(tmp_path), str(tmp_path / "run")
    assert run(path, "--set", "budget.evaluations=4") == 0
    options = ["--prior-from", first, "--output-dir", str(tmp_path / "second")]
    assert run(path, *options, "--set", "budget.evaluations=3") == 0
    assert run(path, *options, "--set", "budget.evaluations=4") == 0
    before = history(tmp_path / "second")
    with (tmp_path / "run" / "pareto.csv").open("a") as file:
        file.write((tmp_path / "run" / "history.csv").read_text().splitlines()[1] + "\n")
    assert run(path, *options) == 2
    assert "$.priors[0].points.x: " in capsys.readouterr().err
    assert run(tmp_path / "second" / "scenario.json", "--set", "budget.evaluations=8") == 0
    assert history(tmp_path / "second")[:4] == before
    assert len(history(tmp_path / "second")) == 8


def test_command_to_go_on_keeps_the_prior(tmp_path):
    from argparse import Namespace

    from hypermap_lite.cli.run import command_to_go_on

    options = {"seed": None, "workers": 2, "output_dir": None, "overrides": ["seed=3"], "prior_from": "my run"}
    command = command_to_go_on(Namespace(scenario="s.json", **options))
    assert command == "python -m hypermap_lite run s.json --workers 2 --prior-from 'my run' --set seed=3"


@pytest.fixture
def waiting(tmp_path):
    """Start a run whose trial 2 waits for a file, and return once it waits."""
    path = write_scenario(tmp_path, function="wait_for_a_file")
    command = [sys.executable, "-m", "hypermap_lite", "run", str(path), "--no-plot"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        wait_for((tmp_path / "waiting_2").exists, process)
        yield process
        process.kill()


def wait_for(condition, process):
    deadline = time.monotonic() + 30
    while not condition():
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)


def test_first_interrupt_lets_the_running_evaluation_finish(tmp_path, waiting):
    waiting.send_signal(signal.SIGINT)
    assert "waiting for the evaluations that are running" in read_until(waiting.stderr, "Ctrl-C")
    (tmp_path / "go").write_text("")
    out, err = waiting.communicate(timeout=30)
    assert (waiting.returncode, out) == (130, "")
    assert "To go on:\n  python -m hypermap_lite run " in err
    assert [row["trial"] for row in history(tmp_path / "run")] == ["0", "1", "2"]


def read_until(stream, word):
    for line in stream:
        if word in line:
            return line
    raise AssertionError(f"{word} never came")


@pytest.mark.parametrize(
    ("signals", "status"),
    slow_after(1, [([signal.SIGINT, signal.SIGINT], 130), ([signal.SIGTERM], 143), ([signal.SIGHUP], 129)]),
    ids=["two interrupts", "terminate", "hang up"],
)
def test_stop_at_once_kills_what_runs_and_keeps_what_is_finished(tmp_path, waiting, signals, status):
    for number in signals[:-1]:
        waiting.send_signal(number)
        read_until(waiting.stderr, "Ctrl-C")
    waiting.send_signal(signals[-1])
    _, err = waiting.communicate(timeout=30)
    assert waiting.returncode == status
    assert "stopped; all evaluations that were finished are saved" in err
    assert [row["trial"] for row in history(tmp_path / "run")] == ["0", "1"]
    (tmp_path / "go").write_text("")
    assert run(tmp_path / "scenario.json") == 0
    assert len(history(tmp_path / "run")) == 8


def test_interrupted_run_ends_with_130_though_nobody_reads_stderr(tmp_path, waiting):
    waiting.stderr.close()
    waiting.send_signal(signal.SIGINT)
    (tmp_path / "go").write_text("")
    assert waiting.wait(30) == 130
