"""Tests for next_feasible.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hypermap_lite.assembly import build_optimizer
from hypermap_lite.evaluation.outcome import NEAR, Evaluation, State, Suggestion
from hypermap_lite.optimizers import Optimizer
from hypermap_lite.optimizers.next_feasible import PATIENCE, WIDTHS, attempt, draw_near
from hypermap_lite.scenario.loader import load_scenario
from hypermap_lite.space.categorical import CategoricalParameter
from hypermap_lite.space.integer import IntegerParameter
from hypermap_lite.space.real import RealParameter
from hypermap_lite.space.search_space import SearchSpace
from tests.optimizers.runs import resumed, scenario_of

SQUARE = SearchSpace(tuple(RealParameter(name=name, low=0.0, high=1.0) for name in "ab"))


def judged(suggestion: Suggestion, is_feasible: Callable[[Mapping[str, Any]], bool]) -> Evaluation:
    c = suggestion.configuration
    values = {"near": float(c["a"]) + float(c["b"]), "far": float(c["b"]) - float(c["a"])}
    state = State.COMPLETED if is_feasible(c) else State.INFEASIBLE
    return Evaluation(suggestion=suggestion, state=state, values=values)


def scenario(**changes: Any) -> dict[str, Any]:
    parameters = {name: {"parameter_type": "real", "values": [0, 1]} for name in "abc"}
    return scenario_of(input_parameters=parameters, budget={"evaluations": 50}, **changes)


def once(scenario, n: int, batch: int = 1) -> Optimizer:
    """Run a scenario in which trial 3 alone is feasible."""
    optimizer = build_optimizer(load_scenario(scenario))
    while len(optimizer.history) < n:
        optimizer.tell([judged(s, lambda _, t=s.trial: t == 3) for s in optimizer.ask(batch)])
    return optimizer


def test_of_a_sliver_that_one_point_is_known_of_five_draws_find_another() -> None:
    rng, found = np.random.default_rng(0), []
    cube = scenario_of(input_parameters={name: {"parameter_type": "real", "values": [0, 1]} for name in "abc"})
    space = build_optimizer(load_scenario(cube)).history.space
    for _ in range(200):
        centre = np.array([[rng.uniform(0.025, 0.075), rng.random(), rng.random()]])
        draws = [draw_near(space, centre, number, [], rng) for number in range(len(WIDTHS))]
        found.append(sum(abs(x[0] - 0.05) < 0.025 for x in draws))
    assert np.mean(np.array(found) > 0) > 0.9
    assert np.mean(found) > 2


@pytest.mark.parametrize("batch", [1, 3])
def test_the_same_points_come_after_a_resume(batch: int) -> None:
    asked = scenario(seed=1)
    whole = list(once(asked, 36, batch).history)
    near = [row.trial for row in whole if row.suggestion.phase == NEAR]
    assert len(near) >= 8
    for trial in near:
        n = trial - trial % batch
        again = resumed(asked, whole[:n]).ask(batch)
        expected = [replace(row.suggestion, seconds=0.0) for row in whole[n : n + batch]]
        assert [replace(s, seconds=0.0) for s in again] == expected


def test_after_patience_they_are_draws_near_the_feasible_point_that_the_history_names_so() -> None:
    rows = list(once(scenario(seed=1), 24).history)
    first = 4 + PATIENCE
    phases = [row.suggestion.phase for row in rows[first:]]
    assert phases[:5] == [NEAR] * 5
    assert [phase == NEAR for phase in phases[5:12]] == [False, True] * 3 + [False]
    assert NEAR not in [row.suggestion.phase for row in rows[:first]]
    X = once(scenario(seed=1), 24).history.X_all()
    distances = np.abs(X - X[3]).max(axis=1)
    assert (distances[first:][:5] <= WIDTHS).all()
    assert all(row.suggestion.acquisition_value is None for row in rows if row.suggestion.phase == NEAR)


def test_eight_others_in_a_row_call_for_five_draws_and_from_then_on_every_second_suggestion_is_one() -> None:
    known = np.zeros(40, dtype=bool)
    known[9] = True
    due = [attempt(known[:n]) for n in range(1, 41)]
    assert due[:17] == [None] * 17
    assert due[17:] == [0, 1, 2, 3, 4] + [k for later in range(5, 14) for k in (None, later)]
    assert [attempt(known[:n], n_pending=3) for n in (14, 15, 19, 20, 21)] == [None, 0, 4, None, 5]


def test_three_feasible_points_or_none_or_nothing_else_call_for_no_draw() -> None:
    infeasible = [False] * PATIENCE
    assert attempt(np.array([True, True, *infeasible])) == 0
    assert attempt(np.array([True, True, True, *infeasible])) is None
    assert attempt(np.array(infeasible)) is None
    assert attempt(np.array([True, True]), n_pending=PATIENCE) is None
    assert attempt(np.array([], dtype=bool)) is None


def test_draws_are_within_boxes_that_shrink_and_grow_again_around_each_feasible_point_by_turns() -> None:
    feasible, rng = np.array([[0.5, 0.4], [0.1, 0.9]]), np.random.default_rng(0)
    for k in range(2 * len(WIDTHS)):
        centre, width = feasible[::-1][k % 2], WIDTHS[k % len(WIDTHS)]
        X = np.array([draw_near(SQUARE, feasible, k, [], rng) for _ in range(200)])
        assert (np.abs(X - centre) <= width + 1e-12).all()
        assert (np.abs(X - centre).max(axis=0) > 0.9 * width).all()
        assert ((X >= 0) & (X <= 1)).all()


def test_categories_stay_and_what_is_known_is_not_drawn_again() -> None:
    mode = CategoricalParameter(name="mode", values=("slow", "fast"))
    space = SearchSpace((IntegerParameter(name="n", low=0, high=7), mode))
    rng, taken = np.random.default_rng(0), list[bytes]()
    centre = space.encode([{"n": 3, "mode": "fast"}])
    drawn = []
    while (x := draw_near(space, centre, 0, taken, rng)) is not None:
        taken += space.keys(x[None])
        drawn.append(space.decode(x[None])[0])
    assert sorted(int(c["n"]) for c in drawn) == [1, 2, 3, 4, 5]
    assert {c["mode"] for c in drawn} == {"fast"}


def test_known_constraints_hold() -> None:
    asked = scenario(seed=1, constraints=["a + b + c <= 1.5"])
    optimizer = once(asked, 30)
    near = [row.configuration for row in optimizer.history if row.suggestion.phase == NEAR]
    assert len(near) > 5
    assert all(sum(float(v) for v in c.values()) <= 1.5 + 1e-9 for c in near)
    space, rng = optimizer.history.space, np.random.default_rng(0)
    on_edge = np.full((1, 3), 0.5)
    assert all(draw_near(space, on_edge, k, [], rng).sum() <= 1.5 + 1e-9 for k in range(50))


def test_steps_that_a_prior_guides_are_not_replaced() -> None:
    asked = scenario(seed=1)
    asked["input_parameters"]["c"] |= {"prior": {"type": "gaussian", "mean": 0.5, "std": 0.2}}
    later = [row.suggestion for row in once(asked, 40).history]
    assert NEAR not in {s.phase for s in later if s.prior_weight}
    assert NEAR in {s.phase for s in later if s.prior_weight == 0}


@pytest.mark.parametrize("learn_failed", [True, False])
def test_evaluations_that_fail_are_counted_and_do_not_call_for_draws_for_ever(learn_failed: bool) -> None:
    asked = scenario(seed=1, acquisition={"feasibility_weighting": {"learn_failed": learn_failed}})
    optimizer = build_optimizer(load_scenario(asked))
    while len(optimizer.history) < 36:
        rows = [judged(s, lambda _, t=s.trial: t == 3) for s in optimizer.ask()]
        optimizer.tell([row if row.is_completed else replace(row, state=State.FAILED, values={}) for row in rows])
    near = [row.trial for row in optimizer.history if row.suggestion.phase == NEAR]
    assert near == [12, 13, 14, 15, 16, 18, 20, 22, 24, 26, 28, 30, 32, 34]
