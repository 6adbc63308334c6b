"""Two kinds of evaluations of which the front needs both."""

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
import pytest

from hypermap_lite.acquisition import AcquisitionContext, NoisyExpectedHypervolumeImprovement
from hypermap_lite.acquisition.base import Scorer
from hypermap_lite.acquisition.either import Either
from hypermap_lite.evaluation.outcome import Evaluation, State
from hypermap_lite.optimizers.bayesian import BayesianOptimizer
from hypermap_lite.optimizers.models import milestones
from hypermap_lite.pareto.hypervolume import hypervolume
from hypermap_lite.reports.posterior_front import posterior_front
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates import GaussianProcess
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import configurations, evaluate, resumed, run, scenario_of
from tests.slow import slow_after


def is_fast(place: Configuration) -> bool:
    return float(place["a"]) + 0.1 * float(place["b"]) / 5 > 0.5


def gait(place: Configuration) -> dict[str, float]:
    """Return how long a walk in one of two gaits takes, to be short, and how gentle it is, to be high."""
    a, b = float(place["a"]), float(place["b"]) / 5
    if is_fast(place):
        return {"near": 1 + 0.5 * (1 - a) + 0.2 * (b - 0.3) ** 2, "far": -2 - 0.5 * a - 0.2 * (b - 0.3) ** 2}
    return {"near": 2 + 0.5 * a + 0.2 * (b + 0.3) ** 2, "far": -1.5 + 0.5 * a - 0.2 * (b + 0.3) ** 2}


SCENARIO = scenario_of(
    objectives=[{"name": "near", "reference_point": 3}, {"name": "far", "goal": "maximize", "reference_point": -3}],
    design_of_experiment={"number_of_samples": 12},
    budget={"evaluations": 40},
)
TOGETHER: dict[str, Any] = {"surrogate": {"separate_modes": False}}


def told(n: int, **changes: Any) -> BayesianOptimizer:
    optimizer = run(SCENARIO | changes, n, function=gait)
    assert isinstance(optimizer, BayesianOptimizer)
    return optimizer


def going_on_from(rows: list[Evaluation], **changes: Any) -> BayesianOptimizer:
    optimizer = resumed(SCENARIO | changes, rows)
    assert isinstance(optimizer, BayesianOptimizer)
    return optimizer


@pytest.fixture(scope="module")
def after_24() -> BayesianOptimizer:
    return told(24)


def test_either_kind_has_models_to_which_the_other_is_infeasible(after_24: BayesianOptimizer) -> None:
    modes = after_24._separate.modes()
    assert modes is not None
    kinds = [{e.trial for e in models.history.completed} for models in (modes.low, modes.high)]
    fast = {e.trial for e in after_24.history if is_fast(e.configuration)}
    assert fast in kinds
    assert kinds[0] | kinds[1] == set(range(24))
    assert not kinds[0] & kinds[1]
    assert all(e.is_completed for e in after_24.history)
    assert after_24._models.history is after_24.history


def test_next_to_the_cliff_what_is_predicted_is_of_one_kind_or_of_the_other(after_24: BayesianOptimizer) -> None:
    places: list[Configuration] = [{"a": a, "b": 0.0} for a in (0.3, 0.4, 0.6, 0.7)]
    predicted = after_24.predictor().predict(after_24.history.space.encode(places)).mean
    assert predicted == pytest.approx(np.array([[gait(p)["near"], -gait(p)["far"]] for p in places]), abs=0.05)
    between = after_24.history.space.encode([{"a": a, "b": 0.0} for a in np.linspace(0.4, 0.6, 41)])

    def n_halfway(optimizer: BayesianOptimizer) -> int:
        near = optimizer.predictor().predict(between).mean[:, 0]
        return int(((near > 1.4) & (near < 2.1)).sum())

    assert n_halfway(after_24) == 0
    assert n_halfway(going_on_from(list(after_24.history), **TOGETHER)) > 3


@pytest.mark.slow
def test_what_was_evaluated_is_predicted_as_it_was(after_24: BayesianOptimizer) -> None:
    """Also where the chances of the other kind are better."""
    for optimizer in (after_24, told(40, seed=1)):
        assert optimizer._separate.modes() is not None
        history = optimizer.history
        assert optimizer.predictor().predict(history.X()).mean == pytest.approx(history.Y(), abs=0.02)


