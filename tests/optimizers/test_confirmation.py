"""Tests for confirmation.py, and of runs that confirm their front."""

import csv

import numpy as np
import pytest

from hypermap_lite import optimize
from hypermap_lite.assembly import build_history
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.evaluation.runner import StopReason
from hypermap_lite.optimizers import OPTIMIZERS
from hypermap_lite.optimizers.confirmation import Confirmation
from hypermap_lite.run import run_scenario
from hypermap_lite.scenario import load_scenario
from hypermap_lite.surrogates.base import Fantasies, Prediction
from tests.optimizers.runs import configurations, resumed, run, scenario_of

CONFIRMING = {"budget": {"evaluations": 12, "confirm_front": 4}}
TIMINGS = {"Timestamp", "suggest_seconds", "evaluate_seconds", "seconds"}


class Drawn:
    """A posterior that says what a test wants: draws of shape (S, b, m)."""

    def __init__(self, draws):
        self.draws = np.array(draws, dtype=float)

    def predict(self, X):
        mean = self.draws.mean(axis=0)
        return Prediction(mean=mean[: len(X)], std=np.zeros_like(mean[: len(X)]))

    def fantasies(self, X_pending, n, rng):
        return Fantasies(values=self.draws, field=None)


def confirmation_of(draws, replicates=None, **scenario):
    """Return a confirmation that knows these draws, and a history of one row per point."""
    loaded = load_scenario(scenario_of(**scenario))
    history = build_history(loaded)
    for trial in range(len(draws[0])):
        suggestion = Suggestion(trial=trial, configuration={"a": trial / 10, "b": 0.0}, phase="design")
        n = 1 if replicates is None else replicates[trial]
        values = {o.name: 0.0 for o in loaded.objectives}
        history.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values=values, replicates=n))
    confirmation = Confirmation(n=4, budget=12, seed=0, initial=(), posterior=lambda: (Drawn(draws), history.X()))
    return confirmation, history


def chosen(draws, in_flight=(), **options):
    confirmation, history = confirmation_of(draws, **options)
    return confirmation.suggestion(history, in_flight, len(history))


# To be minimized: two certain ends of a front, a middle that may or may not be on it, and one that is far from it.
UNCERTAIN = [
    [[0, 10], [10, 0], [9.8, 9.8], [20, 20]],
    [[0, 10], [10, 0], [2, 2], [21, 20]],
]


def test_configuration_of_uncertain_worth_is_repeated():
    suggestion = chosen(UNCERTAIN)
    assert suggestion.configuration == {"a": 0.2, "b": 0.0}
    assert suggestion.phase == "confirm"
    # The reference lies at 11, a tenth beyond the front of the means: shares of a box of 11 x 11.
    worths = [0.2 * 0.2 / 121, 8 * 8 / 121]
    assert suggestion.acquisition_value == pytest.approx(np.std(worths))


def test_large_uncertainty_of_what_is_dominated_anyway_does_not_matter():
    draws = np.array(UNCERTAIN)
    draws[1, 3] = 1000.0
    assert chosen(draws).configuration == {"a": 0.2, "b": 0.0}


def test_certain_objectives_are_repeated_in_turn():
    draws = [[[0, 10], [10, 0], [5, 5]]] * 2
    assert chosen(draws, replicates=[2, 1, 1]).configuration == {"a": 0.1, "b": 0.0}


def test_configuration_under_way_gives_way_to_the_next():
    draws = np.array(UNCERTAIN)
    draws[:, 3] = [[1, 9], [1, 8]]  # also on the front, and a little uncertain
    first = chosen(draws)
    second = chosen(draws, in_flight=[first] * 2000)
    assert first.configuration == {"a": 0.2, "b": 0.0}
    assert second.configuration != first.configuration


def test_best_of_one_objective_is_told_from_its_rivals():
    draws = [[[0.0], [1.0], [5.0]], [[2.0], [1.0], [5.0]]]
    assert chosen(draws, objectives=[{"name": "y"}]).configuration["a"] in (0.0, 0.1)


def test_stated_reference_point_bounds_the_worth():
    objectives = [{"name": "near", "reference_point": 3}, {"name": "far", "reference_point": 3}]
    draws = np.array([[[0, 2], [2, 0], [0, 100]], [[0, 2], [1, 0], [0, 50]]], dtype=float)
    assert chosen(draws, objectives=objectives).configuration == {"a": 0.1, "b": 0.0}


def test_reference_point_that_nothing_reaches_is_replaced():
    objectives = [{"name": "near", "reference_point": -1}, {"name": "far", "reference_point": -1}]
    assert chosen(UNCERTAIN, objectives=objectives).acquisition_value > 0


def test_one_completed_evaluation_leaves_nothing_to_confirm():
    assert chosen([[[0, 1]]]) is None


