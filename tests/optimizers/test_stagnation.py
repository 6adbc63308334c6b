"""A search that stands still, and the draws that lead it off a plateau."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_history
from hypermap_lite.evaluation.outcome import CONFIRM, MODEL, RANDOM, Evaluation, State, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers import Optimizer, bayesian
from hypermap_lite.optimizers.stagnation import PATIENCE, draws_at_end, stands_still
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import resumed, run, scenario_of

NAMES = ("near", "far")


def history(*rows: tuple[str, tuple[float, ...] | None], objectives: int = 2) -> History:
    """Return a history of these phases and values, both to be minimized; None for a failure."""
    scenario = scenario_of(objectives=[{"name": name} for name in NAMES[:objectives]])
    known = build_history(load_scenario(scenario))
    for trial, (phase, values) in enumerate(rows):
        suggestion = Suggestion(trial=trial, configuration={"a": 0.01 * trial, "b": 0.0}, phase=phase)
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


def test_draws_lead_off_a_plateau_where_the_model_stays() -> None:
    stuck, escaped = (run(on_the_plateau(escapes), 60, function=plateau) for escapes in (0, 3))
    assert min(stuck.history.Y()[:, 0]) >= 0
    assert min(escaped.history.Y()[:, 0]) < -2
    assert RANDOM not in phases(stuck)
    joined = " ".join(phases(escaped))
    assert f"{MODEL} {RANDOM} {RANDOM} {RANDOM} {MODEL}" in joined
    assert " ".join([RANDOM] * 4) not in joined


def as_shown(suggestion: Suggestion) -> Suggestion:
    """Return what a history shows of a suggestion, but for the time it took."""
    return replace(suggestion, seconds=0.0)


@pytest.mark.parametrize("stop", [12, 16, 20, 24])
def test_a_resumed_run_draws_the_same(stop: int) -> None:
    scenario = on_the_plateau(3)
    whole = run(scenario, 28, function=plateau, batch=4)
    expected = [as_shown(e.suggestion) for e in list(whole.history)[stop : stop + 4]]
    assert [as_shown(s) for s in resumed(scenario, list(whole.history)[:stop]).ask(4)] == expected
    assert RANDOM in phases(whole)[12:]


def test_a_batch_shares_the_draws() -> None:
    optimizer = run(on_the_plateau(2), 28, function=plateau, batch=4)
    assert RANDOM in phases(optimizer)
    assert " ".join([RANDOM] * 3) not in " ".join(phases(optimizer))


def test_draws_are_counted_by_their_trials_whatever_finishes_first() -> None:
    drawn = [Suggestion(trial=i, configuration={}, phase=RANDOM) for i in (5, 6, 7)]
    slow = Suggestion(trial=4, configuration={}, phase=MODEL)
    assert draws_at_end([*drawn, slow]) == 3


@pytest.mark.parametrize("prior_free", [0.0, 0.5])
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


@pytest.mark.parametrize("changes", SMOOTH.values(), ids=SMOOTH)
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
