"""Tests for plot.py."""

import argparse

import pytest

from hypermap_lite import plotting
from hypermap_lite.cli import plot
from hypermap_lite.errors import RunFolderError, UsageError
from tests.plotting.run_folders import TWO_PARAMETERS, write_run
from tests.slow import slow_after


def run_command(*arguments):
    parser = argparse.ArgumentParser()
    plot.add_parser(parser.add_subparsers())
    return plot.execute(parser.parse_args(["plot", *map(str, arguments)]))


@pytest.fixture
def outputs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("op_2", "op_1", "no_1"):
        write_run(tmp_path / "outputs" / name, [[1.0, 2.0], [2.0, 1.0]], n_design=1, parameters=TWO_PARAMETERS)
    (tmp_path / "outputs" / "op_notes.txt").touch()
    return tmp_path / "outputs"


def test_help_lists_exactly_the_kinds_there_are():
    assert list(plot.KINDS) == list(plotting.KINDS)


@pytest.mark.parametrize("kind", slow_after(2, plot.KINDS))
def test_files_written_are_listed_on_stdout(outputs, capsys, kind):
    if kind == "regret":  # for one objective
        write_run(outputs / "op_1", [[1.0], [2.0]], objectives=[{"name": "f"}], parameters=TWO_PARAMETERS)
    assert run_command(kind, outputs / "op_1", "--csv") == 0
    listed = capsys.readouterr().out.split()
    stem = outputs / "op_1" / kind
    assert listed == [f"{stem}.png", f"{stem}.pdf", f"{stem}_data.csv"]


def test_regret_takes_the_minimum_and_a_logarithmic_axis(outputs, capsys):
    write_run(outputs / "op_1", [[3.0], [2.0]], objectives=[{"name": "f"}])
    run_command("regret", outputs / "op_1", "--minimum", "1.5", "--log", "--csv", "--output", "p.png")
    data = (outputs.parent / "p_data.csv").read_text().splitlines()
    assert [line.split(",")[3] for line in data] == ["regret", "1.5", "0.5"]


def test_options_reach_the_picture(outputs, capsys):
    run_command("hypervolume", "with=outputs/op_*", "outputs/no_1", "--output", "x.png", "--title", "T", "--csv")
    assert capsys.readouterr().out.split() == ["x.png", "x_data.csv"]
    lines = (outputs.parent / "x_data.csv").read_text().splitlines()
    assert {line.split(",")[0] for line in lines[1:]} == {"with", "outputs/no_1"}


def test_parameters_are_chosen_by_name(outputs, capsys):
    assert run_command("prior", "outputs/op_1", "--parameters", "k, x", "--csv", "-o", "p.png") == 0
    assert (outputs.parent / "p_data.csv").read_text().startswith("what,k,x,density")


def test_scenario_file_stands_for_its_prior(outputs, capsys):
    (outputs.parent / "mine.json").write_bytes((outputs / "op_1" / "scenario.json").read_bytes())
    assert run_command("prior", "mine.json") == 0
    assert capsys.readouterr().out.split() == ["prior.png", "prior.pdf"]


@pytest.mark.parametrize("kind", ["parameters", "prior"])
def test_unknown_parameter_is_an_error_with_the_nearest_name(outputs, kind):
    with pytest.raises(UsageError, match=r"unknown parameter 'X1'; known: x, k"):
        run_command(kind, "outputs/op_1", "--parameters", "X1,k")


def test_parameters_of_a_kind_without_them_are_an_error(outputs):
    with pytest.raises(UsageError, match="`plot pareto` shows no parameters to choose from"):
        run_command("pareto", "outputs/op_1", "--parameters", "x,k")


def test_pattern_with_a_label_makes_repetitions(outputs):
    folders, labels = plot.expand_runs(["op=outputs/op_*", "none=outputs/no_1"], None)
    assert [str(f) for f in folders] == ["outputs/op_1", "outputs/op_2", "outputs/no_1"]
    assert labels == ["op", "op", "none"]


def test_pattern_without_label_is_a_list_of_runs(outputs):
    folders, labels = plot.expand_runs(["outputs/op_*"], None)
    assert [f.name for f in folders] == ["op_1", "op_2"]
    assert labels is None


def test_labels_option_goes_with_the_arguments(outputs):
    assert plot.expand_runs(["outputs/op_*", "outputs/no_1"], ["a", " b"])[1] == ["a", "a", "b"]


def test_folder_with_an_equals_sign_needs_no_label(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_run(tmp_path / "beta=2", [[1.0, 1.0]])
    assert plot.expand_runs(["beta=2"], None)[1] is None


def test_wrong_number_of_labels_is_an_error(outputs):
    with pytest.raises(UsageError, match="--labels names 1 runs, but 2 are given"):
        run_command("pareto", "outputs/op_1", "outputs/op_2", "--labels", "a")


def test_pattern_that_matches_nothing_is_an_error(outputs):
    with pytest.raises(UsageError, match=r"no run folder matches 'outputs/x_\*'"):
        run_command("pareto", "x=outputs/x_*")


def test_missing_folder_is_an_error(outputs):
    with pytest.raises(RunFolderError, match="outputs/nothing: not a run folder"):
        run_command("pareto", "outputs/nothing")


def test_reference_points_are_read_by_objective():
    assert plot.parse_reference_point(["safety=-3000", "a=b=1e3"]) == {"safety": -3000.0, "a=b": 1000.0}


@pytest.mark.parametrize("text", ["safety", "safety=low", "=3"])
def test_reference_point_in_another_form_is_an_error(text):
    with pytest.raises(UsageError, match=f"--reference-point {text}: expected OBJECTIVE=VALUE"):
        plot.parse_reference_point([text])
