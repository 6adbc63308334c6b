"""Tests for run.py: `optimize`, from Python."""

import csv
import functools
import logging
import subprocess
import sys
from pathlib import Path

import pytest

import hypermap_lite
from hypermap_lite import optimize
from hypermap_lite.errors import RepeatedFailureError, RunFolderError, ScenarioError, UsageError
from hypermap_lite.evaluation.runner import StopReason
from hypermap_lite.history.lock import FolderLock
from hypermap_lite.run import name_of
from hypermap_lite.scenario import load_scenario
from tests.evaluation.black_boxes import sphere

SCENARIO = {
    "application_name": "demo",
    "input_parameters": {"x": {"parameter_type": "real", "values": [-2, 2]}},
    "objectives": [{"name": "f", "reference_point": 5}, {"name": "g", "goal": "maximize"}],
    "budget": {"evaluations": 6},
    "design_of_experiment": {"number_of_samples": 2},
    "optimizer": "random_search",
}
ONE = SCENARIO | {"objectives": [{"name": "f", "goal": "maximize"}]}


def two(configuration):
    return {"f": configuration["x"] ** 2, "g": configuration["x"]}


def test_result_holds_evaluations_front_and_hypervolume(tmp_path):
    result = optimize(SCENARIO, lambda c: two(c), output_directory=tmp_path)
    assert [e.trial for e in result.evaluations] == list(range(6))
    assert all(two(c) == values for c, values in result.pareto_front)
    assert result.best is None
    assert result.hypervolume > 0
    assert result.reference_point["f"] == 5
    assert (result.run_folder, result.stop_reason) == (tmp_path, StopReason.BUDGET)


def test_a_printed_result_says_in_a_few_lines_what_was_found(tmp_path):
    lines = str(optimize(SCENARIO | {"budget": {"evaluations": 40}}, two, output_directory=tmp_path)).splitlines()
    assert lines[0] == "40 evaluations: 40 completed; the run ended because the budget of evaluations is used up"
    front = int(lines[1].removeprefix("front of ").split(",")[0])
    assert front > 5
    assert len(lines) == 9
    assert lines[-2:] == [f"  and {front - 5} more", f"files in {tmp_path}"]


def test_a_printed_result_of_one_objective_names_the_best(tmp_path):
    result = optimize(ONE, lambda c: {"f": c["x"]}, output_directory=tmp_path)
    x = max(e.configuration["x"] for e in result.evaluations)
    assert f"\nbest: f={x:.6g} at x={x:.6g}" in str(result)


def test_the_history_as_a_data_frame_has_every_number_as_written(tmp_path):
    result = optimize(SCENARIO, two, output_directory=tmp_path)
    frame = result.to_frame()
    assert frame["trial"].tolist() == list(range(6))
    assert frame["x"].tolist() == [e.configuration["x"] for e in result.evaluations]
    assert frame["f"].tolist() == [e.values["f"] for e in result.evaluations]


def test_reference_point_that_nothing_beats_is_warned_of(tmp_path, caplog):
    objectives = [{"name": "f", "reference_point": 100}, {"name": "g", "goal": "maximize", "reference_point": 50}]
    result = optimize(SCENARIO | {"objectives": objectives}, two, output_directory=tmp_path)
    assert result.hypervolume == 0
    best = max(e.values["g"] for e in result.evaluations)
    assert (
        "the hypervolume is 0: no evaluation is better than the reference point in every objective; none alone in g, "
        f"whose best value is {best:g} and whose reference point is 50"
    ) in caplog.text
    assert "none alone in f" not in caplog.text
    caplog.clear()
    optimize(SCENARIO, two, output_directory=tmp_path / "beaten")
    assert "the hypervolume is 0" not in caplog.text


def test_retrying_failures_where_none_is_at_the_end_says_so(tmp_path, caplog):
    def now_and_then(configuration):
        calls.append(configuration)
        if len(calls) == 2:
            raise ValueError("no")
        return two(configuration)

    calls = []
    caplog.set_level(logging.INFO)
    optimize(SCENARIO, now_and_then, output_directory=tmp_path)
    assert "no failure is evaluated anew" not in caplog.text
    optimize(SCENARIO, now_and_then, output_directory=tmp_path, retry_failed=True)
    assert "no failure is evaluated anew: only those after the last usable result are, and there is none" in caplog.text
    assert len(calls) == 6


def test_values_beyond_the_square_root_of_floats_have_a_front_and_no_hypervolume(tmp_path):
    sides = SCENARIO | {"objectives": [{"name": "f"}, {"name": "g"}]}
    result = optimize(sides, lambda c: (c["x"] * 0.8e308, -c["x"] * 0.8e308), output_directory=tmp_path)
    assert len(result.pareto_front) == 6
    assert result.hypervolume is None


def test_another_function_for_the_same_folder_is_warned_of(tmp_path, caplog):
    def other(configuration):
        return two(configuration)

    optimize(SCENARIO, two, output_directory=tmp_path)
    optimize(SCENARIO, two, output_directory=tmp_path)
    assert "the function called" not in caplog.text
    optimize(SCENARIO, other, output_directory=tmp_path)
    assert "the function called was tests.test_run.two before and is tests.test_run.test_" in caplog.text


