"""Tests for study.py of the command line."""

import io
import shlex
import signal
import subprocess
import sys
import time

import pytest

from hypermap_lite.cli import main
from hypermap_lite.cli.study import PICTURES
from hypermap_lite.cli.study_progress import standing, study_progress
from hypermap_lite.cli.study_table import describe
from hypermap_lite.study import load_study, summarize
from hypermap_lite.study.progress import Failure, Progress
from hypermap_lite.study.running import FAREWELL_SECONDS, POLL_SECONDS
from tests.cli.test_progress import Terminal
from tests.study.studies import A, is_gone, loaded, sessions_of, table, wait_until, write_runs, write_study

CORNER = [{"name": "f", "reference_point": 4}, {"name": "g", "reference_point": 4}]
SCENARIO = {"objectives": CORNER, "budget": {"evaluations": 3}}
FOUND = {"a": [[[3, 3], [3, 3], [2, 3]], [[3, 3], [3, 1], [1, 3]]], "b": [[[3, 3], [2, 2], [2, 2]]] * 2}
"""Final hypervolumes: 2 and 5 of a, 4 and 4 of b; 6 of all."""


def study(file, *options):
    return main(["study", str(file), "-q", "--no-plot", *options])


def words(line):
    return " ".join(line.split())


@pytest.fixture
def file(tmp_path):
    """Return the file of a study whose runs have been written by hand."""
    path = write_study(tmp_path, scenario=SCENARIO)
    write_runs(load_study(path), n_design=1, **FOUND)
    return path


NAMES = ("summary", "averages", "comparison", "union_front")


def test_table_compares_the_variants_and_says_what_it_is_measured_by(file, capsys):
    assert study(file, "--summarize") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "demo: 3 evaluations per run"
    assert words(lines[2]) == "variant runs hypervolume share / a (95 %) evaluations to a (95 %)"
    assert words(lines[3]) == "a 2 3.5 ± 1.5 0.583 3 (3 to 3)"
    assert words(lines[4]) == "b 2 4 ± 0 0.667 1.14 (0.80 to 2.00) 2 (2 to never)"
    assert lines[6] == "hypervolume 6 is share 1 (reference point: f 4, g 4)"
    assert lines[7:] == [f"{file.parent}/out/{name}.csv" for name in NAMES]


def test_summary_of_half_a_study_says_what_is_missing_and_runs_nothing(file, capsys):
    assert study(file, "--summarize", "--repetitions", "3") == 0
    assert "2 runs are not finished and not counted" in capsys.readouterr().out
    assert not (file.parent / "out" / "runs" / "a" / "02").exists()


def test_summary_of_a_study_that_has_not_begun_is_an_error(tmp_path, capsys):
    assert study(write_study(tmp_path), "--summarize") == 2
    assert capsys.readouterr().err == f"error: {tmp_path}/out: no run of the baseline 'a' is finished yet\n"


def test_mistake_found_at_the_end_is_named_with_file_and_place(file, capsys, tmp_path):
    (tmp_path / "front.csv").write_text("f,h\n")
    write_study(tmp_path, scenario=SCENARIO, reference_front="front.csv")
    assert study(file, "--summarize") == 2
    assert capsys.readouterr().err.startswith(f"error: {file}: $.reference_front: {tmp_path}/front.csv has no rows")


def test_pictures_are_drawn_and_listed(file, capsys):
    assert main(["study", str(file), "--summarize", "-q"]) == 0
    out = capsys.readouterr().out
    for kind in PICTURES:
        assert f"{file.parent}/out/{kind}.png\n" in out
        assert (file.parent / "out" / f"{kind}.png").stat().st_size > 1000


def test_picture_that_fails_is_only_a_note(file, capsys, monkeypatch):
    def fail(*_, **__):
        raise ZeroDivisionError("oh")

    monkeypatch.setattr("hypermap_lite.plotting.plot_function", lambda kind: fail)
    assert main(["study", str(file), "--summarize", "-q"]) == 0
    out, err = capsys.readouterr()
    assert "comparison.csv" in out
    assert err.splitlines() == [f"note: no picture of kind {kind}: ZeroDivisionError: oh" for kind in PICTURES]


def test_files_below_the_working_folder_are_listed_as_seen_from_it(file, capsys, monkeypatch):
    monkeypatch.chdir(file.parent)
    assert study("study.json", "--summarize") == 0
    assert "\nout/summary.csv\n" in capsys.readouterr().out