@pytest.mark.parametrize("optimizer", OPTIMIZERS)
@pytest.mark.parametrize("batch", [1, 3])
def test_last_evaluations_repeat_earlier_ones_with_any_optimizer(optimizer, batch):
    scenario = scenario_of(optimizer=optimizer, **CONFIRMING)
    done = run(scenario, 12, batch=batch)
    phases = [e.suggestion.phase for e in done.history]
    assert phases[8:] == ["confirm"] * 4
    assert "confirm" not in phases[:8]
    before = configurations(done)[:8]
    assert all(c in before for c in configurations(done)[8:])


def test_rows_before_are_those_of_a_run_that_ends_without():
    with_it = run(scenario_of(**CONFIRMING), 12)
    without = run(scenario_of(budget={"evaluations": 8}), 8)
    assert configurations(with_it)[:8] == configurations(without)


def test_design_is_never_cut_short():
    changes = {"design_of_experiment": {"number_of_samples": 10}, **CONFIRMING}
    phases = [e.suggestion.phase for e in run(scenario_of(**changes), 12).history]
    assert phases == ["design"] * 10 + ["confirm"] * 2


def test_run_goes_on_exploring_with_a_larger_budget():
    scenario = scenario_of(budget={"evaluations": 16, "confirm_front": 4})
    optimizer = resumed(scenario, list(run(scenario_of(**CONFIRMING), 12).history))
    (suggestion,) = optimizer.ask()
    assert suggestion.phase == "confirm"
    longer = resumed(scenario_of(budget={"evaluations": 20, "confirm_front": 4}), list(optimizer.history))
    (suggestion,) = longer.ask()
    assert suggestion.phase == "model"
    assert suggestion.configuration not in configurations(longer)


@pytest.mark.parametrize("at", range(8, 12))
def test_resumed_optimizer_confirms_as_the_uninterrupted_one(at):
    scenario = scenario_of(**CONFIRMING)
    whole = run(scenario, 12)
    (suggestion,) = resumed(scenario, list(whole.history)[:at]).ask()
    assert suggestion.configuration == whole.history[at].configuration
    assert suggestion.acquisition_value == whole.history[at].suggestion.acquisition_value


def test_small_space_is_explored_first_and_confirmed_then():
    parameters = {
        "a": {"parameter_type": "integer", "values": [0, 2]},
        "b": {"parameter_type": "ordinal", "values": [0, 1]},
    }
    scenario = scenario_of(input_parameters=parameters, budget={"evaluations": 20, "confirm_front": 3})
    phases = [e.suggestion.phase for e in run(scenario, 20, batch=2).history]
    assert (len(phases), phases[6:]) == (9, ["confirm"] * 3)


def integer(high):
    return {"a": {"parameter_type": "integer", "values": [0, high]}}


def along_a(configuration):
    return {"near": configuration["a"], "far": configuration["a"] ** 2}


@pytest.mark.parametrize("optimizer", OPTIMIZERS)
@pytest.mark.parametrize("batch", [1, 3])
def test_space_that_ends_before_the_budget_is_confirmed_no_more_than_asked_for(optimizer, batch):
    design = {"number_of_samples": 3}
    scenario = scenario_of(optimizer=optimizer, input_parameters=integer(4), design_of_experiment=design, **CONFIRMING)
    phases = [e.suggestion.phase for e in run(scenario, 12, batch=batch, function=along_a).history]
    assert (len(phases), phases[5:]) == (9, ["confirm"] * 4)


def test_finite_space_that_is_not_exhausted_is_confirmed_again_with_a_larger_budget():
    whole = run(scenario_of(input_parameters=integer(40), **CONFIRMING), 12, function=along_a)
    longer = scenario_of(input_parameters=integer(40), budget={"evaluations": 16, "confirm_front": 4})
    (suggestion,) = resumed(longer, list(whole.history)).ask()
    assert suggestion.phase == "confirm"


def test_noisy_members_are_told_from_lucky_ones():
    """Of 20 equal configurations, the luckiest loses its place after it was repeated."""
    rng = np.random.default_rng(0)
    scenario = scenario_of(
        objectives=[{"name": "y"}], optimizer="random_search", budget={"evaluations": 30, "confirm_front": 10}
    )
    done = run(scenario, 30, function=lambda c: {"y": float(rng.normal())})
    first = min(list(done.history)[:20], key=lambda e: e.values["y"])
    assert first.configuration in configurations(done)[20:]


def noisy(configuration, seed):
    rng = np.random.default_rng(seed)
    a, b = configuration["a"], configuration["b"] / 5
    return {"near": (a - 0.2) ** 2 + b * b + 0.1 * rng.normal(), "far": -((a - 0.8) ** 2) - (b - 0.5) ** 2}


def rows_of(path):
    with path.open(newline="") as file:
        return [{k: v for k, v in row.items() if k not in TIMINGS} for row in csv.DictReader(file)]


