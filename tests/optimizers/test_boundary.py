"""What points on the bounds of the space promise, and how it counts once that has not come true."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from hypermap_lite.acquisition.boundary_weighted import BoundaryWeighted, nearness
from hypermap_lite.assembly import build_history
from hypermap_lite.evaluation.outcome import CONFIRM, MODEL, RANDOM, Evaluation, State, Suggestion
from hypermap_lite.history.history import History
from hypermap_lite.optimizers import Optimizer, bayesian
from hypermap_lite.optimizers.boundary import boundary_factor
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.typing import Configuration
from tests.optimizers.runs import resumed, run, scenario_of

UNIT: dict[str, Any] = {"parameter_type": "real", "values": [0, 1]}
NAMES = ("near", "far")
START = ("design", 0.5, (1.0, 1.0), {})
LOSS, GAIN = (1.0, 1.5), (0.5, 0.5)
GOOD_ON_BOUND = (("design", 0.4, (1.1, 0.9), {}), (MODEL, 0.0, GAIN, {}))


def history(*rows: Any, m: int = 2, reference_point: float | None = 2.0) -> History:
    """Return a history of phases, places along one of two axes, values to be minimized, and what else is known.

    By default each suggestion promises 0.1, in units of the objectives' ranges.
    """
    stated = {} if reference_point is None or m == 1 else {"reference_point": reference_point}
    scenario = scenario_of(
        input_parameters={"a": UNIT, "b": UNIT}, objectives=[{"name": name, **stated} for name in NAMES[:m]]
    )
    known = build_history(load_scenario(scenario))
    for trial, (phase, a, values, more) in enumerate(rows):
        about = {"acquisition_value": math.log(0.1)} | more
        suggestion = Suggestion(trial=trial, configuration={"a": a, "b": 0.5 + 0.001 * trial}, phase=phase, **about)
        state = State.FAILED if values is None else State.COMPLETED
        named = {} if values is None else dict(zip(NAMES, values, strict=False))
        known.append(Evaluation(suggestion=suggestion, state=state, values=named, error="" if values else "broken"))
    return known


def factor_after(*rows: Any, least: float = 0.3, **options: Any) -> float:
    known = history(START, ("design", 0.4, (1.1, 0.9), {}), *rows, **options)
    return boundary_factor(known, known.Y(), known.Y(), least)


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([], 1.0),
        ([(MODEL, 0.0, LOSS, {})], 0.3),
        ([(MODEL, 1.0, LOSS, {})], 0.3),
        ([(MODEL, 0.0, None, {})], 0.3),  # failed
        ([(MODEL, 0.0, GAIN, {})], 1.0),
        ([(MODEL, 0.0, LOSS, {}), (MODEL, 0.0, GAIN, {})], 1.0),
        ([(MODEL, 0.0, LOSS, {}), (MODEL, 0.0, LOSS, {}), (MODEL, 0.0, GAIN, {})], 0.3**0.75),
        ([(MODEL, 0.0, GAIN, {}), (MODEL, 0.0, (0.49, 0.6), {"acquisition_value": math.log(10)})], 1.0),
        ([(MODEL, 0.5, LOSS, {})], 1.0),  # inside
        ([(MODEL, 0.03, LOSS, {})], 0.3),  # as good as on it
        ([(RANDOM, 0.0, LOSS, {})], 1.0),  # promised nothing
        ([(CONFIRM, 0.0, LOSS, {})], 1.0),
        ([(MODEL, 0.0, LOSS, {"prior_weight": 2.0})], 1.0),
        ([(MODEL, 0.0, LOSS, {"prior_weight": 0.0})], 0.3),
        ([(MODEL, 0.0, LOSS, {"acquisition_value": None})], 1.0),
    ],
)
def test_broken_promises_lower_the_factor_and_kept_ones_raise_it(rows: Any, expected: float) -> None:
    assert factor_after(*rows) == pytest.approx(expected)


def test_gain_that_is_small_for_the_promise_breaks_it() -> None:
    small = (0.99, 1.0)
    assert factor_after((MODEL, 0.0, small, {"acquisition_value": math.log(1e-6)})) == 1.0
    assert factor_after((MODEL, 0.0, small, {"acquisition_value": math.log(10.0)})) == 0.3


@pytest.mark.parametrize(("y", "expected"), [(0.5, 1.0), (2.0, 0.3)])
def test_with_one_objective_the_gain_is_the_improvement(y: float, expected: float) -> None:
    rows = [("design", 0.4, (1.5,), {}), ("design", 0.5, (1.0,), {}), (MODEL, 0.0, (y,), {})]
    known = history(*rows, m=1)
    assert boundary_factor(known, known.Y(), known.Y(), 0.3) == expected


def test_reference_point_is_inferred_where_none_is_given() -> None:
    assert factor_after((MODEL, 0.0, GAIN, {}), reference_point=None) == 1.0
    assert factor_after((MODEL, 0.0, LOSS, {}), reference_point=None) == 0.3


def test_luck_is_no_kept_promise() -> None:
    known = history(START, ("design", 0.4, (1.1, 0.9), {}), (MODEL, 0.0, GAIN, {}))
    by_the_model = known.Y().copy()
    by_the_model[2] = LOSS
    assert boundary_factor(known, known.Y(), known.Y(), 0.3) == 1.0
    assert boundary_factor(known, known.Y(), by_the_model, 0.3) == 0.3


def test_point_near_several_bounds_is_on_none_of_them() -> None:
    """A sum over the axes would take it for one on a bound, and in many dimensions nearly all points."""
    near_both = history(START, ("design", 0.4, (1.1, 0.9), {}))
    corner = Suggestion(trial=2, configuration={"a": 0.08, "b": 0.08}, phase=MODEL, acquisition_value=math.log(0.1))
    near_both.append(Evaluation(suggestion=corner, state=State.COMPLETED, values=dict(zip(NAMES, LOSS, strict=True))))
    assert nearness(np.array([[0.08, 0.08]]), np.ones(2, dtype=bool)).sum() > 0.7
    assert boundary_factor(near_both, near_both.Y(), near_both.Y(), 0.3) == 1.0


def test_factor_of_one_is_no_discount() -> None:
    assert factor_after((MODEL, 0.0, LOSS, {}), least=1.0) == 1.0


CENTRES = np.random.default_rng(5).random((12, 6))


def rough(c: Configuration) -> dict[str, float]:
    """Return two objectives with narrow wells inside the cube, on a slope."""
    x = np.array([float(c[name]) for name in "abcdef"])
    wells = np.exp(-((x - CENTRES) ** 2).sum(axis=1) / 0.08)
    return {"near": -float(wells[::2].sum()) + 0.2 * x[0], "far": -float(wells[1::2].sum()) - 0.2 * x[0]}


def corner(c: Configuration) -> dict[str, float]:
    """Return two objectives whose trade-off lies on five bounds."""
    x = np.array([float(c[name]) for name in "abcdef"])
    rest = float(x[1:].sum()) / 5
    return {"near": x[0] + rest, "far": (1 - x[0]) ** 2 + rest}


def on_six_axes(factor: float, **changes: Any) -> dict[str, Any]:
    return scenario_of(
        input_parameters=dict.fromkeys("abcdef", UNIT),
        objectives=[{"name": "near"}, {"name": "far"}],
        optimizer={"type": "bayesian", "boundary_factor": factor},
        design_of_experiment={"type": "sobol", "number_of_samples": 10},
        budget={"evaluations": 60},
        **changes,
    )


def share_on_bounds(optimizer: Optimizer) -> float:
    """Return which share of the model's suggestions is on a bound."""
    space = optimizer.history.space
    chosen = [e.suggestion.phase == MODEL for e in optimizer.history]
    near = nearness(optimizer.history.X_all()[chosen], space.is_continuous).max(axis=1)
    return float((near >= 0.5).mean())