@pytest.mark.parametrize(("goal", "sign"), [("minimize", 1), ("maximize", -1)])
def test_single_objective_is_shown_as_the_user_directed_it(tmp_path, goal, sign):
    chosen = loaded(tmp_path, scenario={**SCENARIO, "objectives": [{"name": "f", "goal": goal}]})
    a, b = ([[sign * value] for value in values] for values in ([5, 4, 3], [5, 2, 2]))
    write_runs(chosen, a=[a, a], b=[b, b])
    lines = describe(summarize(chosen)).splitlines()
    assert words(lines[2]) == "variant runs best f evaluations to a (95 %)"
    assert words(lines[3]) == f"a 2 {3 * sign} ± 0 3 (3 to 3)"
    assert words(lines[4]) == f"b 2 {2 * sign} ± 0 2 (2 to 2)"


def test_table_says_what_it_cannot_measure(tmp_path):
    chosen = loaded(tmp_path, scenario=SCENARIO)
    write_runs(chosen, a=[[[5, 5]] * 3] * 2, b=[[[5, 5], [5, 5], [1, 1]]] * 2)
    text = describe(summarize(chosen))
    assert "inf (inf to inf)" in text
    write_runs(chosen, a=[[[5, 5]] * 3] * 2, b=[[[5, 5]] * 3] * 2)
    text = describe(summarize(chosen))
    assert "nan" not in text
    assert "hypervolume 0 in all: nothing found beats the reference point in every objective" in text


@pytest.mark.parametrize("option", ["--workers", "--repetitions"])
def test_number_below_one_is_an_error_before_anything_runs(file, capsys, option):
    assert study(file, option, "0") == 2
    assert capsys.readouterr().err == f"error: {option} 0: expected a number >= 1\n"
    assert not (file.parent / "out" / "summary.csv").exists()