def files_of(folder):
    return [rows_of(folder / name) for name in ("history.csv", "evaluations.csv", "pareto.csv", "posterior_front.csv")]


@pytest.mark.parametrize("batch", [1, 3])
def test_run_that_was_stopped_anywhere_ends_with_the_same_files(tmp_path, batch):
    budget = {"evaluations": 10, "confirm_front": 4, "batch_size": batch}
    document = scenario_of(budget=budget, evaluator={"replicates": 2})
    optimize(document, noisy, output_directory=tmp_path / "whole")
    for n in (11, 13, 16, 19):
        scenario = load_scenario({**document, "output": {"directory": str(tmp_path / str(n))}})
        calls = iter(range(n))
        stopped = run_scenario(scenario, noisy, should_stop=lambda calls=calls: next(calls, None) is None)
        assert stopped.stop_reason is StopReason.INTERRUPTED
        run_scenario(scenario, noisy)
        assert files_of(tmp_path / str(n)) == files_of(tmp_path / "whole")


def begun_and_resumed(document, folder, budget):
    """Stop a run after the first of two calls of trial 7, and end it with another budget."""
    document = {**document, "evaluator": {"replicates": 2}, "output": {"directory": str(folder)}}
    calls = folder / "evaluations.csv"
    run_scenario(
        load_scenario(document), noisy, should_stop=lambda: calls.exists() and len(calls.read_text().split()) == 1 + 15
    )
    assert len(rows_of(calls)) == 15
    run_scenario(load_scenario({**document, "budget": budget}), noisy)
    return rows_of(folder / "history.csv")


def test_repetition_that_was_begun_is_one_with_a_larger_budget(tmp_path):
    document = scenario_of(budget={"evaluations": 10, "confirm_front": 3})
    rows = begun_and_resumed(document, tmp_path, {"evaluations": 14, "confirm_front": 3})
    assert [row["phase"] for row in rows] == ["design"] * 5 + ["model"] * 2 + ["confirm"] + ["model"] * 3 + [
        "confirm"
    ] * 3
    assert (rows[7]["acquisition_value"], rows[7]["prior_weight"]) == ("", "")
    for row in rows_of(tmp_path / "pareto.csv"):
        same = [other for other in rows if (other["a"], other["b"]) == (row["a"], row["b"])]
        assert int(row["replicates"]) == 2 * len(same)


@pytest.mark.parametrize("optimizer", ["bayesian", "random_search", "cma_es"])
def test_new_configuration_that_was_begun_is_no_repetition_with_a_smaller_budget(tmp_path, optimizer):
    document = scenario_of(optimizer=optimizer, budget={"evaluations": 14, "confirm_front": 3})
    rows = begun_and_resumed(document, tmp_path, {"evaluations": 10, "confirm_front": 3})
    assert rows[7]["phase"] == rows[6]["phase"] != "confirm"
    assert rows[7]["acquisition_value"] == ""
    assert [row["phase"] for row in rows[8:]] == ["confirm"] * 2


def test_repetition_has_seeds_of_its_own_and_the_front_the_mean_of_all(tmp_path):
    document = scenario_of(budget={"evaluations": 10, "confirm_front": 4}, evaluator={"replicates": 2})
    result = optimize(document, noisy, output_directory=tmp_path)
    calls = rows_of(tmp_path / "evaluations.csv")
    assert len({call["seed"] for call in calls}) == len(calls) == 20
    assert len(result.evaluations) == 10
    samples = {}
    for call in calls:
        samples.setdefault((call["a"], call["b"]), []).append(float(call["near"]))
    front = rows_of(tmp_path / "pareto.csv")
    assert any(row["replicates"] != "2" for row in front)
    for row in front:
        sample = samples[row["a"], row["b"]]
        assert int(row["replicates"]) == len(sample)
        assert float(row["near"]) == pytest.approx(np.mean(sample))
        assert float(row["near_sem"]) == pytest.approx(np.std(sample, ddof=1) / np.sqrt(len(sample)))
    assert [values["near"] for _, values in result.pareto_front] == [float(row["near"]) for row in front]


def test_a_second_run_confirms_the_front_of_an_asynchronous_one(tmp_path):
    def two(configuration):
        return {"near": configuration["a"] ** 2, "far": configuration["b"]}

    first = scenario_of(budget={"evaluations": 8, "asynchronous": True})
    optimize(first, two, output_directory=tmp_path / "first")
    second = scenario_of(budget={"evaluations": 11, "confirm_front": 3}, earlier_evaluations=str(tmp_path / "first"))
    result = optimize(second, two, output_directory=tmp_path / "second")
    phases = [e.suggestion.phase for e in result.evaluations]
    assert phases == ["earlier"] * 8 + ["confirm"] * 3
    evaluated = [e.configuration for e in result.evaluations]
    assert all(configuration in evaluated[:8] for configuration in evaluated[8:])
