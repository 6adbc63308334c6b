"""Tests for posterior_front.py and at_end.py."""

import csv
import json
import logging

import numpy as np
import pytest

from hypermap_lite import optimize
from hypermap_lite.assembly import build_history
from hypermap_lite.cli import main
from hypermap_lite.errors import UsageError
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.reports import at_end, posterior_front
from hypermap_lite.reports.posterior_front import MOST, is_worth_a_model
from hypermap_lite.run import run_scenario
from hypermap_lite.scenario import load_scenario

ONE_AXIS = {"x": {"parameter_type": "real", "values": [0, 1]}}
SCENARIO = {
    "application_name": "demo",
    "input_parameters": ONE_AXIS,
    "objectives": [{"name": "f", "goal": "maximize"}, {"name": "g"}],
    "design_of_experiment": {"number_of_samples": 8, "type": "sobol"},
    "optimizer": "random_search",
    "budget": {"evaluations": 12},
}


def noisy(configuration, seed):
    x, noise = configuration["x"], np.random.default_rng(seed).normal(0, 0.05, 2)
    return {"f": -((x - 0.3) ** 2) + noise[0], "g": (x - 0.7) ** 2 + noise[1]}


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def history_of(scenario, rows):
    """Return the history of (x, phase, values, replicates) rows; failed where there are no values."""
    history = build_history(scenario)
    for trial, (x, phase, values, replicates) in enumerate(rows):
        suggestion = Suggestion(trial=trial, configuration={"x": x}, phase=phase)
        state = State.COMPLETED if values else State.FAILED
        history.append(Evaluation(suggestion=suggestion, state=state, values=values or {}, replicates=replicates))
    return history


def line(*extra, **changes):
    """Return a scenario of f = x to be maximized and g = x, and the history of nine exact evaluations and some more."""
    scenario = load_scenario({**SCENARIO, **changes})
    rows = [(i / 8, "design", {"f": i / 8, "g": i / 8}, 1) for i in range(9)]
    return scenario, history_of(scenario, [*rows, *extra])


@pytest.mark.parametrize("optimizer", ["bayesian", "random_search", "evolutionary"])
@pytest.mark.parametrize("surrogate", ["gaussian_process", "random_forest"])
def test_run_writes_its_posterior_front_whatever_the_optimizer(tmp_path, optimizer, surrogate):
    result = optimize({**SCENARIO, "optimizer": optimizer, "surrogate": surrogate}, noisy, output_directory=tmp_path)
    rows = rows_of(tmp_path / "posterior_front.csv")
    assert list(rows[0]) == ["x", "f", "g", "trial", "replicates", "f_mean", "f_std", "g_mean", "g_std"]
    history = rows_of(tmp_path / "history.csv")
    for row, prediction in zip(rows, result.posterior_front.predictions, strict=True):
        assert row["x"] == history[int(row["trial"])]["x"]
        assert (row["f"], row["g"]) == tuple(history[int(row["trial"])][name] for name in ("f", "g"))
        assert float(row["f_mean"]) == prediction.mean["f"]
        assert float(row["g_std"]) == prediction.std["g"] > 0
    means = np.array([[-float(row["f_mean"]), float(row["g_mean"])] for row in rows])
    assert (np.diff(means[:, 0]) > 0).all()
    assert (np.diff(means[:, 1]) < 0).all()


def test_run_that_is_only_read_again_writes_the_same_file(tmp_path):
    optimize(SCENARIO, noisy, output_directory=tmp_path)
    first = (tmp_path / "posterior_front.csv").read_bytes()
    (tmp_path / "posterior_front.csv").unlink()
    optimize(SCENARIO, noisy, output_directory=tmp_path)
    assert (tmp_path / "posterior_front.csv").read_bytes() == first


def test_command_writes_the_file_of_the_run_again(tmp_path, capsys):
    optimize({**SCENARIO, "optimizer": "bayesian"}, noisy, output_directory=tmp_path)
    first = (tmp_path / "posterior_front.csv").read_text()
    (tmp_path / "posterior_front.csv").unlink()
    assert main(["pareto", str(tmp_path), "--posterior"]) == 0
    printed = capsys.readouterr()
    assert printed.out == first == (tmp_path / "posterior_front.csv").read_text()
    n = len(first.splitlines()) - 1
    assert f"{n} configurations on the posterior front, of 12 completed\n" in printed.err


