"""Tests for running.py and job.py: real runs, in processes of their own."""

import signal
import subprocess
import sys
import threading

import pytest

from hypermap_lite.cli import main
from hypermap_lite.errors import RunFolderError, ScenarioError
from hypermap_lite.study import load_study, run_study
from hypermap_lite.study.progress import Failure, Progress, StudyObserver
from tests.study.studies import (
    TWO,
    A,
    is_gone,
    loaded,
    rows,
    sessions_of,
    table,
    wait_until,
    write_study,
)


class Record(StudyObserver):
    """Notes the steps of a study."""

    def __init__(self):
        self.started = []
        self.ended = {}
        self.first = None
        self.last = None

    def on_start(self, progress):
        self.first = (progress.done_runs, progress.total_runs, progress.done_evaluations, progress.total_evaluations)

    def on_run_start(self, run):
        self.started.append(str(run))

    def on_run_end(self, run, progress, failure):
        self.ended[str(run)] = failure
        self.last = progress


def made(study, **options):
    """Run a study, and return the record of it."""
    record = Record()
    run_study(study, observer=record, **options)
    return record


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Return the file and the record of a study that has been run, two runs at a time."""
    file = write_study(tmp_path_factory.mktemp("finished"), baseline="b")
    return file, made(load_study(file, repetitions=1), workers=2)


def test_progress_counts_runs_and_evaluations(finished):
    _, record = finished
    assert record.first == (0, 2, 0, 8)
    assert record.ended == {"a/00": None, "b/00": None}
    assert (record.last.done_runs, record.last.done_evaluations, record.last.running) == (2, 8, [])
    assert record.last.seconds_left == 0.0


def test_second_call_makes_nothing(finished):
    file, _ = finished
    calls = (file.parent / "begun").read_text()
    record = made(load_study(file, repetitions=1), workers=2)
    assert (record.first, record.started) == ((2, 2, 8, 8), [])
    assert (file.parent / "begun").read_text() == calls


def test_more_repetitions_extend_a_finished_study(finished):
    file, _ = finished
    record = made(load_study(file, repetitions=2, only=["b"]), workers=1)
    assert record.first == (1, 2, 4, 8)
    assert record.started == ["b/01"]
    assert (record.last.done_runs, record.last.done_evaluations) == (2, 8)


@pytest.mark.parametrize("seed", [0, 1], ids=["two workers", "one worker"])
def test_run_of_a_study_is_the_run_of_its_scenario(finished, tmp_path, seed):
    file, _ = finished
    options = ["--seed", str(seed), "--output-dir", str(tmp_path), "--set", "acquisition.type=thompson_sampling"]
    assert main(["run", str(file.parent / "scenario.json"), "-q", "--no-plot", *options]) == 0
    assert rows(tmp_path) == rows(file.parent / "out" / "runs" / "b" / f"{seed:02d}")


@pytest.mark.slow
def test_number_of_workers_changes_no_row(tmp_path):
    scenario = {"optimizer": "bayesian", "budget": {"evaluations": 10}}
    studies = [load_study(write_study(tmp_path, scenario=scenario), output=tmp_path / str(n)) for n in (1, 3)]
    for study, workers in zip(studies, (1, 3), strict=True):
        assert set(made(study, workers=workers).ended.values()) == {None}
    pairs = list(zip(*(study.runs() for study in studies), strict=True))
    assert [rows(one.folder) == rows(three.folder) for one, three in pairs] == [True] * 4
    options = ["--output-dir", str(tmp_path / "run"), "--set", "acquisition.type=thompson_sampling"]
    assert main(["run", str(tmp_path / "scenario.json"), "-q", "--no-plot", *options]) == 0
    assert rows(tmp_path / "run") == rows(pairs[1][0].folder)


def test_results_of_another_scenario_are_refused_before_anything_runs(finished):
    file, _ = finished
    study = load_study(file, repetitions=5, overrides=["evaluator.replicates=2"])
    record = Record()
    with pytest.raises(
        RunFolderError, match=r"runs/a/00: holds the results of another.*\n.*replicates: 1 there, 2 now"
    ):
        run_study(study, observer=record)
    assert (record.first, record.started) == (None, [])


@pytest.mark.slow
def test_black_box_that_cannot_be_called_is_an_error_before_anything_runs(tmp_path):
    changes = {"evaluator.function": "no_such_module:f"}
    study = loaded(tmp_path, variants={**TWO, "broken": {"scenario": TWO["b"]["scenario"], "set": changes}})
    with pytest.raises(ScenarioError, match="no_such_module"):
        run_study(study)
    assert not study.folder.exists()


def test_run_without_any_result_fails_every_time(tmp_path):
    study = loaded(tmp_path, variants={"a": A}, scenario={"function": "crash"}, repetitions=1)
    for _ in range(2):
        record = made(study)
        assert (record.first[0], record.ended["a/00"].exit_status) == (0, 3)
        assert record.ended["a/00"].headline.startswith("none of the 4 evaluations gave a usable result")


@pytest.mark.slow
def test_run_whose_space_is_exhausted_is_finished(tmp_path):
    space = {"x": {"parameter_type": "ordinal", "values": [0, 1]}, "k": None}
    variants = {"a": {**A, "set": {"input_parameters": space}}}
    study = loaded(tmp_path, variants=variants, repetitions=1, scenario={"function": "wait_for_a_file"})
    (tmp_path / "go").write_text("")
    assert made(study).last.done_evaluations == 2
    assert made(study).first == (1, 1, 2, 2)


@pytest.mark.slow
def test_wish_to_stop_ends_the_runs_after_the_evaluation_they_are_at(tmp_path):
    study = loaded(tmp_path, variants={"a": A}, scenario={"function": "wait_alive"})

    def should_stop():
        is_waiting = (tmp_path / "waiting_2").exists()
        if is_waiting:  # what it is at goes on when the wish has been passed on
            threading.Timer(0.3, (tmp_path / "go").write_text, ("",)).start()
        return is_waiting

    record = made(study, should_stop=should_stop)
    assert (record.started, record.ended) == (["a/00"], {})
    assert len(table(tmp_path / "out/runs/a/00/history.csv")) == 3
    wait_until(lambda: all(is_gone(session) for session in sessions_of(tmp_path)), 5.0)


def test_killed_study_leaves_nothing_behind_and_goes_on_to_the_same_rows(tmp_path):
    file = write_study(tmp_path, variants={"a": A}, scenario={"function": "wait_alive"}, repetitions=1)
    command = [sys.executable, "-m", "hypermap_lite", "study", str(file), "-q"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        wait_until((tmp_path / "waiting_2").exists)
        process.send_signal(signal.SIGKILL)
    assert len(sessions_of(tmp_path)) == 2
    wait_until(lambda: all(is_gone(session) for session in sessions_of(tmp_path)), 5.0)
    run_folder = tmp_path / "out" / "runs" / "a" / "00"
    assert len(table(run_folder / "history.csv")) == 2
    (tmp_path / "go").write_text("")
    assert made(load_study(file)).ended == {"a/00": None}
    options = ["--output-dir", str(tmp_path / "whole"), "-q", "--no-plot"]
    assert main(["run", str(tmp_path / "scenario.json"), *options]) == 0
    assert rows(run_folder) == rows(tmp_path / "whole")


# --- progress ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def runs(tmp_path):
    return list(loaded(tmp_path, variants=TWO, repetitions=2).runs())


def progress_of(runs, *, n_workers=1):
    """Return the progress of two runs of each of two variants with four evaluations each."""
    return Progress(total_runs=len(runs), total={"a": 8, "b": 8}, n_workers=n_workers)


def test_time_left_is_not_known_before_the_first_evaluation(runs):
    progress = progress_of(runs)
    assert progress.seconds_left is None
    progress.advance(runs[0], 0, 3.0)
    assert progress.seconds_left is None


def test_time_left_by_hand(runs):
    progress = progress_of(runs)
    progress.advance(runs[0], 2, 6.0)
    assert progress.seconds_left == 14 * 3.0  # b is taken to be as fast as a
    progress.advance(runs[1], 1, 1.0)
    progress.advance(runs[1], 4, 3.0)
    assert progress.seconds_left == 6 * 3.0 + 4 * 1.0
    assert (progress.done_evaluations, progress.total_evaluations) == (6, 16)


def test_evaluations_of_earlier_sessions_take_no_time(runs):
    progress = progress_of(runs)
    progress.done[runs[0]] = 3
    progress.advance(runs[0], 4, 5.0)
    assert progress.seconds_left == 12 * 5.0


def test_time_left_is_shared_by_no_more_workers_than_runs_are_left(runs):
    progress = progress_of(runs, n_workers=3)
    progress.advance(runs[0], 4, 4.0)
    assert progress.seconds_left == 12 / 3
    progress.done_runs = 3
    assert progress.seconds_left == 12


def test_runs_that_failed_are_not_waited_for(runs):
    progress = progress_of(runs, n_workers=4)
    progress.advance(runs[0], 1, 1.0)
    progress.failed.append(runs[0])
    assert (progress.runs_left, progress.seconds_left) == (3, 12 / 3)


def test_failures_set_aside_are_no_progress(runs):
    progress = progress_of(runs)
    progress.done[runs[0]] = 2
    progress.advance(runs[0], 0, 1.0)
    assert (progress.seconds_left, progress.done_evaluations) == (None, 0)
    progress.advance(runs[0], 1, 1.0)
    assert progress.seconds_left == 15 * 2.0


@pytest.mark.parametrize(
    ("message", "headline"),
    [
        ("no such luck\n  hint: Try again.", "no such luck"),
        ("Traceback (most recent call last):\n  File x\nMemoryError: all gone", "MemoryError: all gone"),
        ("it ended with -9", "it ended with -9"),
    ],
    ids=["error", "traceback", "crash"],
)
def test_headline_says_most(runs, message, headline):
    assert Failure(run=runs[0], exit_status=1, message=message).headline == headline
