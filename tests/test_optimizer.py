"""Tests for optimizer.py: HyperMapper's entry from Python."""

import logging
import sys

from hypermap_lite import optimizer
from hypermap_lite.evaluation.runner import StopReason

ONE = {
    "input_parameters": {"x": {"parameter_type": "real", "values": [-2, 2], "parameter_default": 0}},
    "objectives": [{"name": "f"}],
    "budget": {"evaluations": 6, "batch_size": 2},
    "design_of_experiment": {"number_of_samples": 3},
    "optimizer": "random_search",
}


def at(folder, **sections):
    return ONE | {"output": {"directory": str(folder)}} | sections


def test_function_may_return_a_number_or_a_mapping(tmp_path):
    number = optimizer.optimize(at(tmp_path / "a"), lambda x: x["x"] ** 2)
    mapping = optimizer.optimize(at(tmp_path / "b"), lambda x: {"f": x["x"] ** 2})
    assert number.best == mapping.best == ({"x": 0.0}, {"f": 0.0})
    assert number.stop_reason is StopReason.BUDGET


def test_every_call_is_a_run_of_its_own(tmp_path):
    calls = []

    def f(x):
        calls.append(x)
        return x["x"]

    for _ in range(2):
        optimizer.optimize(at(tmp_path / "run"), f)
    assert len(calls) == 12
    assert (tmp_path / "run.bak-1" / "history.csv").exists()


def rows_of(path):
    return [line.rsplit(",", 1)[0] for line in path.read_text().splitlines()[1:]]  # without the time


def test_resuming_begins_with_the_rows_there_are_now(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    document = {
        "application_name": "demo",
        "optimization_objectives": ["f"],
        "input_parameters": {"x": {"parameter_type": "real", "values": [-2, 2]}},
        "design_of_experiment": {"number_of_samples": 2},
        "optimization_iterations": 1,
    }
    samples = tmp_path / "demo_output_samples.csv"
    for shift in (0.0, 100.0):  # the second time, the first run's rows are others, but as many
        optimizer.optimize(document, lambda x, shift=shift: x["x"] + shift)
        first = rows_of(samples)
        optimizer.optimize(document | {"resume_optimization": True}, lambda x, shift=shift: x["x"] + shift)
        assert rows_of(samples)[: len(first)] == first
        assert len(rows_of(samples)) == len(first) + 1


def test_going_on_says_nothing_of_the_function_that_is_the_same(tmp_path, caplog):
    (tmp_path / "rows.csv").write_text("x,f\n1,1\n")
    for _ in range(2):
        optimizer.optimize(at(tmp_path / "run", earlier_evaluations=str(tmp_path / "rows.csv")), black_box)
    assert not (tmp_path / "run.bak-1").exists()
    assert "the function called was" not in caplog.text


def black_box(configuration):
    return configuration["x"] ** 2


def test_batch_function_gets_lists(tmp_path):
    calls = []

    def f(columns):
        calls.append(columns["x"])
        return [x**2 for x in columns["x"]]

    result = optimizer.optimize(at(tmp_path, evaluator={"batch": True}), f)
    assert [len(xs) for xs in calls] == [2, 2, 2]
    assert [e.values["f"] for e in result.evaluations] == [x**2 for xs in calls for x in xs]


def test_stdout_stays_what_it_is(tmp_path, capsys):
    before = sys.stdout
    optimizer.optimize(at(tmp_path), lambda x: print("from the function") or x["x"])
    assert sys.stdout is before
    assert capsys.readouterr().out == "from the function\n" * 6


def test_function_is_not_called_where_a_table_answers(tmp_path, caplog):
    (tmp_path / "t.csv").write_text("n,f\n" + "".join(f"{n},{n}\n" for n in range(8)))
    parameters = {"n": {"parameter_type": "integer", "values": [0, 7]}}
    evaluator = {"type": "exhaustive", "file": str(tmp_path / "t.csv")}
    with caplog.at_level(logging.WARNING):
        result = optimizer.optimize(
            at(tmp_path / "run", input_parameters=parameters, evaluator=evaluator), lambda n: 1 / 0
        )
    assert all(e.values["f"] == e.configuration["n"] for e in result.evaluations)
    assert "the function is not called" in caplog.text