def test_command_counts_a_confirmed_configuration_once(tmp_path, capsys):
    scenario = {**SCENARIO, "budget": {"evaluations": 12, "confirm_front": 4}}
    optimize({**scenario, "optimizer": "bayesian"}, noisy, output_directory=tmp_path)
    n_confirmed = sum(row["phase"] == "confirm" for row in rows_of(tmp_path / "history.csv"))
    assert main(["pareto", str(tmp_path), "--posterior"]) == 0
    assert n_confirmed > 0
    assert f"of {12 - n_confirmed} completed\n" in capsys.readouterr().err


@pytest.mark.parametrize("optimizer", ["bayesian", "random_search"])
def test_command_fits_an_asynchronous_run_in_the_order_in_which_it_learnt(tmp_path, capsys, optimizer):
    scenario = {**SCENARIO, "optimizer": optimizer, "budget": {"evaluations": 12, "asynchronous": True}}
    optimize(scenario, noisy, output_directory=tmp_path)
    in_order = (tmp_path / "posterior_front.csv").read_text()
    header, *calls = (tmp_path / "evaluations.csv").read_text().splitlines(keepends=True)
    (tmp_path / "evaluations.csv").write_text(header + "".join(calls[::-1]))  # as if the first had taken longest
    optimize(scenario, noisy, output_directory=tmp_path)
    by_run = (tmp_path / "posterior_front.csv").read_text()
    assert main(["pareto", str(tmp_path), "--posterior"]) == 0
    assert capsys.readouterr().out == by_run == (tmp_path / "posterior_front.csv").read_text()
    assert by_run != in_order


@pytest.mark.parametrize(
    ("more", "problem"),
    [
        pytest.param(["--objectives", "f"], "leave out --scenario and --objectives", id="samples file"),
        pytest.param(["--reference-point", "f=1"], "has no part in --posterior", id="reference point"),
        pytest.param([], "there is no scenario.json in it", id="no run folder"),
    ],
)
def test_command_says_what_it_needs(tmp_path, capsys, more, problem):
    assert main(["pareto", str(tmp_path), "--posterior", *more]) == 2
    assert problem in capsys.readouterr().err


def test_a_configuration_whose_evaluations_are_set_aside_is_not_on_the_posterior_front():
    """By what the others foretell it would be; but nobody has seen that."""

    def trials(*extra, failed=True, **changes):
        scenario = load_scenario({**SCENARIO, "objectives": [{"name": "f"}], **changes})
        rows = [(i / 15, "design", {"f": (i / 15 - 0.6) ** 2}, 1) for i in range(16)]
        rows[9] = (0.6, "design", {"f": 7.0 if failed else 0.0}, 1)
        front = posterior_front(scenario, history_of(scenario, [*rows, *extra]))
        return [(p.trial, p.observed["f"]) for p in front.predictions]

    assert trials(failed=False) == [(9, 0.0)]
    assert trials()[0][0] in (8, 10)
    assert trials((0.6, "confirm", {"f": 0.0}, 1)) == [(9, 3.5)]


def test_lucky_draw_is_on_the_observed_front_and_not_on_the_posterior_one():
    scenario = load_scenario(SCENARIO)
    values = {0.48: 10.0, 0.49: 10.0, 0.51: 10.0, 0.52: 10.0, 0.5: 9.9}
    values |= {0.0: 1.0, 0.01: 11.0, 0.015: 1.1, 0.02: 1.0, 0.03: 0.9, 0.9: 1.0}  # one draw of 11 where others are 1
    history = history_of(scenario, [(x, "design", {"f": f, "g": -f}, 1) for x, f in values.items()])
    for prediction in posterior_front(scenario, history).predictions:
        assert abs(prediction.configuration["x"] - 0.5) < 0.03
        assert prediction.mean["f"] == pytest.approx(10, abs=1)
        assert prediction.observed["f"] <= 10