def test_callable_object_is_called_by_its_class():
    assert name_of(functools.partial(two)) == "functools.partial"
    assert name_of(two) == "tests.test_run.two"


def test_failures_at_the_end_are_tried_again_on_demand(tmp_path):
    def broken(configuration, trial):
        return two(configuration) if trial < 3 else {}

    def mended(configuration, trial):
        return two(configuration)

    before = optimize(SCENARIO, broken, output_directory=tmp_path)
    after = optimize(SCENARIO, mended, output_directory=tmp_path, retry_failed=True)
    assert [e.is_completed for e in before.evaluations] == [True] * 3 + [False] * 3
    assert [e.configuration for e in after.evaluations] == [e.configuration for e in before.evaluations]
    assert all(e.is_completed for e in after.evaluations)


def test_asynchronous_run_that_is_mended_is_one_that_never_failed(tmp_path):
    def broken(configuration, trial):
        return two(configuration) if trial < 3 else {}

    def mended(configuration, trial):
        return two(configuration)

    scenario = {key: value for key, value in SCENARIO.items() if key != "optimizer"}
    changes = ["budget.asynchronous=true", "design_of_experiment.number_of_samples=3"]
    whole = optimize(scenario, mended, output_directory=tmp_path / "whole", overrides=changes)
    before = optimize(scenario, broken, output_directory=tmp_path / "run", overrides=changes)
    after = optimize(scenario, mended, output_directory=tmp_path / "run", overrides=changes, retry_failed=True)
    assert [e.is_completed for e in before.evaluations] == [True] * 3 + [False] * 3
    assert before.evaluations[5].configuration != whole.evaluations[5].configuration
    assert [e.configuration for e in after.evaluations] == [e.configuration for e in whole.evaluations]


def test_best_of_one_objective_follows_its_direction(tmp_path):
    result = optimize(ONE, lambda c: c["x"], output_directory=tmp_path)
    configuration, values = result.best
    assert values["f"] == configuration["x"] == max(e.configuration["x"] for e in result.evaluations)
    assert (result.hypervolume, result.reference_point) == (None, None)


def test_second_call_goes_on_and_third_only_reads(tmp_path):
    calls = []

    def f(configuration):
        calls.append(configuration)
        return configuration["x"]

    optimize(ONE, f, output_directory=tmp_path, overrides=["budget.evaluations=4"])
    optimize(ONE, f, output_directory=tmp_path)
    result = optimize(ONE, f, output_directory=tmp_path)
    assert len(calls) == 6
    assert [e.configuration for e in result.evaluations] == calls


def test_importable_function_runs_in_workers_with_the_same_rows(tmp_path):
    def rows(folder):
        with (folder / "history.csv").open(newline="") as file:
            return [(row["x"], row["f"], row["g"]) for row in csv.DictReader(file)]

    optimize(SCENARIO, sphere, output_directory=tmp_path / "here")
    optimize(SCENARIO, sphere, output_directory=tmp_path / "there", workers=2)
    assert rows(tmp_path / "here") == rows(tmp_path / "there")


def test_asynchronous_workers_evaluate_the_whole_budget(tmp_path):
    options = {"workers": 2, "overrides": ["budget.asynchronous=true"], "output_directory": tmp_path}
    scenario = {key: value for key, value in SCENARIO.items() if key != "optimizer"}
    result = optimize(scenario, sphere, **options)
    assert [e.trial for e in result.evaluations] == list(range(len(result.evaluations)))
    assert len(result.evaluations) == 6
    again = optimize(scenario, sphere, **options)
    assert [(e.configuration, e.values) for e in again.evaluations] == [
        (e.configuration, e.values) for e in result.evaluations
    ]


@pytest.mark.parametrize("options", [{"workers": 2}, {"overrides": ["evaluator.timeout_seconds=9"]}])
def test_local_function_in_workers_is_refused_before_anything_is_written(tmp_path, options):
    with pytest.raises(UsageError, match="cannot be sent to a worker process"):
        optimize(SCENARIO, lambda c: two(c), output_directory=tmp_path / "run", **options)
    assert not (tmp_path / "run").exists()


def test_scenario_without_an_evaluator_needs_a_function(tmp_path):
    with pytest.raises(ScenarioError, match="names no evaluator"):
        optimize(SCENARIO, output_directory=tmp_path)


def test_interrupt_in_the_function_leaves_a_folder_to_go_on_with(tmp_path):
    def interrupt(configuration, trial):
        if trial == 3:
            raise KeyboardInterrupt
        return two(configuration)

    with pytest.raises(KeyboardInterrupt):
        optimize(SCENARIO, interrupt, output_directory=tmp_path)
    assert len(optimize(SCENARIO, lambda c: two(c), output_directory=tmp_path).evaluations) == 6


