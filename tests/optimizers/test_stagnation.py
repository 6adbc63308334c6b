"""A search that stands still, and the draws that lead it off a plateau."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_history
from hypermap_lite.evaluation.outcome import CONFIRM, MODEL, RANDOM, Evaluation, State, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers import Optimizer, bayesian
from hypermap_lite.optimizers.stagnation import (
    PATIENCE,
    PATIENCE_IN_THE_DARK,
    PATIENCE_WITH_ONE,
    draws_at_end,
    is_in_the_dark,
    stands_still,
)
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.surrogates.base import Prediction
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import Function, resumed, run, scenario_of, two_objectives
from tests.slow import slow_after

NAMES = ("near", "far")
GUIDED = "guided"


def history(*rows: tuple[str, tuple[float, ...] | None], objectives: int = 2, promise: float = 0.1) -> History:
    """Return a history of these phases and values, both to be minimized; None for a failure.

    The model promised as much each time; in the phase `GUIDED` a prior had a part in its suggestion.
    """
    stated = {"reference_point": 3} if objectives > 1 else {}
    scenario = scenario_of(objectives=[{"name": name, **stated} for name in NAMES[:objectives]])
    known = build_history(load_scenario(scenario))
    for trial, (phase, values) in enumerate(rows):
        value = math.log(promise) if phase in (MODEL, GUIDED) else None
        configuration, weight = {"a": 0.01 * trial, "b": 0.0}, 1.0 if phase == GUIDED else None
        phase = MODEL if phase == GUIDED else phase
        about = {"phase": phase, "acquisition_value": value, "prior_weight": weight}
        suggestion = Suggestion(trial=trial, configuration=configuration, **about)
        state = State.FAILED if values is None else State.COMPLETED
        named = {} if values is None else dict(zip(NAMES, values, strict=False))
        known.append(Evaluation(suggestion=suggestion, state=state, values=named, error="" if values else "broken"))
    return known


USELESS = (MODEL, (2.0, 2.0))
GOOD = (MODEL, (0.0, 3.0))
KNOWN = ("design", (1.0, 1.0))


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([KNOWN], False),
        ([KNOWN, *[USELESS] * (PATIENCE - 1)], False),
        ([KNOWN, *[USELESS] * PATIENCE], True),
        ([KNOWN, GOOD, *[USELESS] * PATIENCE], True),
        ([KNOWN, *[USELESS] * PATIENCE, GOOD], False),
        ([KNOWN, *[USELESS] * PATIENCE, (RANDOM, (0.0, 3.0))], True),  # the model has to see for itself
        ([KNOWN, *[(MODEL, None)] * PATIENCE], True),
        ([KNOWN, *[(MODEL, (1.0, 1.0))] * PATIENCE], True),  # the same once more adds nothing
        ([("design", None)], False),
    ],
)
def test_a_search_stands_still_when_the_models_last_suggestions_added_nothing(rows: Any, expected: bool) -> None:
    assert stands_still(history(*rows)) is expected


@pytest.mark.parametrize(("values", "expected"), [((1.0, 1.0, 1.0), True), ((1.0, 1.0, 0.5), False)])
def test_one_objective_stands_still_as_long_as_it_has_one_value(values: tuple[float, ...], expected: bool) -> None:
    assert stands_still(history(*[(MODEL, (value,)) for value in values], objectives=1)) is expected


class Known:
    """A posterior of which only what is asked for here is there."""

    def __init__(self, history: History, explained: Any) -> None:
        self._mean = history.Y()
        self._explained = explained

    def explained(self) -> Any:
        return None if self._explained is None else np.array(self._explained)

    def predict(self, X: np.ndarray) -> Prediction:
        assert len(X) == len(self._mean)
        return Prediction(mean=self._mean, std=np.zeros_like(self._mean))


BETTER = [(MODEL, (0.9 - 0.1 * k, 0.9 - 0.1 * k)) for k in range(PATIENCE_IN_THE_DARK)]


@pytest.mark.parametrize(
    ("rows", "explained", "expected"),
    [
        ([USELESS] * PATIENCE_IN_THE_DARK, (0.9, 0.0), True),
        ([USELESS] * PATIENCE_IN_THE_DARK, (-0.1, 0.9), True),
        ([USELESS] * PATIENCE_IN_THE_DARK, (0.9, 0.1), False),  # something is known of both
        ([USELESS] * PATIENCE_IN_THE_DARK, None, False),
        ([USELESS] * (PATIENCE_IN_THE_DARK - 1), (0.9, 0.0), False),
        ([(MODEL, None)] * PATIENCE_IN_THE_DARK, (0.9, 0.0), True),
        (BETTER, (0.9, 0.0), False),
        ([*BETTER, *[USELESS] * PATIENCE_IN_THE_DARK], (0.9, 0.0), True),
        ([*[USELESS] * PATIENCE_IN_THE_DARK, BETTER[0]], (0.9, 0.0), False),
        ([*[USELESS] * PATIENCE_IN_THE_DARK, (RANDOM, (0.0, 0.0))], (0.9, 0.0), True),
        ([USELESS] * PATIENCE_IN_THE_DARK, (0.9, 1e-9), True),  # what rounding leaves of zero
        ([*[USELESS] * PATIENCE_IN_THE_DARK, (GUIDED, (0.0, 0.0))], (0.9, 0.0), False),
        ([*[USELESS] * 3, (GUIDED, (2.0, 2.0)), *[USELESS] * 3], (0.9, 0.0), False),
        ([(GUIDED, (0.0, 0.0)), *[USELESS] * PATIENCE_IN_THE_DARK], (0.9, 0.0), True),
    ],
)
def test_a_model_that_knows_nothing_of_an_objective_and_breaks_its_promises_is_in_the_dark(
    rows: Any, explained: Any, expected: bool
) -> None:
    known = history(KNOWN, ("design", (1.1, 0.9)), *rows)
    assert is_in_the_dark(known, known.Y(), Known(known, explained)) is expected  # type: ignore[arg-type]


def test_a_gain_that_is_small_for_the_promise_leaves_it_in_the_dark() -> None:
    small = [(MODEL, (0.99 - 0.001 * k, 0.9)) for k in range(PATIENCE_IN_THE_DARK)]
    for promise, expected in ((1e4, True), (1e-6, False)):
        known = history(KNOWN, ("design", (1.1, 0.9)), *small, promise=promise)
        assert is_in_the_dark(known, known.Y(), Known(known, (0.9, 0.0))) is expected  # type: ignore[arg-type]


@pytest.mark.parametrize(("n", "expected"), [(PATIENCE_WITH_ONE - 1, False), (PATIENCE_WITH_ONE, True)])
def test_one_objective_is_given_more_time(n: int, expected: bool) -> None:
    known = history(("design", (1.0,)), ("design", (1.1,)), *[(MODEL, (1.0,))] * n, objectives=1)
    assert is_in_the_dark(known, known.Y(), Known(known, (0.0,))) is expected  # type: ignore[arg-type]


def test_draws_in_a_row_are_counted_from_the_end() -> None:
    phases = ["design", RANDOM, MODEL, RANDOM, CONFIRM, RANDOM]
    assert draws_at_end(Suggestion(trial=i, configuration={}, phase=p) for i, p in enumerate(phases)) == 2
    assert draws_at_end([Suggestion(trial=0, configuration={}, phase=MODEL)]) == 0
    assert draws_at_end([]) == 0


def plateau(c: Configuration) -> dict[str, float]:
    """Return two efforts, both least at a corner, and far less in a small region away from it."""
    a, b = float(c["a"]), float(c["b"]) / 5
    succeeds = 0.4 < a < 0.8 and 0.0 < b < 0.6
    return {"near": a - 3.0 * succeeds, "far": -(b + 3.0 * succeeds)}


def phases(optimizer: Optimizer) -> list[str]:
    return [e.suggestion.phase for e in optimizer.history]


def on_the_plateau(escapes: int, **changes: Any) -> dict[str, Any]:
    return scenario_of(
        optimizer={"type": "bayesian", "escapes": escapes},
        objectives=[{"name": "near", "reference_point": 2}, {"name": "far", "goal": "maximize", "reference_point": -2}],
        design_of_experiment={"type": "grid", "levels": 2, "number_of_samples": 4},
        budget={"evaluations": 80},
        **changes,
    )


@pytest.mark.slow
def test_draws_lead_off_a_plateau_where_the_model_stays() -> None:
    stuck, escaped = (run(on_the_plateau(escapes), 60, function=plateau) for escapes in (0, 3))
    assert min(stuck.history.Y()[:, 0]) >= 0
    assert min(escaped.history.Y()[:, 0]) < -2
    assert RANDOM not in phases(stuck)
    joined = " ".join(phases(escaped))
    assert f"{MODEL} {RANDOM} {RANDOM} {RANDOM} {MODEL}" in joined
    assert " ".join([RANDOM] * 4) not in joined


def noisy(c: Configuration) -> np.ndarray:
    """Return two standard normal draws, others for each configuration."""
    return np.random.default_rng(abs(hash((float(c["a"]), float(c["b"]))))).standard_normal(2)


def rough_plateau(c: Configuration) -> dict[str, float]:
    """Return an effort, and a duration that is noise."""
    noise = noisy(c)
    return {"near": 0.3 * float(c["a"]) + 0.02 * noise[0], "far": -1 + 0.02 * noise[1]}


def rough_slopes(c: Configuration) -> dict[str, float]:
    """Return two conflicting objectives with as much noise."""
    a, b = float(c["a"]), float(c["b"]) / 5
    noise = noisy(c)
    return {"near": a + b * b + 0.02 * noise[0], "far": 2 * a - b * b - 1 + 0.02 * noise[1]}


def phases_of(function: Function, seed: int = 0, **changes: Any) -> list[str]:
    return phases(run(on_the_plateau(3) | {"seed": seed} | changes, 30, function=function))


@pytest.mark.slow
def test_draws_lead_off_a_plateau_whose_noise_hides_that_it_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = [trace for seed in range(5) if RANDOM in (trace := phases_of(rough_plateau, seed))]
    assert len(drawn) >= 3
    assert all(trace.index(RANDOM) >= 4 + PATIENCE_IN_THE_DARK for trace in drawn)
    assert RANDOM not in phases_of(rough_slopes)
    monkeypatch.setattr(bayesian, "is_in_the_dark", lambda history, observed, posterior: False)
    assert not any(RANDOM in phases_of(rough_plateau, seed) for seed in range(2))


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, True),
        ({"acquisition": {"type": "expected_improvement"}, "objectives": [{"name": "near"}]}, True),
        ({"acquisition": {"type": "noisy_expected_improvement", "scalarization": {"type": "tchebyshev"}}}, False),
        ({"acquisition": {"type": "thompson_sampling"}}, False),
        ({"acquisition": {"type": "thompson_sampling"}, "objectives": [{"name": "near"}]}, False),
        ({"objectives": [{"name": name} for name in ("near", "far", "near2", "far2")]}, False),
    ],
)
def test_only_promises_that_are_checked_can_leave_a_model_in_the_dark(
    changes: Any, expected: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bayesian, "is_in_the_dark", lambda history, observed, posterior: True)
    monkeypatch.setattr(bayesian, "stands_still", lambda history: False)

    def function(c: Configuration) -> dict[str, float]:
        values = two_objectives(c)
        return values | {f"{name}2": -value for name, value in values.items()}

    trace = phases(run(on_the_plateau(3) | changes, 8, function=function))
    assert (RANDOM in trace) is expected


def as_shown(suggestion: Suggestion) -> Suggestion:
    """Return what a history shows of a suggestion, but for the time it took."""
    return replace(suggestion, seconds=0.0)


@pytest.mark.parametrize("function", slow_after(1, [plateau, rough_plateau]), ids=lambda f: f.__name__)
def test_a_resumed_run_draws_the_same(function: Function) -> None:
    scenario = on_the_plateau(3)
    whole = run(scenario, 28, function=function, batch=4)
    assert RANDOM in phases(whole)[12:]
    for stop in (12, 16, 20, 24):
        expected = [as_shown(e.suggestion) for e in list(whole.history)[stop : stop + 4]]
        assert [as_shown(s) for s in resumed(scenario, list(whole.history)[:stop]).ask(4)] == expected


def test_a_batch_shares_the_draws() -> None:
    optimizer = run(on_the_plateau(2), 28, function=plateau, batch=4)
    assert RANDOM in phases(optimizer)
    assert " ".join([RANDOM] * 3) not in " ".join(phases(optimizer))


def test_draws_are_counted_by_their_trials_whatever_finishes_first() -> None:
    drawn = [Suggestion(trial=i, configuration={}, phase=RANDOM) for i in (5, 6, 7)]
    slow = Suggestion(trial=4, configuration={}, phase=MODEL)
    assert draws_at_end([*drawn, slow]) == 3


@pytest.mark.parametrize("prior_free", slow_after(1, [0.5, 0.0]))
def test_a_step_that_a_prior_guides_is_no_draw(prior_free: float) -> None:
    prior = {"type": "gaussian", "mean": 0.0, "std": 0.01}
    parameters = scenario_of()["input_parameters"]
    parameters["a"] = parameters["a"] | {"prior": prior}
    acquisition = {"prior_weighting": {"method": "pibo", "prior_free": prior_free, "safeguard": False}}
    scenario = on_the_plateau(3, input_parameters=parameters, acquisition=acquisition)
    drawn = [e.suggestion for e in run(scenario, 40, function=plateau).history if e.suggestion.phase == RANDOM]
    assert bool(drawn) is bool(prior_free)
    assert {s.prior_weight for s in drawn} <= {0.0}
    assert all(float(s.configuration["a"]) > 0.02 for s in drawn)  # uniform, with next to no chance of less


def test_draws_keep_their_distance_in_a_batch() -> None:
    scenario = on_the_plateau(8)
    scenario["optimizer"] |= {"separation": 0.3}
    optimizer = run(scenario, 20, function=plateau, batch=4)
    asked = optimizer.ask(4)
    assert RANDOM in {s.phase for s in asked}
    X = optimizer.history.space.encode([s.configuration for s in asked])
    distances = np.abs(X[:, None] - X[None]).max(axis=2)[np.triu_indices(4, 1)]
    assert distances.min() >= 0.3


FOUR = [{"name": name} for name in "pqrs"]
SMOOTH: dict[str, dict[str, Any]] = {
    "hypervolume": {},
    "scalarized": {
        "acquisition": {
            "type": "noisy_expected_improvement",
            "scalarization": {"type": "tchebyshev"},
            "weights": {"type": "dirichlet", "ends": 0.5, "redraws": 8},
        }
    },
    "four objectives": {"objectives": FOUR},
}


def smooth(c: Configuration) -> dict[str, float]:
    """Return quadratics with optima at different places."""
    a, b = float(c["a"]), float(c["b"]) / 10 + 0.5
    places = {"p": (0.2, 0.2), "q": (0.8, 0.2), "r": (0.2, 0.8), "s": (0.8, 0.8)}
    four = {name: (a - x) ** 2 + (b - y) ** 2 for name, (x, y) in places.items()}
    return {**four, "near": four["p"], "far": -four["s"]}


@pytest.mark.parametrize("changes", slow_after(1, SMOOTH.values()), ids=SMOOTH)
def test_a_search_that_promises_something_is_left_alone(
    changes: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bayesian, "stands_still", lambda history: True)
    assert RANDOM not in phases(run(scenario_of(**changes), 12, function=smooth))
    monkeypatch.setattr(bayesian, "NEXT_TO_NOTHING", np.inf)
    assert RANDOM in phases(run(scenario_of(**changes), 12, function=smooth))


def test_one_value_only_makes_draws_until_there_is_another() -> None:
    def rarely(c: Configuration) -> dict[str, float]:
        return {"y": float(float(c["a"]) < 0.9 or float(c["b"]) < 3)}

    scenario = scenario_of(objectives=[{"name": "y"}], budget={"evaluations": 60})
    chosen = run(scenario, 60, function=rarely)
    first = int(np.argmin(chosen.history.Y()[:, 0]))
    assert phases(chosen)[5:9] == [RANDOM, RANDOM, RANDOM, MODEL]
    assert chosen.history.Y()[first, 0] == 0
    assert RANDOM not in phases(chosen)[first + 1 :]
