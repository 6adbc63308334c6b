"""Samples files of HyperMapper on the command line."""

import csv
import json

import pytest

from hypermap_lite.cli import main
from hypermap_lite.errors import RunFolderError
from hypermap_lite.plotting.runs import SamplesFile, load_run, load_runs

LINES = ("Energy,x,Valid,Timestamp,Value", "5.0,1,True,10.0,1.0", "4.0,2,True,20.0,2.0", "0.0,3,False,30.0,0.0")
MEANING = {"objectives": [{"name": "Value"}, {"name": "Energy"}]}
SCENARIO = {
    "application_name": "branin",
    "input_parameters": {"x": {"parameter_type": "integer", "values": [0, 9]}},
    "objectives": [{"name": "Value"}, {"name": "Energy"}],
    "design_of_experiment": {"number_of_samples": 1},
}


@pytest.fixture
def samples(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "branin_output_samples.csv"
    file.write_bytes("\r\n".join((*LINES, "6.0,2.0,True,40.0,3.0", "")).encode())
    (tmp_path / "s.json").write_text(json.dumps(SCENARIO))
    return file


def test_front_goes_to_a_file_beside_it_with_the_columns_as_they_were(samples, capsys):
    assert main(["pareto", samples.name, "--objectives", "Value,Energy"]) == 0
    text = samples.with_name("branin_output_pareto.csv").read_text()
    assert text == "\n".join((*LINES[:3], ""))
    assert capsys.readouterr().out == text


def test_front_goes_where_one_says(samples, capsys):
    assert main(["pareto", samples.name, "--scenario", "s.json", "-o", "front.csv"]) == 0
    assert (samples.parent / "front.csv").exists()
    assert not samples.with_name("branin_output_pareto.csv").exists()


def test_infeasible_row_counts_for_nothing_and_directions_are_the_users(samples):
    run = load_run(SamplesFile(path=samples, scenario={"objectives": [{"name": "Value", "goal": "maximize"}]}))
    assert run.states == ["completed", "completed", "infeasible", "completed"]
    assert run.is_front.tolist() == [False, False, False, True]


def test_feasibility_goes_by_the_scenarios_own_column(samples):
    text = {"name": "Valid", "true_value": "False", "false_value": "True"}
    run = load_run(SamplesFile(path=samples, scenario={**MEANING, "feasible_output": text}))
    assert run.states == ["infeasible", "infeasible", "completed", "infeasible"]


def test_design_is_as_long_as_the_scenario_says(samples):
    assert load_run(SamplesFile(path=samples, scenario=SCENARIO)).n_design == 1
    assert load_run(SamplesFile(path=samples, scenario=MEANING)).n_design == 0


def test_two_files_of_one_folder_are_told_apart(samples):
    other = samples.with_name("other.csv")
    other.write_bytes(samples.read_bytes())
    runs = load_runs([SamplesFile(path=path, scenario=MEANING) for path in (samples, other)])
    assert [run.label for run in runs] == ["branin_output_samples", "other"]


def test_folder_of_csv_files_is_one_label(samples, capsys):
    folder = samples.parent / "forest"
    folder.mkdir()
    for name in ("a.csv", "b.csv", "a_pareto.csv"):
        (folder / name).write_bytes(samples.read_bytes())
    assert main(["plot", "hypervolume_gap", "forest", "--objectives", "Value,Energy", "-o", "p.png", "--csv"]) == 0
    with (samples.parent / "p_data.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {(row["label"], row["run"]) for row in rows} == {("forest", "forest/a.csv"), ("forest", "forest/b.csv")}


@pytest.mark.parametrize("kind", ["pareto", "hypervolume", "objectives", "attainment", "parameters", "hypervolume_gap"])
def test_kinds_draw_samples_files(samples, kind):
    assert main(["plot", kind, samples.name, "--scenario", "s.json", "-o", "p.png"]) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["pareto", "branin_output_samples.csv"], "branin_output_samples.csv: no scenario.json is beside it"),
        (["plot", "pareto", "branin_output_samples.csv", "--objectives", "Value,Cost"], "no column 'Cost'; found"),
        (["plot", "parameters", "branin_output_samples.csv", "--objectives", "Value"], "give the scenario with --sce"),
        (["plot", "prior", "branin_output_samples.csv", "--objectives", "Value"], "draws the prior of a run folder"),
        (["pareto", "branin_output_samples.csv", "--objectives", "Value:max"], "expected names, as in cost,speed:max"),
        (["plot", "pareto", "empty", "--objectives", "Value,Energy"], "nor a folder with CSV files"),
    ],
)
def test_what_is_missing_is_said(samples, capsys, arguments, message):
    (samples.parent / "empty").mkdir()
    assert main(arguments) == 2
    assert message in capsys.readouterr().err


def test_objective_that_is_a_word_is_an_error_that_says_where(samples):
    samples.write_text("Value,Energy\n1,2\nlow,2\n")
    with pytest.raises(RunFolderError, match="Value is not a number: 'low'"):
        load_run(SamplesFile(path=samples, scenario=MEANING))
