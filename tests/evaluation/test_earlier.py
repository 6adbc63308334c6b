"""Tests for earlier.py, and for runs that begin with the evaluations of another."""

import csv
import json
import re

import pytest

from hypermap_lite import Optimizer, optimize
from hypermap_lite.assembly import build_optimizer, build_space
from hypermap_lite.cli import main
from hypermap_lite.errors import RunFolderError, ScenarioError
from hypermap_lite.evaluation.earlier import earlier_evaluations, rows_of
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.evaluation.runner import StopReason
from hypermap_lite.scenario import load_scenario
from hypermap_lite.scenario.feasibility_column import FeasibilityColumn
from hypermap_lite.scenario.table import Table

SCENARIO = {
    "application_name": "demo",
    "input_parameters": {
        "x": {"parameter_type": "real", "values": [-5, 10]},
        "n": {"parameter_type": "integer", "values": [0, 15]},
        "o": {"parameter_type": "ordinal", "values": [0.5, 1, 2]},
        "c": {"parameter_type": "categorical", "values": ["false", "true"]},
    },
    "objectives": [{"name": "f"}],
    "budget": {"evaluations": 8},
    "design_of_experiment": {"number_of_samples": 4, "type": "random_sampling"},
    "optimizer": "random_search",
}
SPACE = build_space(load_scenario(SCENARIO))
OBJECTIVES = load_scenario(SCENARIO).objectives
HEADER = "f,c,Valid,n,Timestamp,x,o,ALMs"
ROWS = ("3.5,true,True,1.0,12.0,-5.0,2.0,9", "2,false,False,15,340.6,10,0.5,8", "1e2,true,True,0,1e3,0.1,1,7")


def write(path, *lines):
    path.write_bytes("\r\n".join((*lines, "")).encode())
    return path


def read(tmp_path, *lines, **changes):
    file = write(tmp_path / "samples.csv", *lines)
    return earlier_evaluations(load_scenario({**SCENARIO, "earlier_evaluations": str(file), **changes}), SPACE)


def black_box(configuration):
    return configuration["x"] ** 2 + configuration["n"]


def rows(path):
    with (path / "history.csv").open(newline="") as file:
        return [(row["trial"], row["phase"], row["x"], row["n"]) for row in csv.DictReader(file)]


def test_hypermappers_own_file_is_read_by_its_header(tmp_path):
    first, second, third = read(tmp_path, HEADER, *ROWS)
    assert first.configuration == {"x": -5.0, "n": 1, "o": 2, "c": "true"}
    assert type(first.configuration["n"]) is int
    assert (first.state, second.state, third.state) == (State.COMPLETED, State.INFEASIBLE, State.COMPLETED)
    assert [e.timestamp for e in (first, second, third)] == [12, 341, 1000]
    assert third.values == {"f": 100.0}
    assert [(e.trial, e.suggestion.phase) for e in (first, second, third)] == [(t, "earlier") for t in range(3)]


def test_dates_as_timestamps_count_from_the_first(tmp_path):
    lines = ["x,n,o,c,f,Timestamp", "1,1,1,true,2,1671000000000", "2,1,1,true,2,1671000002500.0"]
    assert [e.timestamp for e in read(tmp_path, *lines)] == [0, 2500]


def test_failed_rows_of_a_history_are_left_out_and_infeasible_ones_are_not(tmp_path):
    lines = ["x,n,o,c,f,state", "1,1,1,true,2,completed", "2,1,1,true,,failed", "2,1,1,true,,infeasible"]
    assert [e.state for e in read(tmp_path, *lines)] == [State.COMPLETED, State.INFEASIBLE]


def test_repeated_configurations_are_kept(tmp_path):
    assert len(read(tmp_path, "x,n,o,c,f", "1,1,1,true,2", "1,1,1,true,2.5")) == 2