def test_help_says_where_everything_is_and_how_to_go_on(capsys):
    with pytest.raises(SystemExit, match="0"):
        main(["study", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    options = ("--quick", "--workers", "--repetitions", "--only", "--output-dir", "--set", "--summarize", "--no-plot")
    assert [option for option in options if option not in text] == []
    assert [
        name for name in ("summary.csv", "averages.csv", "comparison.csv", "union_front.csv") if name not in text
    ] == []
    assert "the same command goes on after any stop" in text
    assert text.count("python -m hypermap_lite study ") >= 2


@pytest.mark.slow
def test_run_that_keeps_failing_is_reported_beside_the_others_and_tried_again_from_the_start(tmp_path, capsys):
    write_study(tmp_path / "other")
    broken = {**A, "set": {"evaluator.max_consecutive_failures": 2}}
    path = write_study(
        tmp_path,
        variants={"whole": {"scenario": "other/scenario.json"}, "broken": broken},
        scenario={"function": "crash_unless_mended"},
        repetitions=1,
    )
    assert main(["study", str(path), "--no-plot", "--workers", "2"]) == 4
    out, err = capsys.readouterr()
    assert "whole     1" in out
    assert "1 run is not finished and not counted" in out
    lines = err.splitlines()
    assert lines[0] == "0 of 2 runs, 0 of 8 evaluations"
    assert sum(line.startswith("whole/00 finished; ") for line in lines) == 1
    failed = "the last 2 configurations gave no usable result: RuntimeError: broken"
    assert sum(line.startswith(f"broken/00 failed: {failed}; ") for line in lines) == 1
    assert lines[3:] == [
        "error: 1 run failed: broken/00",
        f"  broken/00: {failed}",
        f"  logs: {tmp_path}/out/runs/broken/00/trials/0001",
        "  hint: The same command tries them again.",
    ]
    (tmp_path / "mended").write_text("")
    assert study(path) == 0
    history = table(tmp_path / "out" / "runs" / "broken" / "00" / "history.csv")
    assert [row["state"] for row in history] == ["completed"] * 4


@pytest.mark.parametrize(
    ("statuses", "status"),
    [((3,), 3), ((3, 4, 1), 4), ((-9,), 1), ((143, -11), 1), ((2, -9), 2)],
    ids=["no result", "keeps failing", "killed", "ended and crashed", "folder in use"],
)
def test_runs_that_fail_without_any_tables_give_the_exit_status(tmp_path, capsys, monkeypatch, statuses, status):
    path = write_study(tmp_path, repetitions=3)
    runs = list(load_study(path).runs())
    failures = [Failure(run=run, exit_status=s, message=f"oh {s}") for run, s in zip(runs, statuses, strict=False)]
    monkeypatch.setattr("hypermap_lite.study.run_study", lambda *_, **__: failures)
    assert study(path) == status
    err = capsys.readouterr().err
    assert err.startswith(f"note: no tables: {tmp_path}/out: no run of the baseline 'a' is finished yet\nerror: ")
    assert f"  a/00: oh {statuses[0]}\n" in err


@pytest.fixture
def waiting(tmp_path):
    """Start a study whose run waits for a file at trial 2, and return once it waits."""
    path = write_study(tmp_path, variants={"a": A}, scenario={"function": "wait_alive"}, repetitions=1)
    command = [sys.executable, "-m", "hypermap_lite", "study", str(path), "--no-plot", "--set", "description=a b"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        wait_until(lambda: (tmp_path / "waiting_2").exists() or process.poll() is not None)
        yield process
        process.kill()


def test_interrupt_ends_in_order_and_tells_the_command_that_goes_on(tmp_path, waiting, capsys):
    waiting.send_signal(signal.SIGINT)
    assert any("Ctrl-C" in line for line in waiting.stderr)
    time.sleep(3 * POLL_SECONDS)  # until the wish has been passed on
    (tmp_path / "go").write_text("")
    out, err = waiting.communicate(timeout=30)
    assert (waiting.returncode, out) == (130, "")
    assert len(table(tmp_path / "out" / "runs" / "a" / "00" / "history.csv")) == 3
    notice, command = err.splitlines()[-2:]
    assert notice == f"stopped; all evaluations that were finished are saved in {tmp_path}/out. To go on:"
    arguments = shlex.split(command)
    words = [
        "python",
        "-m",
        "hypermap_lite",
        "study",
        f"{tmp_path}/study.json",
        "--set",
        "description=a b",
        "--no-plot",
    ]
    assert arguments == words
    assert main(arguments[3:]) == 0
    assert "demo: 4 evaluations per run" in capsys.readouterr().out


def test_terminate_ends_at_once_and_everything_it_started_with_it(tmp_path, waiting):
    waiting.send_signal(signal.SIGTERM)
    _, err = waiting.communicate(timeout=0.8 * FAREWELL_SECONDS)
    assert waiting.returncode == 143
    assert "To go on:\n  python -m hypermap_lite study " in err
    assert all(is_gone(session) for session in sessions_of(tmp_path))
    assert len(table(tmp_path / "out" / "runs" / "a" / "00" / "history.csv")) == 2


# --- while it runs ----------------------------------------------------------------------------------------------------


@pytest.fixture
def runs(tmp_path):
    return list(loaded(tmp_path).runs())


@pytest.fixture
def progress():
    return Progress(total_runs=4, total={"a": 8, "b": 8}, n_workers=1)


def story(observer, progress, runs):
    """Tell an observer of two evaluations, a run that ends and one that fails."""
    observer.on_start(progress)
    observer.on_run_start(runs[0])
    progress.running.append(runs[0])
    progress.advance(runs[0], 2, 600.0)
    observer.on_progress(progress)
    progress.running.clear()
    progress.done_runs = 1
    observer.on_run_end(runs[0], progress, None)
    progress.failed.append(runs[1])
    failure = Failure(run=runs[1], exit_status=4, message="no [bold]such luck\n  logs: somewhere")
    observer.on_run_end(runs[1], progress, failure)


def test_standing_has_the_time_left_once_it_is_known(progress, runs):
    assert standing(progress) == "0 of 4 runs, 0 of 16 evaluations"
    progress.advance(runs[0], 2, 600.0)
    assert standing(progress) == "0 of 4 runs, 2 of 16 evaluations, about 1:10:00 left"
    progress.done_runs = 4
    assert standing(progress) == "4 of 4 runs, 2 of 16 evaluations"


def test_pipe_gets_a_line_at_the_start_and_one_per_run(progress, runs):
    stream = io.StringIO()
    with study_progress(stream=stream) as observer:
        story(observer, progress, runs)
    assert stream.getvalue().splitlines() == [
        "0 of 4 runs, 0 of 16 evaluations",
        "a/00 finished; 1 of 4 runs, 2 of 16 evaluations, about 1:10:00 left",
        "b/00 failed: no [bold]such luck; 1 of 4 runs, 2 of 16 evaluations, about 0:50:00 left",
    ]


def test_terminal_gets_a_bar_with_failures_above_it(progress, runs, monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "160")
    stream = Terminal()
    with study_progress(stream=stream) as observer:
        story(observer, progress, runs)
    text = stream.getvalue()
    assert "1/4 runs" in text
    assert "2/16 evaluations" in text
    assert "about 0:50:00 left" in text
    assert "b/00 failed: no [bold]such luck\n" in text
    assert "finished" not in text


def test_quiet_study_says_nothing(progress, runs):
    stream = Terminal()
    with study_progress(is_quiet=True, stream=stream) as observer:
        story(observer, progress, runs)
    assert stream.getvalue() == ""


def test_dumb_terminal_gets_lines(progress, monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    stream = Terminal()
    with study_progress(stream=stream) as observer:
        observer.on_start(progress)
    assert stream.getvalue() == "0 of 4 runs, 0 of 16 evaluations\n"


def test_lines_that_nobody_can_read_do_not_stop_a_study(progress):
    class Closed(io.StringIO):
        def write(self, text):
            raise BrokenPipeError

    with study_progress(stream=Closed()) as observer:
        observer.on_start(progress)
