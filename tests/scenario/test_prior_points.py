"""Tests for prior_points.py."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from hypermap_lite.cli import main
from hypermap_lite.errors import ScenarioError
from hypermap_lite.scenario import load_scenario
from tests.scenario.bad_scenarios import GOOD

HEADER = "x,n,size,mode,cost,gain,trial,state"
ROWS = (
    "-5,1,16,fast,3,1,0,completed",
    "0.5,2,32,safe,2,2,1,completed",
    "1,3,64,safe,1,1,2,completed",
    "2,4,64,safe,9,9,3,failed",
    "10,8,16,fast,4,1,4,completed",
)
"""Rows 1 and 2 are the front, 0 comes behind them, then 4."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(name: str = "a.csv", *, header: str = HEADER, rows: tuple[str, ...] = ROWS) -> Path:
    file = Path(name)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("\n".join([header, *rows]) + "\n")
    return file


def with_density(**options: Any) -> dict[str, Any]:
    return copy.deepcopy(GOOD) | {"priors": [{"type": "kde", "file": "a.csv", **options}]}


def points(**options: Any) -> dict[str, Any]:
    (prior,) = load_scenario(with_density(**options)).joint_priors
    return dict(prior.options["points"])


def test_points_have_the_types_of_their_parameters() -> None:
    write()
    found = points()
    assert found == {"x": [0.5, 1.0], "n": [2, 3], "size": [32, 64], "mode": ["safe", "safe"]}
    assert [type(column[0]) for column in found.values()] == [float, int, int, str]


@pytest.mark.parametrize(
    ("options", "x"),
    [
        pytest.param({}, [0.5, 1], id="front"),
        pytest.param({"rows": "all"}, [-5, 0.5, 1, 10], id="all"),
        pytest.param({"rows": "best", "quantile": 0.25}, [0.5, 1], id="a-front-is-taken-as-a-whole"),
        pytest.param({"rows": "best", "quantile": 0.5}, [0.5, 1], id="the-share-is-reached"),
        pytest.param({"rows": "best", "quantile": 0.51}, [-5, 0.5, 1], id="the-next-front"),
        pytest.param({"rows": "best", "quantile": 1}, [-5, 0.5, 1, 10], id="all-fronts"),
    ],
)
def test_rows_choose(options: dict[str, Any], x: list[float]) -> None:
    write()
    assert points(parameters=["x"], **options) == {"x": x}


@pytest.mark.parametrize(("goal", "x"), [("minimize", [1.0, 2.0, 0.0]), ("maximize", [8.0, 9.0, 7.0])])
def test_the_best_of_one_objective_are_a_quantile(goal: str, x: list[float]) -> None:
    write(header="x,cost", rows=tuple(f"{v},{v if v else 2}" for v in (5, 1, 2, 3, 0, 8, 9, 7, 6, 4)))
    document = with_density(parameters=["x"], rows="best", quantile=0.3) | {
        "objectives": [{"name": "cost", "goal": goal}]
    }
    (prior,) = load_scenario(document).joint_priors
    assert sorted(prior.options["points"]["x"]) == sorted(x)


@pytest.mark.parametrize("column", ["feasible", "Valid"])
def test_infeasible_rows_do_not_count(column: str) -> None:
    write(header=f"x,{column}", rows=("1,True", "2,False", "3,1", "4,0", "5,true"))
    assert points(parameters=["x"], rows="all") == {"x": [1, 3, 5]}


def test_a_column_that_is_the_scenarios_own_says_nothing_of_feasibility() -> None:
    write(header="Valid", rows=("0", "1"))
    document = with_density(rows="all", parameters=["Valid"])
    document["input_parameters"]["Valid"] = {"parameter_type": "real", "values": [0, 1]}
    (prior,) = load_scenario(document).joint_priors
    assert prior.options["points"] == {"Valid": [0, 1]}


CONFIRMED = ("x,n,cost,gain,trial,phase,state,replicates,cost_sem,gain_sem", "1,1,1,1", "2,1,3,1", "1,1,9,1", "3,1,4,1")
"""Of rows 0 and 2 the first is lucky; their mean, 5, is worse than all others."""


def confirmed(phase: str = "confirm", state: str = "completed") -> dict[str, Any]:
    phases, states = ["design", "design", phase, "model"], ["completed", "completed", state, "completed"]
    header, *rows = CONFIRMED
    ends = (f"{i},{p},{s},1,," for i, (p, s) in enumerate(zip(phases, states, strict=True)))
    write(header=header, rows=tuple(f"{row},{end}" for row, end in zip(rows, ends, strict=True)))
    return {"file": "a.csv", "parameters": ["x"]}