def test_folder_in_use_is_refused(tmp_path):
    with FolderLock(tmp_path), pytest.raises(RunFolderError, match="another process"):
        optimize(SCENARIO, two, output_directory=tmp_path)


def test_public_names_are_imported_when_used():
    code = (
        "import sys, hypermap_lite; print('numpy' in sys.modules); hypermap_lite.State; print('numpy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]


@pytest.mark.parametrize("name", [n for n in hypermap_lite.__all__ if not n.startswith("_")])
def test_every_public_name_exists(name):
    assert getattr(hypermap_lite, name).__name__ == name
    assert name in dir(hypermap_lite)


def test_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'optimise'"):
        hypermap_lite.optimise  # noqa: B018


def test_script_needs_no_main_guard(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "from hypermap_lite import optimize\n"
        "def f(configuration): return configuration['x']\n"
        f"print(len(optimize({ONE!r}, f, output_directory={str(tmp_path / 'run')!r}).evaluations))\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True, cwd=Path.cwd())
    assert done.stdout == "6\n"


def test_a_prior_of_a_single_point_is_said_in_the_run_log(tmp_path):
    priors = [{"type": "kde", "points": {"x": [0.5]}}]
    optimize(SCENARIO | {"priors": priors}, two, output_directory=tmp_path)
    assert "WARNING $.priors[0]: it rests on a single point" in (tmp_path / "run.log").read_text()


def test_the_front_of_another_run_can_be_the_prior(tmp_path):
    optimize(SCENARIO, two, output_directory=tmp_path / "first")
    result = optimize(SCENARIO, two, output_directory=tmp_path / "second", prior_from=tmp_path / "first")
    recorded = load_scenario(result.run_folder / "scenario.json")
    assert recorded.joint_priors[0].options["file"] == str(tmp_path / "first")
    assert recorded.design.type == "prior_sampling"


def test_a_range_as_prior_without_floor_keeps_all_trials_in_it(tmp_path):
    parameters = {
        "x": {"parameter_type": "real", "values": [-2, 2], "prior": {"type": "uniform", "low": 0.5, "high": 1}},
        "n": {"parameter_type": "integer", "values": [0, 9], "prior": {"type": "uniform", "low": 3, "high": 5}},
    }
    acquisition = {"prior_weighting": {"method": "pibo", "floor": 0, "prior_free": 0, "safeguard": False}}
    design = SCENARIO.get("design_of_experiment", {}) | {"type": "prior_sampling", "uniform_share": 0}
    scenario = SCENARIO | {
        "input_parameters": parameters,
        "optimizer": "bayesian",
        "acquisition": acquisition,
        "design_of_experiment": design,
    }
    result = optimize(scenario, two, output_directory=tmp_path)
    assert all(0.5 <= e.configuration["x"] <= 1 and 3 <= e.configuration["n"] <= 5 for e in result.evaluations)


def half_is_valid(configuration):
    x = configuration["x"]
    return {"f": x**2 if x < 1 else float("inf"), "g": x, "Valid": x < 0.3}


def test_a_run_with_infeasible_evaluations_writes_them_leaves_them_out_and_goes_on_as_if_it_had_not_stopped(tmp_path):
    scenario = SCENARIO | {
        "feasible_output": {"true_value": "yes", "false_value": "no"},
        "optimizer": "bayesian",
        "maximizer": {"type": "local_search", "candidates": 32, "starts": 1},
        "acquisition": {"samples": 8},
        "budget": {"evaluations": 9, "batch_size": 2},
        "design_of_experiment": {"type": "random_sampling", "number_of_samples": 5},
    }
    result = optimize(scenario, half_is_valid, output_directory=tmp_path / "whole")
    frame = result.to_frame()
    assert frame.columns[:5].tolist() == ["x", "f", "g", "Valid", "Timestamp"]
    assert frame["Valid"].tolist() == ["yes" if x < 0.3 else "no" for x in frame["x"]]
    assert set(frame["Valid"]) == {"yes", "no"}
    assert frame["g"].tolist() == frame["x"].tolist()
    assert frame["f"].isna().tolist() == [x >= 1 for x in frame["x"]]
    assert max(configuration["x"] for configuration, _ in result.pareto_front) < 0.3
    for n in (6, 8):
        shorter = scenario | {"budget": {"evaluations": n, "batch_size": 2}}
        optimize(shorter, half_is_valid, output_directory=tmp_path / str(n))
        resumed = optimize(scenario, half_is_valid, output_directory=tmp_path / str(n))
        rows = [(e.configuration, e.state, e.values, e.suggestion.acquisition_value) for e in resumed.evaluations]
        assert rows == [
            (e.configuration, e.state, e.values, e.suggestion.acquisition_value) for e in result.evaluations
        ]


def test_an_answer_without_the_feasible_output_is_a_failure_with_its_reason(tmp_path):
    scenario = SCENARIO | {"feasible_output": {}}
    with pytest.raises(RepeatedFailureError, match="the result has no 'Valid'"):
        optimize(scenario, two, output_directory=tmp_path)
