"""Faults of HyperMapper in the ways configurations are evaluated, each with a test that it would fail."""

from __future__ import annotations

import json
import math
import sys
import time

import pytest

from hypermap_lite import optimize, optimizer
from hypermap_lite.cli import main
from hypermap_lite.errors import HypermapLiteError
from hypermap_lite.evaluation.outcome import State
from hypermap_lite.evaluation.runner import StopReason
from tests.cli.clients import converse, history, table, write_scenario

SCENARIO = {
    "input_parameters": {
        "x": {"parameter_type": "real", "values": [-2, 2]},
        "n": {"parameter_type": "integer", "values": [0, 9]},
    },
    "objectives": [{"name": "f"}],
    "budget": {"evaluations": 8, "batch_size": 2},
    "design_of_experiment": {"number_of_samples": 4},
}


def at(folder, **sections):
    return SCENARIO | {"output": {"directory": str(folder)}} | sections


def far_from_zero(x, n):
    """Values for which pseudo-observations in [0, 1] would stand out."""
    return 100 + x**2 + n


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_value_that_is_not_finite_does_not_end_the_run(tmp_path, value):
    result = optimize(at(tmp_path), lambda c, trial: value if trial == 5 else far_from_zero(**c))
    assert [e.state for e in result.evaluations].count(State.COMPLETED) == 7
    assert result.evaluations[5].values == {}


def test_an_exception_does_not_end_the_run(tmp_path):
    result = optimize(at(tmp_path), lambda c, trial: 1 / 0 if trial == 5 else far_from_zero(**c))
    assert result.evaluations[5].error == "ZeroDivisionError: division by zero"
    assert len(result.evaluations) == 8


def test_a_value_that_is_not_finite_does_not_end_the_run_of_a_client(tmp_path):
    def reply(number, rows):
        texts = ["nan" if number == 1 and i == 0 else "1" for i in range(len(rows))]
        return table(
            [{**row, "f": text, "g": "2"} for row, text in zip(rows, texts, strict=True)], [*rows[0], "f", "g"]
        )

    said = converse(write_scenario(tmp_path), reply)
    assert said.status == 0
    assert [row["state"] for row in history(tmp_path / "run")].count("failed") == 1


def test_pseudo_observations_never_enter_the_data(tmp_path):
    def f(columns):
        return [far_from_zero(x, n) for x, n in zip(columns["x"], columns["n"], strict=True)]

    result = optimize(at(tmp_path, evaluator={"batch": True}, surrogate="random_forest"), f)
    assert [e.values["f"] for e in result.evaluations] == [far_from_zero(**e.configuration) for e in result.evaluations]
    assert result.best[1]["f"] >= 100
    assert [row["f"] for row in history(tmp_path)] == [repr(e.values["f"]) for e in result.evaluations]


def test_a_time_budget_that_ends_within_a_batch_leaves_no_pseudo_observation(tmp_path):
    def slow(columns):
        time.sleep(0.2)
        return [far_from_zero(x, n) for x, n in zip(columns["x"], columns["n"], strict=True)]

    scenario = at(tmp_path, evaluator={"batch": True}, budget={"evaluations": 50, "batch_size": 5, "minutes": 0.001})
    result = optimize(scenario, slow)
    assert result.stop_reason is StopReason.TIME
    assert len(result.evaluations) % 5 == 0
    assert min(e.values["f"] for e in result.evaluations) >= 100


def test_the_last_batch_of_one_is_a_list_too(tmp_path):
    sizes = []

    def f(columns):
        sizes.append([len(column) for column in columns.values()])
        return [1.0] * len(columns["x"])

    optimize(at(tmp_path, evaluator={"batch": True}, budget={"evaluations": 5, "batch_size": 2}), f)
    assert sizes == [[2, 2], [2, 2], [1, 1]]


def exhaustive(folder, rows, n_values=10):
    (folder / "t.csv").write_text("m,n,f\n" + rows)
    parameters = {
        "m": {"parameter_type": "ordinal", "values": [1, 2]},
        "n": {"parameter_type": "integer", "values": [0, n_values - 1]},
    }
    return at(
        folder / "run", input_parameters=parameters, evaluator={"type": "exhaustive", "file": str(folder / "t.csv")}
    )


def test_one_and_one_point_zero_are_the_same_configuration(tmp_path):
    rows = "".join(f"{m}.0,{n}.0,{m * n}\n" for m in (1, 2) for n in range(10))
    result = optimize(exhaustive(tmp_path, rows))
    assert [e.values["f"] for e in result.evaluations] == [
        e.configuration["m"] * e.configuration["n"] for e in result.evaluations
    ]


def test_a_configuration_missing_in_the_table_is_a_failure_and_a_table_of_gaps_no_success(tmp_path, capsys):
    (tmp_path / "some").mkdir()
    some = optimize(exhaustive(tmp_path / "some", "".join(f"{m},{n},1\n" for m in (1, 2) for n in range(8))))
    assert {e.state for e in some.evaluations} <= {State.COMPLETED, State.FAILED}
    (tmp_path / "none").mkdir()
    scenario = tmp_path / "none" / "s.json"
    scenario.write_text(json.dumps(exhaustive(tmp_path / "none", "1,77,1\n")))
    assert main([str(scenario), "-q", "--no-plot"]) == 4
    assert "t.csv has no row with m=" in capsys.readouterr().err


def test_times_are_since_the_start_of_the_run_in_every_mode(tmp_path):
    result = optimize(at(tmp_path), lambda c: far_from_zero(**c))
    times = [e.timestamp for e in result.evaluations]
    assert times == sorted(times)
    assert times[-1] < 10 * 60 * 1000


def test_stdout_is_the_same_after_a_run(tmp_path):
    before = sys.stdout
    optimizer.optimize(at(tmp_path), lambda c: far_from_zero(**c))
    assert sys.stdout is before


@pytest.mark.parametrize(
    "content",
    ["{", '{"objectives": [{"name": "f"}]}', '{"input_parameters": {}, "objectives": [], "no_such_key": 1}'],
    ids=["no JSON", "no parameters", "unknown key"],
)
def test_an_error_has_a_status_and_an_exception_that_says_so(tmp_path, content):
    (tmp_path / "s.json").write_text(content)
    assert main([str(tmp_path / "s.json")]) == 2
    with pytest.raises(HypermapLiteError):
        optimizer.optimize(tmp_path / "s.json", lambda c: 1.0)


def test_a_client_that_answers_wrongly_leaves_with_a_status_and_a_message(tmp_path):
    said = converse(write_scenario(tmp_path), lambda number, rows: "x,n\n1,2\n")
    assert said.status == 5
    assert "has no column 'o'" in said.stderr


def test_a_function_that_is_missing_is_an_error_with_a_status(tmp_path):
    (tmp_path / "s.json").write_text(json.dumps(at(tmp_path)))
    assert main([str(tmp_path / "s.json")]) == 2


def test_a_finite_space_that_is_used_up_is_a_good_end(tmp_path):
    said = converse(
        write_scenario(
            tmp_path,
            input_parameters={"n": {"parameter_type": "integer", "values": [0, 4]}},
            budget={"evaluations": 20, "batch_size": 2},
        ),
        lambda number, rows: table([{**row, "f": row["n"], "g": "1"} for row in rows], ["n", "f", "g"]),
    )
    assert (said.status, sum(map(len, said.requests))) == (0, 5)
    assert said.heard.endswith(b"End of HyperMapper\n")