@pytest.mark.slow
def test_fewer_suggestions_are_on_bounds_where_nothing_is_found_there() -> None:
    without, discounted = (run(on_six_axes(factor), 40, function=rough) for factor in (1.0, 0.3))
    assert share_on_bounds(discounted) < share_on_bounds(without) - 0.3


def test_search_on_bounds_goes_on_where_the_best_is_there() -> None:
    assert share_on_bounds(run(on_six_axes(0.3), 30, function=corner)) > 0.9


def test_history_shows_what_was_promised_before_the_discount(monkeypatch: pytest.MonkeyPatch) -> None:
    optimizer = run(on_six_axes(0.3), 30, function=rough)
    promises: list[Any] = []

    def spied(self: Any, scorer: Any, context: Any) -> Any:
        promises.append(scorer)
        return BoundaryWeighted(inner=scorer, axes=np.ones(6, dtype=bool), factor=1e-3)

    monkeypatch.setattr(bayesian.BayesianOptimizer, "_less_on_bounds", spied)
    (asked,) = optimizer.ask(1)
    x = optimizer.history.space.encode([asked.configuration])
    assert asked.acquisition_value == pytest.approx(float(promises[0](x)[0]))


def test_search_for_something_feasible_promises_nothing() -> None:
    rows = [START, (MODEL, 0.0, None, {}), (MODEL, 0.0, None, {}), ("design", 0.4, (1.1, 0.9), {})]
    known = history(*rows, ("design", 0.4, (1.2, 0.8), {}))
    assert boundary_factor(known, known.Y(), known.Y(), 0.3) == 1.0