def test_tails_are_left_as_they_are(after_24: BayesianOptimizer, monkeypatch: pytest.MonkeyPatch) -> None:
    def compressed(*args: Any, **options: Any) -> None:
        raise AssertionError

    optimizer = going_on_from(list(after_24.history))
    modes = optimizer._separate.modes()
    assert modes is not None
    monkeypatch.setattr(GaussianProcess, "tails", compressed)
    assert modes.low.tails() == modes.high.tails() == (None, None)


class Recording(NoisyExpectedHypervolumeImprovement):
    """Keeps what it is told."""

    told: ClassVar[list[AcquisitionContext]] = []

    def scorer(self, context: AcquisitionContext) -> Scorer:
        self.told.append(context)
        return super().scorer(context)


def test_either_kind_has_to_go_beyond_the_front_of_both_and_of_what_is_under_way(after_24: BayesianOptimizer) -> None:
    modes, context = after_24._separate.modes(), after_24._context(np.random.default_rng(0), None)
    assert modes is not None
    Recording.told.clear()
    places: list[Configuration] = [{"a": 0.9, "b": 0.5}, {"a": 0.1, "b": 0.5}, {"a": 0.95, "b": -1.0}]
    pending = after_24.history.space.encode(places)
    either = modes.scorer(Recording(), replace(context, X_pending=pending), 1.0)
    assert isinstance(either, Either)
    low, high = Recording.told
    slow_is_low = {e.trial for e in modes.low.history.completed} != {
        e.trial for e in after_24.history if is_fast(e.configuration)
    }
    slow, fast = (low, high) if slow_is_low else (high, low)
    assert np.array_equal(slow.X_pending, pending[[1]])
    assert np.array_equal(fast.X_pending, pending[[0, 2]])
    truth = np.array([[gait(place)["near"], -gait(place)["far"]] for place in places])
    for own, other, coming in ((slow, fast, truth[[0, 2]]), (fast, slow, truth[[1]])):
        assert own.beside == pytest.approx(np.vstack([other.Y, coming]), abs=0.02)


def test_a_prior_has_a_part_in_either_kind(after_24: BayesianOptimizer) -> None:
    needle: dict[str, Any] = {
        name: {"parameter_type": "real", "values": values, "prior": {"type": "gaussian", "mean": mean, "std": std}}
        for name, values, mean, std in (("a", [0, 1], 0.9, 0.02), ("b", [-5, 5], 4.0, 0.2))
    }
    weighting = {"prior_free": 0, "beta": 200, "safeguard": False, "floor": 0}
    rows = list(after_24.history)
    with_prior = going_on_from(rows, input_parameters=needle, acquisition={"prior_weighting": weighting})
    assert with_prior._separate.modes() is not None
    (guided,), (free,) = with_prior.ask(1), going_on_from(rows).ask(1)
    assert guided.prior_weight
    assert guided.configuration == pytest.approx({"a": 0.9, "b": 4.0}, abs=0.3)
    assert free.configuration != pytest.approx({"a": 0.9, "b": 4.0}, abs=0.3)


def test_promises_of_the_models_before_do_not_count(after_24: BayesianOptimizer) -> None:
    separate = after_24._separate
    since = separate.modes_since()
    assert since in milestones(25, 1.2)
    assert separate.failures(since) is not None
    before = separate.failures(since - 1)
    assert before is None or not before.are_needed
    assert going_on_from(list(after_24.history), **TOGETHER)._separate.modes_since() == 0


def test_of_all_the_mean_of_both_kinds_is_expected(after_24: BayesianOptimizer) -> None:
    X = after_24.history.space.encode([{"a": a, "b": 0.0} for a in np.linspace(0.45, 0.55, 41)])
    mean = after_24.predictor_of_all().predict(X).mean[:, 0]
    assert ((mean > 1.5) & (mean < 1.95)).any()


def test_both_kinds_are_on_the_posterior_front(after_24: BayesianOptimizer) -> None:
    front = posterior_front(load_scenario(SCENARIO), after_24.history, after_24)
    assert {is_fast(p.configuration) for p in front.predictions} == {True, False}
    assert after_24.set_aside() == set()


@pytest.mark.slow
def test_both_kinds_are_confirmed() -> None:
    optimizer = run(SCENARIO | {"budget": {"evaluations": 40, "confirm_front": 8}}, 40, function=gait)
    assert isinstance(optimizer, BayesianOptimizer)
    confirmed = [e for e in optimizer.history if e.suggestion.phase == "confirm"]
    assert len(confirmed) == 8
    assert {is_fast(e.configuration) for e in confirmed} == {True, False}