def test_lucky_row_that_was_confirmed_counts_by_the_mean() -> None:
    assert points(**confirmed(), rows="best", quantile=0.5) == {"x": [2, 3]}
    assert points(**confirmed()) == {"x": [2]}
    assert points(**confirmed("earlier")) == {"x": [1]}


def test_configuration_that_was_confirmed_is_one_point() -> None:
    assert points(**confirmed(), rows="all") == {"x": [1, 2, 3]}
    assert points(**confirmed("earlier"), rows="all") == {"x": [1, 2, 1, 3]}


def test_configuration_whose_confirmation_failed_is_no_point() -> None:
    assert points(**confirmed(state="failed"), rows="all") == {"x": [2, 3]}


def test_larger_samples_count_more_in_the_mean() -> None:
    header, *_ = CONFIRMED
    # The mean of ten replicates at 1 and one at 12 is 2, that of the other configuration 2.5.
    rows = (
        "1,1,1,1,0,design,completed,10,0.1,0",
        "2,1,2.5,1,1,design,completed,1,,",
        "1,1,12,1,2,confirm,completed,1,,",
    )
    write(header=header, rows=rows)
    assert points(parameters=["x"]) == {"x": [1]}


def test_rows_without_objective_values_do_not_count() -> None:
    write(header="x,cost,gain", rows=("1,,", "2,3,4", "3,nan,5", "4,inf,9"))
    assert points(parameters=["x"]) == {"x": [2]}


def test_weights_come_from_a_column_and_rows_of_weight_zero_are_left_out() -> None:
    write(header="x,w", rows=("1,2", "2,0", "3,0.5"))
    (prior,) = load_scenario(with_density(parameters=["x"], rows="all", weights="w")).joint_priors
    assert (prior.options["points"], prior.options["point_weights"]) == ({"x": [1, 3]}, [2, 0.5])


def test_rounding_beyond_a_bound_is_forgiven() -> None:
    write(header="x,n", rows=("-5.000000001,1.0000000001", "10.000000001,8"))
    found = points(parameters=["x", "n"], rows="all")
    assert found == {"x": [-5, 10], "n": [1, 8]}


def test_parameters_of_other_priors_are_left_out() -> None:
    write()
    document = with_density(rows="all")
    document["input_parameters"]["x"]["prior"] = {"type": "gaussian", "mean": 0, "std": 1}
    document["input_parameters"]["mode"]["prior"] = "uniform"
    mixture = {"type": "mixture", "components": [{"mean": {"n": 2}, "std": {"n": 1}}]}
    document["priors"].append(mixture)
    density, _ = load_scenario(document).joint_priors
    assert list(density.options["points"]) == ["size", "mode"]


def test_of_two_densities_the_second_has_nothing_left() -> None:
    write()
    document = with_density()
    document["priors"] *= 2
    with pytest.raises(ScenarioError, match=r"\$\.priors\[1\]\.parameters: every parameter has a prior already"):
        load_scenario(document)


def test_the_file_is_looked_for_beside_the_file_that_says_it_then_beside_the_scenario_then_here(folder: Path) -> None:
    base = folder / "base" / "base.json"
    base.parent.mkdir()
    base.write_text(json.dumps(with_density(parameters=["x"], rows="all")))
    scenario = folder / "top" / "s.json"
    scenario.parent.mkdir()
    scenario.write_text('{"extends": "../base/base.json"}')
    for place, x in ((".", 1), ("top", 2), ("base", 3)):
        write(f"{place}/a.csv", header="x", rows=(str(x),))
        (prior,) = load_scenario(scenario).joint_priors
        assert prior.options["points"] == {"x": [x]}


def test_a_run_folder_stands_for_its_front_or_its_history() -> None:
    write("run/history.csv")
    assert points(file="run", parameters=["x"]) == {"x": [0.5, 1]}
    write("run/pareto.csv", rows=ROWS[1:2])
    assert points(file="run", parameters=["x"]) == {"x": [0.5]}
    assert points(file="run", parameters=["x"], rows="all") == {"x": [-5, 0.5, 1, 10]}


def test_the_canonical_scenario_does_not_need_the_file() -> None:
    file = write()
    scenario = load_scenario(with_density(rows="all", weights="trial"))
    file.unlink()
    again = load_scenario(json.loads(json.dumps(scenario.canonical)))
    assert again == scenario
    assert again.joint_priors[0].options["points"]["x"] == [0.5, 1, 10]