def test_feasibility_goes_by_the_scenarios_own_texts():
    table = Table("t.csv", ("x", "n", "o", "c", "f", "ok"), (("1", "1", "1", "true", "2", "no"),), (2,))
    (row,) = rows_of(table, SPACE, OBJECTIVES, FeasibilityColumn(name="ok", yes=("yes",), no=("No",)))
    assert row.state is State.INFEASIBLE
    with pytest.raises(ScenarioError, match=r"record 2: 'ok' is 'no'\n  allowed: '1' or '0'"):
        rows_of(table, SPACE, OBJECTIVES, FeasibilityColumn(name="ok", yes=("1",), no=("0",)))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        pytest.param(
            ["x,n,f", "1,1,2"],
            "no column 'o', 'c'\n  allowed: a column per parameter and objective; its columns are x, n, f",
            id="columns",
        ),
        pytest.param(
            ["x,n,o,c,f", "1,1,1,true,2", "11,1,1,true,2", "12,16,1,true,2"],
            "2 of 3 rows of .* hold values that are not allowed ('x' 2, 'n' 1); "
            "the first: 'x' is '11' in record 3\n  allowed: for 'x': a number from -5 to 10",
            id="bounds",
        ),
        pytest.param(["x,n,o,c,f", "1,1.5,1,true,2"], "('n' 1); the first: 'n' is '1.5' in record 2", id="not whole"),
        pytest.param(["x,n,o,c,f", "1,1,3,true,2"], "'o' is '3' in record 2", id="level"),
        pytest.param(["x,n,o,c,f", "1,1,1,True,2"], "'c' is 'True' in record 2", id="category"),
        pytest.param(["x,n,o,c,f", "one,1,1,true,2"], "'x' is 'one' in record 2", id="no number"),
        pytest.param(
            ["x,n,o,c,f", "1,1,1,true,nan"], "record 2: 'f' is 'nan'\n  allowed: a finite number", id="objective"
        ),
        pytest.param(["x,n,o,c,f"], "has no usable row", id="no row"),
        pytest.param(["x,n,o,c,f,state", "1,1,1,true,,failed"], "has no usable row: 1 failed", id="all failed"),
        pytest.param(["x,n,o,c,f,Valid", "1,1,1,true,2,7"], "record 2: 'Valid' is '7'", id="feasibility"),
    ],
)
def test_what_cannot_be_taken_over_is_an_error_that_says_where(tmp_path, lines, message):
    with pytest.raises(ScenarioError) as caught:
        read(tmp_path, *lines)
    assert caught.value.path == "$.earlier_evaluations"
    pattern = re.escape(message).replace(re.escape(".*"), ".*")
    assert re.search(pattern, str(caught.value)), str(caught.value)


def test_missing_file_is_an_error_with_the_nearest_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "samples.csv", "x")
    scenario = load_scenario({**SCENARIO, "earlier_evaluations": "sample.csv"})
    with pytest.raises(ScenarioError, match=r"no file 'sample.csv'\n.*\n  hint: Did you mean 'samples.csv'"):
        earlier_evaluations(scenario, SPACE)


def test_rows_come_first_and_count_towards_design_and_budget(tmp_path):
    file = write(tmp_path / "samples.csv", HEADER, *ROWS)
    result = optimize({**SCENARIO, "earlier_evaluations": str(file)}, black_box, output_directory=tmp_path / "run")
    phases = [e.suggestion.phase for e in result.evaluations]
    assert phases == ["earlier"] * 3 + ["design"] + ["random"] * 4
    assert (len(result.evaluations), result.stop_reason) == (8, StopReason.BUDGET)
    assert min(e.timestamp for e in result.evaluations[3:]) >= 1000


def test_drawn_points_repeat_no_earlier_one(tmp_path):
    small = {
        "input_parameters": {"k": {"parameter_type": "integer", "values": [0, 5]}},
        "objectives": [{"name": "f"}],
        "design_of_experiment": {"number_of_samples": 6, "type": "sobol"},
    }
    file = write(tmp_path / "samples.csv", "k,f", "3,1", "0,2", "3,1")
    optimizer = Optimizer({**small, "earlier_evaluations": str(file)})
    assert sorted(s.configuration["k"] for s in optimizer.ask(3)) != [0, 3]
    assert not {s.configuration["k"] for s in optimizer.pending} & {0, 3}
    assert len(optimizer.pending) == 3


@pytest.mark.parametrize("kill_after", [0, 1, 4])
@pytest.mark.parametrize("batch", [1, 2])
def test_stopped_run_goes_on_without_the_file_as_one_that_was_not(tmp_path, batch, kill_after):
    calls = 0

    def killed(configuration):
        nonlocal calls
        calls += 1
        if calls > kill_after:
            raise KeyboardInterrupt
        return black_box(configuration)

    file = write(tmp_path / "samples.csv", HEADER, *ROWS)
    scenario = {**SCENARIO, "earlier_evaluations": str(file), "budget": {"evaluations": 9, "batch_size": batch}}
    optimize(scenario, black_box, output_directory=tmp_path / "whole")
    with pytest.raises(KeyboardInterrupt):
        optimize(scenario, killed, output_directory=tmp_path / "cut")
    write(file, HEADER, *ROWS, ROWS[0])  # it may change, or be gone: what counts is in the history
    scenario["earlier_evaluations"] = "gone.csv"
    optimize(scenario, black_box, output_directory=tmp_path / "cut")
    assert rows(tmp_path / "cut") == rows(tmp_path / "whole")


