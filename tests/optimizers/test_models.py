"""What the history teaches: the chain of fits."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.evaluation.outcome import Evaluation, State, Suggestion
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.models import FIRST_MILESTONE, milestones
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates.gaussian_process import GaussianProcess, GaussianProcessPosterior
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import Function, evaluate, resumed, run, scenario_of


def test_milestones_grow_by_the_factor() -> None:
    assert list(milestones(20, 1.5)) == [8, 12, 18]
    assert list(milestones(FIRST_MILESTONE, 1.5)) == []


def noisy_after_smooth(n: int) -> list[Evaluation]:
    """Return evaluations whose first few look like a rough function without noise, and the rest like noise."""
    rng = np.random.default_rng(4)
    rows = []
    for trial in range(n):
        a, b = rng.random(2)
        value = float(np.sign(np.sin(9 * a)) + 0.7 * rng.standard_normal() * (trial >= 8))
        suggestion = Suggestion(trial=trial, configuration={"a": a, "b": 10 * b - 5}, phase="design")
        rows.append(Evaluation(suggestion=suggestion, state=State.COMPLETED, values={"y": value}))
    return rows


def fitted(rows: list[Evaluation], **surrogate: Any) -> GaussianProcessPosterior:
    scenario = scenario_of(objectives=[{"name": "y"}], surrogate={"type": "gaussian_process", **surrogate})
    optimizer = resumed(scenario, rows)
    assert isinstance(optimizer, BayesianOptimizer)
    posterior = optimizer.posterior()
    assert isinstance(posterior, GaussianProcessPosterior)
    return posterior


@pytest.mark.parametrize("n", [8, 16, 30])
def test_a_milestones_fit_starts_anew_too(n: int, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, bool, bool]] = []
    fit = GaussianProcess.fit

    def watched(self: GaussianProcess, X: Any, Y: Any, *, start: Any = None, anew: bool = False, **rest: Any) -> Any:
        asked.append((len(X), start is not None, anew))
        return fit(self, X, Y, start=start, anew=anew, **rest)

    monkeypatch.setattr(GaussianProcess, "fit", watched)
    fitted(noisy_after_smooth(n))
    steps = [*milestones(n, 1.2)]
    is_milestone = n in milestones(n + 1, 1.2)
    assert asked == [*((k, k > FIRST_MILESTONE, True) for k in steps), (n, bool(steps), is_milestone)]


def test_a_chain_of_fits_comes_as_far_as_fits_that_start_anew_each_time() -> None:
    rows = noisy_after_smooth(44)
    chained, restarted = (fitted(rows, restart=restart).hyperparameters[0] for restart in (False, True))
    assert chained.noise_variance == pytest.approx(restarted.noise_variance, rel=0.05)
    assert chained.lengthscales == pytest.approx(restarted.lengthscales, rel=0.1)


def test_a_fit_does_not_depend_on_when_it_was_asked_for() -> None:
    rows = noisy_after_smooth(30)
    optimizer = build_optimizer(load_scenario(scenario_of(objectives=[{"name": "y"}])))
    assert isinstance(optimizer, BayesianOptimizer)
    for row in rows:
        optimizer.history.append(row)
        if len(optimizer.history) > 5:
            last = optimizer.posterior()
    X = np.random.default_rng(0).random((5, 2))
    assert np.array_equal(last.predict(X).mean, fitted(rows).predict(X).mean)


def penalized(configuration: Configuration) -> dict[str, float]:
    """Return a smooth valley where it is cheap, and a penalty where it fails, as it does for most."""
    a, b = float(configuration["a"]), float(configuration["b"]) / 10 + 0.5
    return {"y": (a - 0.3) ** 2 + 2 * (b - 0.35 - 0.3 * a) ** 2 if a + b < 0.9 else 1e5}


TOGETHER: dict[str, Any] = {"separate_failures": False}
"""Penalties are rather told apart as failures; without that they are a tail."""


def rows_of(function: Function, n: int, seed: int = 4) -> list[Evaluation]:
    """Return evaluations at random points."""
    rng = np.random.default_rng(seed)
    places = [{"a": float(a), "b": float(10 * b - 5)} for a, b in rng.random((n, 2))]
    suggestions = [Suggestion(trial=k, configuration=place, phase="design") for k, place in enumerate(places)]
    return [evaluate(suggestion, function) for suggestion in suggestions]


def bayesian(rows: list[Evaluation], **changes: Any) -> BayesianOptimizer:
    optimizer = resumed(scenario_of(objectives=[{"name": "y"}], **changes), rows)
    assert isinstance(optimizer, BayesianOptimizer)
    return optimizer


def test_penalties_are_compressed_so_that_the_model_sees_the_rest() -> None:
    rows = rows_of(penalized, 30)
    places = [row.configuration for row in rows_of(penalized, 300, seed=5)]
    known = [place for place in places if penalized(place)["y"] < 1]
    truth = np.array([penalized(place)["y"] for place in known])
    errors = []
    for compresses in (True, False):
        optimizer = bayesian(rows, surrogate={"compress_tails": compresses, **TOGETHER})
        mean = optimizer.predictor().predict(optimizer.history.space.encode(known)).mean[:, 0]
        errors.append(float(np.median(np.abs(mean - truth))))
    assert errors[0] < 1 < 10 < errors[1]


def test_predictions_are_of_what_is_reported() -> None:
    optimizer = bayesian(rows_of(penalized, 30), surrogate=TOGETHER)
    space, Y = optimizer.history.space, optimizer.history.Y()[:, 0]
    prediction = optimizer.predictor().predict(optimizer.history.X())
    assert np.median(prediction.mean[Y == 1e5, 0]) == pytest.approx(1e5, rel=0.5)
    inside = space.encode([{"a": 0.3, "b": -0.6}])
    compressed = optimizer.posterior().predict(inside)
    assert np.array_equal(optimizer.predictor().predict(inside).mean, compressed.mean)


def test_tails_are_those_of_the_last_milestone(caplog: pytest.LogCaptureFixture) -> None:
    rows = rows_of(penalized, 30)
    with caplog.at_level("INFO"):
        models = bayesian(rows, surrogate=TOGETHER)._models
        assert models.tails(7) == (None,)
        assert models.tails(30) == models.tails(28) != models.tails(12)
    assert [record.message.split(";")[0] for record in caplog.records] == [
        "after 13 completed evaluations: values of y above 0.4803 are far beyond the rest"
    ]


@pytest.mark.parametrize("from_replicates", [False, True])
def test_a_fit_to_compressed_tails_does_not_depend_on_when_it_was_asked_for(from_replicates: bool) -> None:
    changes = {"surrogate": {"noise_from_replicates": from_replicates, **TOGETHER}}
    rows = rows_of(penalized, 30)
    optimizer = bayesian([], **changes)
    for row in rows:
        optimizer.history.append(row)
        if len(optimizer.history) > 5:
            last = optimizer.posterior()
    X = np.random.default_rng(0).random((5, 2))
    assert np.array_equal(last.predict(X).mean, bayesian(rows, **changes).posterior().predict(X).mean)


def test_a_penalty_among_replicates_is_not_the_noise_of_the_others() -> None:
    rng = np.random.default_rng(0)
    rows = []
    for k, row in enumerate(rows_of(penalized, 30)):
        values = row.values["y"] + 0.005 * rng.standard_normal(3)
        if k == 20:
            values = np.array([1e5, 0.30, 0.31])
        error = float(values.std(ddof=1) / np.sqrt(3))
        rows.append(replace(row, values={"y": float(values.mean())}, standard_errors={"y": error}, replicates=3))
    optimizer = bayesian(rows, surrogate={"noise_from_replicates": True})
    posterior = optimizer.posterior()
    assert isinstance(posterior, GaussianProcessPosterior)
    (process,) = posterior.processes
    noise = np.sqrt(process.noise_variances) * process.output.scale
    assert np.median(noise[optimizer.history.Y()[:, 0] < 1]) < 0.05


@pytest.mark.parametrize("surrogate", [{}, TOGETHER], ids=["failures", "tails"])
def test_weights_from_boxes_in_the_users_units_see_compressed_tails_and_successes(surrogate: dict[str, Any]) -> None:
    def two(configuration: Configuration) -> dict[str, float]:
        return {"near": penalized(configuration)["y"], "far": float(configuration["a"])}

    boxes = {"type": "bounding_box", "limits": {"near": [0, 1000], "far": [0, 1]}}
    scenario = scenario_of(
        objectives=[{"name": "near"}, {"name": "far"}],
        surrogate=surrogate,
        acquisition={"type": "noisy_expected_improvement", "scalarization": {"type": "tchebyshev"}, "weights": boxes},
    )
    optimizer = resumed(scenario, rows_of(two, 30))
    assert isinstance(optimizer, BayesianOptimizer)
    drawn = [optimizer._context(np.random.default_rng(seed), None).weights[0] for seed in range(40)]
    assert np.mean(drawn) > 0.2  # as they are, 1000 is 1300 times the range of what counts


def test_a_stated_reference_point_is_the_least_limit() -> None:
    def two(configuration: Configuration) -> dict[str, float]:
        y = penalized(configuration)["y"]
        return {"near": y, "far": float(configuration["a"])}

    for objectives, least in (
        ([{"name": "near"}, {"name": "far"}], None),
        ([{"name": "near", "reference_point": 40.0}, {"name": "far"}], 40.0),
    ):
        optimizer = resumed(scenario_of(objectives=objectives, surrogate=TOGETHER), rows_of(two, 30))
        assert isinstance(optimizer, BayesianOptimizer)
        tail, none = optimizer._models.tails()
        assert none is None
        assert tail is not None
        assert tail.limit == least if least else tail.limit < 1


@pytest.mark.slow
def test_where_penalties_are_compressed_the_best_is_found() -> None:
    best: dict[bool, list[float]] = {True: [], False: []}
    for compresses, found in best.items():
        for seed in range(3):
            scenario = scenario_of(
                objectives=[{"name": "y"}],
                seed=seed,
                surrogate={"compress_tails": compresses, **TOGETHER},
                budget={"evaluations": 30},
                design_of_experiment={"number_of_samples": 8},
            )
            found.append(min(e.values["y"] for e in run(scenario, 30, function=penalized).history))
    assert np.median(best[True]) < 1e-5 < np.median(best[False])


def valley(configuration: Configuration) -> dict[str, float]:
    a, b = float(configuration["a"]), float(configuration["b"]) / 10 + 0.5
    return {"y": -((a - 0.3) ** 2) - 2 * (b - 0.35 - 0.3 * a) ** 2}


def with_failures(n: int, *trials: int) -> list[Evaluation]:
    """Return evaluations of the valley, which is to be maximized, where some trials fail without a reason."""
    rows = rows_of(valley, n)
    for trial in trials:
        rows[trial] = replace(rows[trial], values={"y": -50.0})
    return rows


MAXIMIZED = {"objectives": [{"name": "y", "goal": "maximize"}]}


def test_an_evaluation_is_set_aside_with_a_line_of_its_own_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    optimizer = resumed(scenario_of(**MAXIMIZED), with_failures(30, 12, 20))
    assert isinstance(optimizer, BayesianOptimizer)
    with caplog.at_level("INFO"):
        assert optimizer.set_aside() == {12, 20}
        optimizer.tell([evaluate(suggestion, valley) for suggestion in optimizer.ask(1)])
        assert optimizer.set_aside() == {12, 20}
    lines = [record.message for record in caplog.records if "sets it aside" in record.message]
    assert len(lines) == 2
    truth = rows_of(valley, 30)[12].values["y"]
    assert lines[0].startswith("trial 12: y is -50, where the other evaluations foretell ")
    assert float(lines[0].split("foretell ")[1].split()[0]) == pytest.approx(truth, abs=0.05)


@pytest.mark.parametrize("surrogate", [{"ignore_outliers": False}, {"noise": False}, "random_forest"])
def test_none_is_set_aside_where_that_is_not_asked_for(surrogate: Any) -> None:
    optimizer = resumed(scenario_of(**MAXIMIZED, surrogate=surrogate), with_failures(30, 12))
    assert isinstance(optimizer, BayesianOptimizer)
    assert optimizer.set_aside() == set()


def test_what_is_set_aside_does_not_depend_on_when_it_was_asked_for() -> None:
    rows = with_failures(40, 9, 12, 30)
    at_once, step_by_step = (resumed(scenario_of(**MAXIMIZED), rows[:k]) for k in (40, 10))
    for row in rows[10:]:
        step_by_step.posterior()
        step_by_step.history.append(row)
    assert at_once.set_aside() == step_by_step.set_aside() == {9, 12, 30}
    X = at_once.history.X()
    assert np.array_equal(at_once.posterior().predict(X).mean, step_by_step.posterior().predict(X).mean)


@pytest.mark.slow
def test_one_failure_in_ten_does_not_keep_the_search_from_the_optimum() -> None:
    best: dict[bool, list[float]] = {True: [], False: []}
    for ignores, found in best.items():
        for seed in range(3):
            luck = np.random.default_rng(seed)
            scenario = scenario_of(
                **MAXIMIZED, seed=seed, surrogate={"ignore_outliers": ignores}, budget={"evaluations": 30}
            )
            optimizer = run(
                scenario, 30, function=lambda place, luck=luck: valley(place) if luck.random() > 0.1 else {"y": -50.0}
            )
            found.append(max(e.values["y"] for e in optimizer.history))
    assert np.median(best[False]) < -1e-4 < np.median(best[True])