@pytest.mark.parametrize(
    ("options", "header", "rows", "says"),
    [
        pytest.param(
            {"file": "b.csv"}, HEADER, ROWS, (".file", "no file 'b.csv'", "relative to", "'a.csv'"), id="missing-file"
        ),
        pytest.param({}, 'x,"n', (), (".file", "a.csv is not a table"), id="no-csv"),
        pytest.param({}, "x;n", ("1;2",), (".file", "no column 'x', 'n', 'size', 'mode'", "x;n"), id="semicolons"),
        pytest.param(
            {},
            "x,n,sice,mode,cost,gain",
            ("1,2,16,safe,1,1",),
            (".file", "no column 'size'", "its columns: x, n, sice", "'sice'"),
            id="missing-column",
        ),
        pytest.param(
            {}, "x,n,size,mode,cost", (), (".file", "no rows below its header", "at least one usable"), id="no-rows"
        ),
        pytest.param(
            {},
            "x,n,size,mode,cost,gian",
            ("1,2,16,safe,1,1",),
            (".file", "the objective 'gain'", "'gian'", '"rows": "all"'),
            id="missing-objective",
        ),
        pytest.param(
            {},
            "x,n,size,mode,cost,gain,state,Valid",
            ("1,2,16,safe,1,1,failed,1", "1,2,16,safe,1,1,completed,0", "1,2,16,safe,,1,completed,1"),
            (".file", "none of the 3 rows", "1 not completed, 1 infeasible, 1 without objective values"),
            id="no-usable-row",
        ),
        pytest.param(
            {"weights": "wieght", "rows": "all"},
            HEADER + ",weight",
            ("1,2,16,safe,1,1,0,completed,1",),
            (".weights", "no column 'wieght'", "'weight'"),
            id="missing-weights",
        ),
        pytest.param(
            {"weights": "cost", "rows": "all"},
            HEADER,
            ("1,2,16,safe,1,1,0,completed", "1,2,16,safe,-1,1,1,completed"),
            (".weights", "record 3: 'cost' is -1", ">= 0"),
            id="negative-weight",
        ),
        pytest.param(
            {"weights": "mode", "rows": "all"},
            HEADER,
            ROWS,
            (".weights", "record 2: 'mode' is 'fast'", ">= 0"),
            id="weights-in-words",
        ),
        pytest.param(
            {"weights": "trial"},
            HEADER,
            ("1,2,16,safe,1,1,0,completed",),
            (".weights", "the weights of all 1 rows", "> 0"),
            id="weights-all-zero",
        ),
        pytest.param(
            {"rows": "all", "parameters": ["x"]},
            "x",
            ("1", "11", "-6", "2"),
            (".file", "2 of 4 rows of a.csv lie outside the bounds: 'x' 2", "-5 to 10"),
            id="outside-the-bounds",
        ),
        pytest.param(
            {"rows": "all"},
            "x,n,size,mode",
            ("1,2,17,slow", "11,2.5,16,safe", "1,2,16,safe", "1,2,16,slow"),
            (".file", "3 of 4 rows of a.csv hold values", "'x' 1, 'n' 1, 'size' 1, 'mode' 2", "-5 to 10"),
            id="no-legal-levels",
        ),
        pytest.param(
            {"rows": "all", "parameters": ["x"]},
            "x",
            ("1", "", "2", "abc"),
            (".file", "record 5: 'x' is 'abc'", "a finite number"),
            id="not-a-number",
        ),
        pytest.param(
            {"rows": "all", "parameters": ["x", "n"]},
            "x,n",
            ("1,2", ",3"),
            (".file", "record 3: 'x' is ''", "a finite number"),
            id="empty-cell",
        ),
        pytest.param(
            {"parameters": ["x"]},
            "x,cost,gain",
            ("1,2,3", "1,much,3"),
            (".file", "record 3: 'cost' is 'much'", "a finite number"),
            id="objective-in-words",
        ),
    ],
)
def test_a_mistake_is_one_short_message_and_exit_status_2(
    options: dict[str, Any],
    header: str,
    rows: tuple[str, ...],
    says: tuple[str, ...],
    folder: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    write(header=header, rows=rows)
    (folder / "bad.json").write_text(json.dumps(with_density(**options)))
    assert main(["check", "bad.json"]) == 2
    message = capsys.readouterr().err
    assert [part for part in ("bad.json: $.priors[0]", *says) if part not in message] == [], message
    assert len(message.splitlines()) <= 4
    assert "Traceback" not in message


def test_a_row_whose_feasible_output_says_no_does_not_count() -> None:
    write(header="x,n,size,mode,cost,gain,fits", rows=("0,2,32,safe,0,9,N", "1,3,64,safe,1,1,Y", "2,3,64,safe,1,1,n"))
    output = {"name": "fits", "true_value": "Y", "false_value": "N"}
    (prior,) = load_scenario(with_density() | {"feasible_output": output}).joint_priors
    assert prior.options["points"]["x"] == [1.0]