def test_reference_point_may_be_given_for_one_objective_alone() -> None:
    known = history(START, ("design", 0.4, (1.1, 0.9), {}), (MODEL, 0.0, (3.0, 0.1), {}))
    alone = build_history(
        load_scenario(
            scenario_of(
                input_parameters={"a": UNIT, "b": UNIT},
                objectives=[{"name": "near", "reference_point": 1.2}, {"name": "far"}],
            )
        )
    )
    alone.extend(known)
    assert boundary_factor(alone, alone.Y(), alone.Y(), 0.3) == 0.3  # beyond what still counts


@pytest.mark.parametrize("unit", [1e-120, 1e120])
def test_units_of_the_objectives_do_not_matter(unit: float) -> None:
    rows = [(phase, a, tuple(unit * y for y in values), more) for phase, a, values, more in (START, *GOOD_ON_BOUND)]
    known = history(*rows, reference_point=2 * unit)
    assert boundary_factor(known, known.Y(), known.Y(), 0.3) == 1.0


def test_a_resumed_run_discounts_the_same() -> None:
    scenario = on_six_axes(0.3)
    whole = run(scenario, 30, function=rough)
    for stop in (15, 25):
        (again,) = resumed(scenario, list(whole.history)[:stop]).ask(1)
        assert again.configuration == list(whole.history)[stop].suggestion.configuration


@pytest.mark.parametrize(
    "acquisition",
    [
        {"type": "thompson_sampling"},
        {"type": "noisy_expected_improvement", "scalarization": {"type": "tchebyshev"}},
    ],
    ids=lambda a: a["type"],
)
def test_trade_offs_that_are_drawn_are_left_alone(acquisition: dict[str, Any]) -> None:
    without, with_it = (run(on_six_axes(f, acquisition=acquisition), 14, function=rough) for f in (1.0, 0.01))
    assert np.array_equal(without.history.X(), with_it.history.X())


def test_two_axes_are_left_alone() -> None:
    def outcome(factor: float) -> Any:
        scenario = on_six_axes(factor) | {"input_parameters": {"a": UNIT, "b": UNIT}}
        return run(scenario, 22, function=lambda c: rough({**dict.fromkeys("cdef", 0.5), **c})).history.X()

    assert np.array_equal(outcome(1.0), outcome(0.01))


def test_promises_of_earlier_models_do_not_count() -> None:
    rows = [START, ("design", 0.4, (1.1, 0.9), {}), (MODEL, 0.0, LOSS, {}), (MODEL, 0.0, GAIN, {})]
    known = history(*rows[:3])
    assert boundary_factor(known, known.Y(), known.Y(), 0.3, n_before=2) == pytest.approx(0.3)
    assert boundary_factor(known, known.Y(), known.Y(), 0.3, n_before=3) == 1.0
    known = history(*rows, (MODEL, 0.0, LOSS, {}))
    assert boundary_factor(known, known.Y(), known.Y(), 0.3, n_before=4) == pytest.approx(0.3)