def test_run_that_began_without_them_takes_none_over(tmp_path):
    file = write(tmp_path / "samples.csv", HEADER, *ROWS)
    optimize(SCENARIO, black_box, output_directory=tmp_path / "run")
    with pytest.raises(RunFolderError, match=r"\$.earlier_evaluations: null there, .* now"):
        optimize({**SCENARIO, "earlier_evaluations": str(file)}, black_box, output_directory=tmp_path / "run")


def test_budget_that_they_use_up_is_warned_of(tmp_path, caplog):
    file = write(tmp_path / "samples.csv", HEADER, *ROWS, *ROWS)
    scenario = {**SCENARIO, "earlier_evaluations": str(file), "budget": {"evaluations": 6}}
    result = optimize(scenario, black_box, output_directory=tmp_path / "run")
    assert len(result.evaluations) == 6
    assert "budget.evaluations is 6 in all, and 6 earlier ones use it up" in caplog.text


def test_calls_that_others_made_are_not_missed(tmp_path, caplog):
    file = write(tmp_path / "samples.csv", HEADER, *ROWS)
    scenario = {**SCENARIO, "earlier_evaluations": str(file)}
    for _ in range(2):
        optimize(scenario, black_box, output_directory=tmp_path / "run")
    assert "are missing" not in caplog.text


def test_fresh_start_may_take_over_the_rows_of_the_run_it_sets_aside(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.py").write_text("def f(c):\n    return c['x']\n")
    evaluator = {"type": "python", "function": "box:f"}
    (tmp_path / "s.json").write_text(json.dumps({**SCENARIO, "evaluator": evaluator, "budget": {"evaluations": 4}}))
    assert main(["s.json", "--no-plot"]) == 0
    changes = ["--set", "earlier_evaluations=outputs/demo", "--set", "budget.evaluations=6"]
    assert main(["run", "s.json", "--no-plot", "--fresh", *changes]) == 0
    assert [phase for _, phase, *_ in rows(tmp_path / "outputs" / "demo")] == ["earlier"] * 4 + ["random"] * 2


def test_time_limit_is_that_of_the_run_not_of_the_earlier_experiment(tmp_path):
    file = write(tmp_path / "samples.csv", "x,n,o,c,f,Timestamp", "1,1,1,true,2,7200000")
    scenario = {**SCENARIO, "earlier_evaluations": str(file), "budget": {"evaluations": 5, "minutes": 30}}
    result = optimize(scenario, black_box, output_directory=tmp_path / "run")
    assert result.stop_reason is StopReason.BUDGET
    assert result.evaluations[-1].timestamp >= 7200000


@pytest.mark.parametrize("n_earlier", [2, 5, 9])
def test_prior_decays_as_if_all_had_been_one_run(tmp_path, n_earlier):
    prior = {"type": "gaussian", "mean": 0.3, "std": 0.1}
    scenario = {
        "input_parameters": {"x": {"parameter_type": "real", "values": [0, 1], "prior": prior}},
        "objectives": [{"name": "f"}],
        "design_of_experiment": {"number_of_samples": 4},
        "budget": {"evaluations": 30},
        "acquisition": {"prior_weighting": {"prior_free": 0, "safeguard": False}},
    }
    lines = [f"{0.05 + i / 20},{i}" for i in range(n_earlier)]
    file = write(tmp_path / "samples.csv", "x,f", *lines)
    scenario["earlier_evaluations"] = str(file)
    optimizer = build_optimizer(load_scenario(scenario))
    optimizer.history.extend(earlier_evaluations(load_scenario(scenario), optimizer.history.space))
    suggestion = optimizer.ask(max(4 - n_earlier, 0) + 1)[-1]
    beta, n = 0.1 * (30 - 4), 1 + max(n_earlier - 4, 0)
    assert suggestion.prior_weight == pytest.approx(beta / n)