def test_confirmed_configuration_is_there_once_with_all_its_replicates():
    scenario, history = line((1.0, "confirm", {"f": 0.7, "g": 1.3}, 2))
    first = posterior_front(scenario, history).predictions[0]
    assert (first.trial, first.replicates) == (8, 3)
    assert first.observed == pytest.approx({"f": (1 + 2 * 0.7) / 3, "g": (1 + 2 * 1.3) / 3})


def test_configuration_whose_confirmation_failed_is_left_out():
    scenario, history = line((1.0, "confirm", None, 1))
    assert max(p.configuration["x"] for p in posterior_front(scenario, history).predictions) == 0.875


def test_nothing_left_by_failed_confirmations_is_an_error():
    scenario = load_scenario(SCENARIO)
    rows = [
        (x, phase, values, 1)
        for phase, values in (("design", {"f": 1.0, "g": 1.0}), ("confirm", None))
        for x in (0.2, 0.4)
    ]
    with pytest.raises(UsageError, match="the confirmation of each one failed"):
        posterior_front(scenario, history_of(scenario, rows))


def test_names_that_are_taken_get_a_prefix(tmp_path):
    changes = {"input_parameters": {"f_mean": ONE_AXIS["x"]}, "objectives": [{"name": "f"}]}
    optimize({**SCENARIO, **changes}, lambda c: c["f_mean"], output_directory=tmp_path)
    (row,) = rows_of(tmp_path / "posterior_front.csv")
    assert list(row) == ["f_mean", "f", "trial", "replicates", "posterior.f_mean", "f_std"]


def test_too_few_evaluations_are_no_reason_to_worry(tmp_path, caplog):
    with caplog.at_level(logging.WARNING):
        result = optimize(
            SCENARIO,
            noisy,
            output_directory=tmp_path,
            overrides=["budget.evaluations=5", "design_of_experiment.number_of_samples=2"],
        )
    assert result.posterior_front is None
    assert not (tmp_path / "posterior_front.csv").exists()
    assert not caplog.records


def test_many_evaluations_without_a_model_are_left_without_one():
    scenario, history = line()
    assert is_worth_a_model(scenario, history)
    for trial in range(9, MOST + 1):
        suggestion = Suggestion(trial=trial, configuration={"x": trial / 1000}, phase="random")
        history.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"f": 0.0, "g": 0.0}))
    assert not is_worth_a_model(scenario, history)
    assert is_worth_a_model(load_scenario({**SCENARIO, "optimizer": "bayesian"}), history)


def test_model_that_fails_does_not_fail_the_run(tmp_path, monkeypatch, caplog):
    def broken(*_):
        raise FloatingPointError("no such luck")

    monkeypatch.setattr(at_end, "posterior_front", broken)
    result = optimize(SCENARIO, noisy, output_directory=tmp_path)
    assert (len(result.evaluations), result.posterior_front) == (12, None)
    assert "no posterior front: FloatingPointError: no such luck" in caplog.text


def test_file_that_cannot_be_written_does_not_fail_the_run(tmp_path, caplog):
    (tmp_path / "posterior_front.csv").mkdir()
    result = optimize(SCENARIO, noisy, output_directory=tmp_path)
    assert result.posterior_front is not None
    assert "posterior_front.csv" in caplog.text


def test_outdated_file_is_taken_away_when_the_run_goes_on(tmp_path):
    optimize(SCENARIO, noisy, output_directory=tmp_path)
    assert (tmp_path / "posterior_front.csv").exists()
    longer = load_scenario({**SCENARIO, "budget": {"evaluations": 14}, "output": {"directory": str(tmp_path)}})
    run_scenario(longer, noisy, should_stop=lambda: True)
    assert not (tmp_path / "posterior_front.csv").exists()


def test_command_line_lists_the_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "front_box.py").write_text("def f(c):\n    return c['x'], -c['x']\n")
    (tmp_path / "s.json").write_text(
        json.dumps({**SCENARIO, "evaluator": {"type": "python", "function": "front_box:f"}})
    )
    assert main(["s.json", "--no-plot"]) == 0
    assert "outputs/demo/posterior_front.csv" in capsys.readouterr().out.splitlines()
