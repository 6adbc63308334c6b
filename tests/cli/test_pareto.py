"""Tests for pareto.py."""

import argparse
import csv

import numpy as np
import pytest

from hypermap_lite.cli import pareto
from hypermap_lite.errors import RunFolderError
from hypermap_lite.plotting.runs import load_run
from tests.plotting.run_folders import write_run


def run_command(*arguments):
    parser = argparse.ArgumentParser()
    pareto.add_parser(parser.add_subparsers())
    return pareto.execute(parser.parse_args(["pareto", *map(str, arguments)]))


@pytest.fixture
def folder(tmp_path):
    Y = [[1.0, -3000.0], [np.nan, np.nan], [0.1 + 0.2, -1234.56], [0.0, -2000.0]]
    return write_run(tmp_path / "run", Y, sem=np.array(Y) * 0 + 134.2)


def test_csv_has_the_rows_of_the_history_unchanged(folder, capsys):
    assert run_command(folder, "--csv") == 0
    history = (folder / "history.csv").read_text().splitlines()
    expected = "\n".join([history[0], history[1], history[3]]) + "\n"
    assert capsys.readouterr().out == expected
    assert (folder / "pareto.csv").read_text() == expected


def test_output_to_a_file_or_pipe_is_csv_and_the_hypervolume_goes_to_stderr(folder, capsys):
    run_command(folder / "history.csv", "--reference-point", "performance=0", "--reference-point=safety=-4000")
    printed = capsys.readouterr()
    assert len(list(csv.DictReader(printed.out.splitlines()))) == 2
    # 1 x 1000 and 0.3 x 1765.44 beyond it
    assert printed.err == (
        "2 of 3 completed configurations on the front; hypervolume 1529.63 "
        "(reference point: performance 0, safety -4000)\n"
    )


def test_terminal_shows_a_table_best_first_and_the_hypervolume(folder, capsys, monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    run_command(folder)
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    assert lines[0].split() == ["trial", "performance", "(maximize)", "safety", "(maximize)", "x"]
    assert lines[1].split() == ["0", "1", "±", "130", "-3000", "±", "130", "0"]
    assert lines[2].split() == ["2", "0.3", "±", "130", "-1235", "±", "130", "0.2"]
    assert len({len(line) for line in lines[:3]}) == 1
    assert "inferred reference point" in lines[3]
    assert printed.err == ""


def test_one_objective_has_its_best_rows_and_no_hypervolume(tmp_path):
    run = load_run(write_run(tmp_path, [[2.0], [1.0], [1.0]], objectives=[{"name": "f"}]))
    assert pareto.describe_front(run) == "2 of 3 completed configurations on the front"
    assert pareto.front_as_table(run).splitlines()[1].split() == ["1", "1", "0.1"]


def test_rows_of_a_confirmed_configuration_count_once(tmp_path, capsys):
    Y, configurations = [[1.0], [2.0], [4.0], [2.0]], [["0"], ["1"], ["0"], ["0"]]
    folder = write_run(tmp_path, Y, objectives=[{"name": "f"}], configurations=configurations)
    history = folder / "history.csv"
    history.write_text(history.read_text().replace(",2,model,", ",2,confirm,"))
    run_command(folder)
    assert capsys.readouterr().err == "1 of 2 completed configurations on the front\n"


def test_front_of_a_folder_that_cannot_be_written_is_printed_all_the_same(folder, capsys, monkeypatch):
    def refuse(path, _):
        raise RunFolderError(f"{path}: cannot be written: Permission denied\n  hint: Choose another.")

    monkeypatch.setattr("hypermap_lite.history.files.write_atomically", refuse)
    assert run_command(folder, "--csv") == 0
    out, err = capsys.readouterr()
    assert len(out.splitlines()) == 3
    assert err.splitlines()[1:] == [f"note: {folder}/pareto.csv: cannot be written: Permission denied"]


def test_values_that_are_words_stay_as_they_are(folder):
    file = folder / "history.csv"
    file.write_text(file.read_text().replace("\n0.0,", "\nspiral,", 1))
    assert "spiral" in pareto.front_as_table(load_run(folder))


def test_run_without_a_result_is_an_error(tmp_path):
    folder = write_run(tmp_path, [[np.nan, np.nan]])
    with pytest.raises(RunFolderError, match=r"no completed evaluation yet \(1 failed\)"):
        run_command(folder)
    assert not (folder / "pareto.csv").exists()
