"""Tests for the reports at the end of a run."""

import json
import logging

import pytest

from hypermap_lite import optimize
from hypermap_lite.assembly import build_history
from hypermap_lite.cli import main
from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.reports import parameter_importance, posterior_front
from hypermap_lite.scenario import load_scenario

SCENARIO = {
    "application_name": "demo",
    "input_parameters": {
        "tool": {"parameter_type": "categorical", "values": ["peg", "pin", "nut"]},
        "strong": {"parameter_type": "real", "values": [0, 10]},
        "idle": {"parameter_type": "real", "values": [0, 1]},
    },
    "objectives": [{"name": "cost"}],
    "design_of_experiment": {"number_of_samples": 24, "type": "random_sampling"},
    "budget": {"evaluations": 24},
    "output": {"parameter_importance": True, "posterior_best": True},
}


def black_box(configuration):
    return configuration["strong"] + {"peg": 0, "pin": 1, "nut": 2}[configuration["tool"]]


def history_of(scenario, rows):
    """Return a history of (x, objectives) rows; infeasible where there are no objectives."""
    history = build_history(scenario)
    for trial, (x, values) in enumerate(rows):
        suggestion = Suggestion(trial=trial, configuration={"x": x}, phase="design")
        state = State.COMPLETED if values else State.INFEASIBLE
        history.append(Evaluation(suggestion=suggestion, state=state, values=values or {}))
    return history


def one_axis(*objectives, **changes):
    entries = {"x": {"parameter_type": "real", "values": [0, 1]}}
    return load_scenario({"input_parameters": entries, "objectives": list(objectives), **changes})


@pytest.mark.parametrize("surrogate", ["gaussian_process", "random_forest"])
def test_importance_belongs_to_the_right_parameter_with_either_surrogate(tmp_path, surrogate):
    result = optimize({**SCENARIO, "surrogate": surrogate}, black_box, output_directory=tmp_path)
    shares = result.parameter_importance.of("cost")
    assert sum(shares.values()) == pytest.approx(1)
    assert max(shares, key=shares.get) == "strong"
    assert shares["strong"] > 0.7
    assert shares["idle"] < 0.1


def test_reports_are_in_the_log_and_printed_once(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.py").write_text("def f(c):\n    return c['strong']\n")
    document = {**SCENARIO, "evaluator": {"type": "python", "function": "box:f"}, "output": SCENARIO["output"]}
    (tmp_path / "s.json").write_text(json.dumps(document))
    assert main(["s.json", "--no-plot"]) == 0
    shown, log = capsys.readouterr(), (tmp_path / "outputs/demo/run.log").read_text()
    for text in ("parameter importance (total Sobol indices, scaled)", "best by the surrogate's mean"):
        assert (shown.out + shown.err).count(text) == 1
        assert text in log


def test_finished_run_reports_later_without_another_evaluation(tmp_path):
    quiet = {**SCENARIO, "output": {}, "optimizer": "random_search"}
    optimize(quiet, black_box, output_directory=tmp_path)

    def forbidden(_):
        raise AssertionError

    result = optimize(quiet, forbidden, output_directory=tmp_path, overrides=["output.posterior_best=true"])
    assert result.posterior_best is not None
    assert result.parameter_importance is None


def test_importance_is_the_same_twice():
    scenario = one_axis({"name": "f"})
    history = history_of(scenario, [(0.1 * i, {"f": (0.1 * i - 0.4) ** 2}) for i in range(8)])
    first, second = (parameter_importance(scenario, history) for _ in range(2))
    assert str(first) == str(second)


def test_lucky_draw_is_not_the_best_of_the_posterior():
    scenario = one_axis({"name": "f", "goal": "maximize"})
    rows = [(0.5 + d, {"f": 10.0}) for d in (-0.02, -0.01, 0.01, 0.02)] + [(0.5, {"f": 9.9})]
    rows += [(x, {"f": y}) for x, y in ((0.0, 1.0), (0.01, 11.0), (0.02, 1.0), (0.03, 0.9), (0.9, 1.0), (0.015, 1.1))]
    (best,) = posterior_front(scenario, history_of(scenario, rows)).predictions
    assert abs(best.configuration["x"] - 0.5) < 0.03
    assert best.mean["f"] == pytest.approx(10, abs=1)
    assert best.std["f"] > 0


def test_several_objectives_have_all_that_are_not_dominated_by_their_means():
    scenario = one_axis({"name": "f"}, {"name": "g", "goal": "maximize"})
    history = history_of(scenario, [(i / 8, {"f": (i / 8 - 0.25) ** 2, "g": -((i / 8 - 0.75) ** 2)}) for i in range(9)])
    best = posterior_front(scenario, history)
    assert [p.configuration["x"] for p in best.predictions] == pytest.approx([0.25, 0.375, 0.5, 0.625, 0.75])


def test_infeasible_configurations_are_never_the_best():
    scenario = one_axis({"name": "f"})
    history = history_of(scenario, [(0.0, None), (0.5, {"f": 1.0}), (1.0, {"f": 2.0})])
    (best,) = posterior_front(scenario, history).predictions
    assert best.trial == 1


@pytest.mark.parametrize("report", [parameter_importance, posterior_front])
def test_too_few_evaluations_are_an_error_that_says_so(report):
    scenario = one_axis({"name": "f"})
    with pytest.raises(UsageError, match="1 completed evaluation; a model needs at least 2"):
        report(scenario, history_of(scenario, [(0.5, {"f": 1.0}), (0.1, None)]))


def test_run_with_too_few_evaluations_ends_well_all_the_same(tmp_path, caplog):
    changes = {"design_of_experiment": {"number_of_samples": 1}, "budget": {"evaluations": 1}}
    with caplog.at_level(logging.WARNING):
        result = optimize({**SCENARIO, **changes}, black_box, output_directory=tmp_path)
    assert (result.parameter_importance, result.posterior_best) == (None, None)
    assert "no posterior_best: 1 completed evaluation" in caplog.text