def test_the_log_says_it_once(caplog: pytest.LogCaptureFixture, after_24: BayesianOptimizer) -> None:
    optimizer = going_on_from(list(after_24.history))
    with caplog.at_level("INFO"):
        for _ in range(3):
            optimizer.tell([evaluate(s, gait) for s in optimizer.ask(1)])
    (line,) = [r.message for r in caplog.records if "two kinds" in r.message]
    assert line.startswith(
        ("after 24 completed evaluations: values of near are", "after 24 completed evaluations: values of far")
    )
    assert line.endswith("the model learns where each of them is to be expected, and what it is like")


@pytest.mark.parametrize(
    "changes",
    [
        TOGETHER,
        {"surrogate": {"separate_failures": False}},
        {"surrogate": "random_forest"},
        {"acquisition": "expected_improvement"},
        {"acquisition": {"feasibility_weighting": "none"}},
        {"acquisition": {"prior_weighting": {"method": "bopro"}}},
        {"preset": "paper"},
    ],
    ids=str,
)
def test_elsewhere_both_are_of_one_kind(changes: dict[str, Any], after_24: BayesianOptimizer) -> None:
    optimizer = going_on_from(list(after_24.history), **changes)
    assert optimizer._separate.modes() is None
    assert optimizer.ask(1)


@pytest.mark.parametrize(
    "changes",
    slow_after(
        1,
        [
            {},
            {"budget": {"evaluations": 40, "batch_size": 3}},
            {"objectives": [{"name": "near"}, {"name": "far", "goal": "maximize"}]},
            {
                "input_parameters": {
                    "a": {
                        "parameter_type": "real",
                        "values": [0, 1],
                        "prior": {"type": "gaussian", "mean": 0.8, "std": 0.2},
                    },
                    "b": {"parameter_type": "real", "values": [-5, 5]},
                },
                "acquisition": {"prior_weighting": {"prior_free": 0.5}},
            },
        ],
    ),
    ids=["one at a time", "batches", "no reference point", "prior"],
)
def test_a_resumed_run_goes_on_as_the_uninterrupted_one(changes: dict[str, Any]) -> None:
    scenario, batch = SCENARIO | changes, changes.get("budget", {}).get("batch_size", 1)
    whole = run(scenario, 33, batch=batch, function=gait)
    assert isinstance(whole, BayesianOptimizer)
    assert whole._separate.modes() is not None
    for n in (15, 27):
        again = resumed(scenario, list(whole.history)[:n])
        while len(again.history) < 33:
            again.tell([evaluate(s, gait) for s in again.ask(min(batch, 33 - len(again.history)))])
        assert configurations(again) == configurations(whole)


@pytest.mark.slow
def test_where_nothing_is_allowed_neither_is_looked_for() -> None:
    """Of either kind half is infeasible."""
    optimizer = run(SCENARIO, 12, function=gait)
    rows = list(optimizer.history)
    optimizer = going_on_from(rows, feasible_output={"name": "valid"})
    while len(optimizer.history) < 36:
        (suggestion,) = optimizer.ask(1)
        is_valid = float(suggestion.configuration["b"]) < 0
        state = State.COMPLETED if is_valid else State.INFEASIBLE
        values = gait(suggestion.configuration) | {"valid": float(is_valid)}
        optimizer.tell([Evaluation(suggestion=suggestion, state=state, values=values)])
    assert optimizer._separate.modes() is not None
    late = list(optimizer.history)[24:]
    assert sum(e.is_completed for e in late) >= 8


@pytest.mark.slow
def test_an_outlier_of_either_kind_is_set_aside() -> None:
    optimizer = told(30)
    rows = list(optimizer.history)
    for fast in (True, False):
        place = next(i for i, row in enumerate(rows) if is_fast(row.configuration) == fast and i > 5)
        worse = {"near": rows[place].values["near"] + 0.4, "far": rows[place].values["far"] - 0.4}
        changed = [*rows[:place], replace(rows[place], values=worse), *rows[place + 1 :]]
        again = going_on_from(changed)
        assert again._separate.modes() is not None
        assert again.set_aside() == {rows[place].trial}


@pytest.mark.slow
def test_a_front_with_a_cliff_in_it_is_found_better() -> None:
    corner = np.array([3.0, 3.0])
    found: dict[bool, list[float]] = {True: [], False: []}
    for is_one, volumes in found.items():
        for seed in range(4):
            optimizer = told(32, seed=seed, **(TOGETHER if is_one else {}))
            volumes.append(hypervolume(optimizer.history.Y(), corner))
    assert np.mean(found[False]) > np.mean(found[True]) + 0.01
